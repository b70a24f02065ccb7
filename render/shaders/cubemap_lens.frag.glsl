// A lens with a cube map drawn at its centre, looked up with the refracted direction: the baseline that PVRR is compared
// with. Variants: SAMPLES, GEOMETRY. Needs raster_view.glsl, raster_shading.glsl, raster_shown.glsl, raster_lens.glsl.
// v_shown: direction of the light behind the lens, interpolated between vertices.

layout(binding = 2) uniform samplerCube map_color;
#ifdef GEOMETRY
layout(binding = 3) uniform samplerCube map_position;
layout(binding = 4) uniform samplerCube map_normal;
layout(location = 8) uniform vec3 cube_center;
#endif

void main() {
  bool open = meets_exit();
  vec3 color = vec3(0.0);
  for (int k = 0; k < SAMPLES; ++k)
    color += transmitted(open && v_shown[k].w > 0.0, k, textureLod(map_color, v_shown[k].xyz, 0.0).rgb);
  out_color = vec4(color, 1.0);
#ifdef GEOMETRY
  vec3 direction = v_shown[0].xyz;
  vec4 shown = point_on_ray(cube_center, direction, cube_center, textureLod(map_position, direction, 0.0),
                            textureLod(map_normal, direction, 0.0).xyz);
  write_lens_geometry(open && v_shown[0].w > 0.0, shown, vec4(v_exit.xyz + origin.xyz, 0.0));
#endif
}
