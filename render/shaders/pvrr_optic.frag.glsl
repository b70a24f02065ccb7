// PVRR pass 2 (paper 3.1, step 4): the optic with its reflection map, in the picture or in the map of another optic (paper
// 4.4). Variants: GEOMETRY, IN_MAP, CLIP_AGAINST_OPTIC.
// Needs raster_view.glsl, raster_shading.glsl, raster_shown.glsl, raster_optic.glsl.

in vec3 v_relative;
in vec3 v_normal;
centroid in vec3 v_texture;  // homogeneous map coordinates (s q, t q, q); with multisampling never beyond the border

layout(location = 7) uniform vec2 map_shift;  // sub-texel offset with which this sample's map was drawn

layout(location = 10) uniform vec4 map_place;  // of the patch's map in the atlas: offset, and factor

layout(binding = 2) uniform sampler2D map_color;
#ifdef GEOMETRY
layout(binding = 3) uniform sampler2D map_position;
layout(binding = 4) uniform sampler2D map_normal;
// The ray that map coordinates (s, t) show: origin and direction, each as value at (0, 0), change by s, change by t.
layout(location = 8) uniform mat3 map_ray_origin;
layout(location = 9) uniform mat3 map_ray_direction;
#endif

#ifndef IN_MAP
layout(binding = 0, offset = 0) uniform atomic_uint outside_map;
#endif

void main() {
  vec2 st = v_texture.xy / v_texture.z;
  bool reflects = gl_FrontFacing == front_reflects;
  bool inside = all(greaterThanEqual(st, vec2(0.0))) && all(lessThanEqual(st, vec2(1.0)));
  vec3 direction = reflect(v_relative, normalize(v_normal));
  // Map row 0 is the top.
  vec2 at = map_place.xy + map_place.zw * vec2(st.x, 1.0 - st.y) + map_shift;
  vec3 seen;
  if (inside) {
    seen = textureLod(map_color, at, 0.0).rgb;
  } else {
    seen = sky(direction);
#ifndef IN_MAP
    if (reflects) atomicCounterIncrement(outside_map);
#endif
  }
  write_optic_color(reflects, seen, v_relative, v_normal);
#ifdef GEOMETRY
  vec3 surface = v_relative + origin.xyz;
  vec4 shown = vec4(normalize(direction), 0.0), last = vec4(surface, 0.0);
  if (inside)
    shown = shown_in_map(map_position, map_normal, at, map_ray_origin * vec3(1.0, st),
                         map_ray_direction * vec3(1.0, st), surface, last);
  write_optic_geometry(reflects, shown, last, v_relative);
#endif
  if (behind_optic()) discard;
}
