// The optic with a cube map drawn at its centre, looked up with the reflected direction: the baseline that PVRR is
// compared with (paper, Fig. 1). Variant: GEOMETRY. Needs raster_view.glsl, raster_shading.glsl, raster_shown.glsl,
// raster_optic.glsl.

in vec3 v_relative;
in vec3 v_normal;
in vec3 v_texture;

layout(binding = 2) uniform samplerCube map_color;
#ifdef GEOMETRY
layout(binding = 3) uniform samplerCube map_position;
layout(binding = 4) uniform samplerCube map_normal;
layout(location = 8) uniform vec3 cube_center;
#endif

void main() {
  bool reflects = gl_FrontFacing == front_reflects;
  vec3 direction = reflect(normalize(v_relative), normalize(v_normal));
  write_optic_color(reflects, textureLod(map_color, direction, 0.0).rgb, v_relative, v_normal);
#ifdef GEOMETRY
  vec4 shown = point_on_ray(cube_center, direction, cube_center, textureLod(map_position, direction, 0.0),
                            textureLod(map_normal, direction, 0.0).xyz);
  write_optic_geometry(reflects, shown, vec4(v_relative + origin.xyz, 0.0), v_relative);
#endif
}
