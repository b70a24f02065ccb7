// What all ways to draw an optic share: the outputs, and the exact point behind a map's texel. Needs raster_view.glsl.

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
#endif
