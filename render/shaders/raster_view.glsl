// What every pass knows of its view: set by RasterScene::begin_view. Directions are in world axes, positions in mm
// relative to the view's origin, so that float is enough at any distance from the world's origin.

const int kMaxLights = 64;

struct Light {
  vec4 position;  // xyz relative to the view's origin, w = 1; or the unit direction towards the light, w = 0
  vec4 radiance;  // colour x intensity; for w = 1 the irradiance at 1 m
};

layout(std140, binding = 0) uniform View {
  mat4 clip_from_relative;
  vec4 origin;      // of the view in the world, mm
  vec4 sky_center;  // world direction seen at the middle of the view ...
  vec4 sky_x;       // ... and its change by one unit of normalised device x ...
  vec4 sky_y;       // ... and y
  vec4 sky_color;   // rgb
  vec4 parameters;  // level-of-detail bias, ambient irradiance, base of ways, limit of ways
  vec4 keep;        // what is drawn has dot(keep, (relative, 1)) >= 0: see RasterView::keep
  Light lights[kMaxLights];
};
