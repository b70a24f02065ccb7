// The sky in the pixel's true direction; needs raster_view.glsl, raster_shading.glsl.

in vec3 v_direction;

layout(location = 0) out vec4 out_color;
#ifdef GEOMETRY
layout(location = 1) out vec4 out_position;  // w = 0: a direction
layout(location = 2) out vec4 out_detail;
#endif

void main() {
  out_color = vec4(sky(v_direction), 1.0);
#ifdef GEOMETRY
  out_position = vec4(normalize(v_direction), 0.0);
  out_detail = vec4(0.0);
#endif
}
