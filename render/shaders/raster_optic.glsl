// What all ways to draw an optic share: the side that does not reflect, the outputs, and the exact point behind a texel.
// Needs raster_view.glsl, raster_shading.glsl.

layout(location = 3) uniform vec3 reflectance;
layout(location = 4) uniform bool front_reflects;
layout(location = 5) uniform float back_albedo;
layout(location = 6) uniform float optic_id;

layout(location = 0) out vec4 out_color;
#ifdef GEOMETRY
layout(location = 1) out vec4 out_position;  // world point shown, w = 1; or direction, w = 0
layout(location = 2) out vec4 out_detail;    // surface point, w = optic's index + 1

/// The point that a map shows along a ray, free of the map's resolution: the ray meets the plane of the nearest texel.
/// `surface`: the point on the optic, before which nothing is shown.
vec4 point_on_ray(vec3 ray_origin, vec3 ray_direction, vec3 surface, vec4 texel_position, vec3 texel_normal) {
  vec3 d = normalize(ray_direction);
  if (texel_position.w == 0.0) return vec4(d, 0.0);
  float slope = dot(texel_normal, d);
  float distance = dot(texel_normal, texel_position.xyz - ray_origin) / slope;
  vec3 point = ray_origin + distance * d;
  // A plane seen on edge says little about the distance along the ray; the texel's own point then has to do.
  if (abs(slope) < 1e-4 || !(dot(point - surface, d) > 0.0)) return texel_position;
  return vec4(point, 1.0);
}

void write_optic_geometry(bool reflects, vec4 shown, vec3 relative) {
  vec3 surface = relative + origin.xyz;
  out_position = reflects ? shown : vec4(surface, 1.0);
  // The side that does not reflect counts as a body like any other.
  out_detail = reflects ? vec4(surface, optic_id + 1.0) : vec4(0.0);
}
#endif

void write_optic_color(bool reflects, vec3 seen, vec3 relative, vec3 interpolated_normal) {
  vec3 normal = normalize(gl_FrontFacing ? interpolated_normal : -interpolated_normal);
  out_color = vec4(reflects ? reflectance * seen : shade(vec3(back_albedo), vec3(0.0), normal, relative), 1.0);
}
