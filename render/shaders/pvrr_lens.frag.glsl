// PVRR pass 2 for lenses (paper 4.5): the side that the eye's rays enter, with one map for all wavelengths. One draw does
// what the three colour-masked ones of the paper's Fig. 15 do; more wavelengths than SAMPLES are added by further draws.
// Variants: SAMPLES, GEOMETRY, and in the map of another optic IN_MAP, CLIP_AGAINST_OPTIC. Needs raster_view.glsl, raster_shading.glsl, raster_shown.glsl, raster_lens.glsl.
// v_shown: homogeneous map coordinates (s q, t q, q).

layout(location = 7) uniform vec2 map_shift;  // sub-texel offset with which this sample's map was drawn
layout(location = 10) uniform vec4 map_place;  // of the patch's map in the atlas: offset, and factor
#ifndef IN_MAP
layout(location = 11) uniform bool counts;  // pixels outside the map, in the first of several draws
#endif

layout(binding = 2) uniform sampler2D map_color;
#ifdef GEOMETRY
// The ray that map coordinates (s, t) show: origin and direction, each as value at (0, 0), change by s, change by t.
layout(location = 8) uniform mat3 map_ray_origin;
layout(location = 9) uniform mat3 map_ray_direction;
layout(binding = 3) uniform sampler2D map_position;
layout(binding = 4) uniform sampler2D map_normal;
#endif

#ifndef IN_MAP
layout(binding = 0, offset = 0) uniform atomic_uint outside_map;
#endif

bool in_map(vec2 st) { return all(greaterThanEqual(st, vec2(0.0))) && all(lessThanEqual(st, vec2(1.0))); }

// Map row 0 is the top. Beyond its border the map goes on with what the border shows.
vec2 texel_place(vec2 st) { return map_place.xy + map_place.zw * clamp(vec2(st.x, 1.0 - st.y), 0.0, 1.0) + map_shift; }

void main() {
  bool open = meets_exit();
  vec3 color = vec3(0.0);
  for (int k = 0; k < SAMPLES; ++k) {
    vec2 st = v_shown[k].xy / v_shown[k].z;
    color += transmitted(open && v_shown[k].w > 0.0, k, textureLod(map_color, texel_place(st), 0.0).rgb);
  }
#ifndef IN_MAP
  if (counts && open && v_shown[0].w > 0.0 && !in_map(v_shown[0].xy / v_shown[0].z))
    atomicCounterIncrement(outside_map);
#endif
  out_color = vec4(color, 1.0);
#ifdef GEOMETRY
  bool seen = open && v_shown[0].w > 0.0;
  vec2 st = v_shown[0].xy / v_shown[0].z;
  vec3 ray = map_ray_direction * vec3(1.0, st);
  vec3 surface = v_exit.xyz + origin.xyz;
  vec4 shown = vec4(normalize(ray), 0.0), last = vec4(surface, 0.0);
  if (in_map(st))
    shown = shown_in_map(map_position, map_normal, texel_place(st), map_ray_origin * vec3(1.0, st), ray, surface, last);
  write_lens_geometry(seen, shown, last);
#endif
  if (behind_optic()) discard;
}
