// A planar optic with the maps of what it reflects and passes, in the picture or in a map: texel by texel, since the maps
// lie on the grid of the view that shows them (src/planar_map_view.h). What each share is: docs/decisions/0015.
// Variants: GLASS, PANE, GEOMETRY, IN_MAP, CLIP_AGAINST_OPTIC. Needs raster_view.glsl, raster_shading.glsl,
// raster_shown.glsl.

in vec3 v_relative;
in vec3 v_normal;

layout(location = 3) uniform vec3 reflectance;     // of a mirror
layout(location = 4) uniform bool works;           // a mirror's side towards the eye reflects
layout(location = 5) uniform float back_albedo;    // of a mirror's other side
layout(location = 7) uniform vec4 surface_albedo;  // of the lit surface, and its share
layout(location = 8) uniform ivec4 reflected_grid;  // texel of a map = xy + zw * pixel of the view, zw = (-1, 1) or (1, 1)
layout(binding = 2) uniform sampler2D reflected_color;
#ifdef GEOMETRY
layout(binding = 3) uniform sampler2D reflected_position;
layout(binding = 4) uniform sampler2D reflected_detail;
#endif

#ifdef GLASS
layout(location = 9) uniform ivec4 passed_grid;
layout(location = 10) uniform float index_ratio;   // n_to / n_from
layout(location = 11) uniform vec3 tint;
layout(location = 12) uniform bvec3 has_map;        // of reflected, of passed light; z: all light is reflected
layout(location = 13) uniform vec3 passed_eye;      // eye of the passed light's map, relative to that of the view
layout(location = 14) uniform vec2 fog;             // log of what 1 mm leaves, and near distance of that map
layout(location = 15) uniform vec4 face;            // plane: dot(face.xyz, relative) = face.w
layout(location = 20) uniform vec3 fog_albedo;
layout(binding = 5) uniform sampler2D passed_color;
layout(binding = 6) uniform sampler2D passed_depth;
#ifdef GEOMETRY
layout(binding = 9) uniform sampler2D passed_position;
layout(binding = 10) uniform sampler2D passed_detail_map;
#endif
#endif

ivec2 texel(ivec4 grid) {
  return grid.xy + grid.zw * ivec2(gl_FragCoord.xy);
}

#ifdef GLASS
/// Of unpolarised light; 1 beyond the critical angle. As fresnel_dielectric() of optics/refraction.h.
float fresnel(float cos_i, float ratio) {
  float squared = ratio * ratio, root = squared - 1.0 + cos_i * cos_i;
  if (root <= 0.0) return 1.0;
  float g = sqrt(root);
  float s = (cos_i - g) / (cos_i + g), p = (squared * cos_i - g) / (squared * cos_i + g);
  return 0.5 * (s * s + p * p);
}

/// The map's ray: relative + length along `along`, of which `start` reaches the face.
vec3 passed_along(out float start) {
#ifdef PANE
  start = (face.w - dot(face.xyz, passed_eye)) / dot(face.xyz, v_relative);
  return v_relative;
#else
  start = 1.0;
  return v_relative - passed_eye;
#endif
}

vec3 passed_light() {
  ivec2 at = texel(passed_grid);
  vec3 seen = texelFetch(passed_color, at, 0).rgb;
  if (fog.x == 0.0) return seen;
  float depth = texelFetch(passed_depth, at, 0).r, start;
  vec3 along = passed_along(start);
  // Along a ray the map's clip w grows as the distance from its eye does, and is 1 / gl_FragCoord.w at `along`.
  float behind = depth > 0.0 ? max(0.0, length(along) * (fog.y / depth * gl_FragCoord.w - start)) : 1e30;
  return mix(fog_albedo * parameters.y, seen, exp(max(fog.x * behind, -80.0)));
}
#endif

#ifdef GEOMETRY
/// What a map shows at `at`: the last point on an optic, and the way, which are those of `here` where it shows no other.
void write_geometry(vec4 position, vec4 detail, vec3 here) {
  out_position = position;
  out_detail = passed_detail(detail.w > 0.0 ? detail : vec4(here + origin.xyz, 0.0));
}
#endif

void main() {
  vec3 normal = normalize(v_normal);
  if (dot(normal, v_relative) > 0.0) normal = -normal;
  ivec2 at = texel(reflected_grid);
  vec3 seen;
#ifdef GLASS
  float reflected = fresnel(-dot(normal, v_relative) / length(v_relative), index_ratio);
#ifdef PANE
  reflected = 2.0 * reflected / (1.0 + reflected);
#endif
  // Where the face as a whole counts as beyond the critical angle all light is reflected.
  if (has_map.z) reflected = 1.0;
  seen = vec3(0.0);
  if (has_map.y && reflected < 1.0) seen += (1.0 - reflected) * tint * passed_light();
  if (has_map.x) seen += reflected * texelFetch(reflected_color, at, 0).rgb;
#else
  seen = works ? reflectance * texelFetch(reflected_color, at, 0).rgb
               : shade(vec3(back_albedo), vec3(0.0), normal, v_relative);
#endif
  // The back of a one-sided mirror is that body alone.
#ifdef GLASS
  bool covered = surface_albedo.w > 0.0;
#else
  bool covered = works && surface_albedo.w > 0.0;
#endif
  if (covered)
    seen = mix(seen, shade(surface_albedo.rgb, vec3(0.0), normal, v_relative), surface_albedo.w);
  out_color = vec4(seen, 1.0);
#ifdef GEOMETRY
  vec4 body = body_detail(v_relative);
#ifdef GLASS
  if (has_map.y && reflected < 1.0) {
    ivec2 passed_at = texel(passed_grid);
    float start;
    vec3 along = passed_along(start);
    write_geometry(texelFetch(passed_position, passed_at, 0), texelFetch(passed_detail_map, passed_at, 0),
                   passed_eye + start * along);
  } else if (has_map.x) {
    write_geometry(texelFetch(reflected_position, at, 0), texelFetch(reflected_detail, at, 0), v_relative);
  } else {
    out_position = vec4(v_relative + origin.xyz, 1.0);
    out_detail = body;
  }
#else
  if (works) {
    write_geometry(texelFetch(reflected_position, at, 0), texelFetch(reflected_detail, at, 0), v_relative);
  } else {
    out_position = vec4(v_relative + origin.xyz, 1.0);
    out_detail = body;
  }
#endif
#endif
  if (behind_optic()) discard;
}
