// What all ways to draw a mirror share: the side that does not reflect, and the outputs.
// Needs raster_view.glsl, raster_shading.glsl, raster_shown.glsl.

layout(location = 3) uniform vec3 reflectance;
layout(location = 4) uniform bool front_reflects;
layout(location = 5) uniform float back_albedo;

#ifdef GEOMETRY
/// `last`: as shown_in_map() gives it.
void write_optic_geometry(bool reflects, vec4 shown, vec4 last, vec3 relative) {
  // The side that does not reflect counts as a body like any other.
  vec4 body = body_detail(relative);
  out_position = reflects ? shown : vec4(relative + origin.xyz, 1.0);
  out_detail = reflects ? passed_detail(last) : body;
}
#endif

void write_optic_color(bool reflects, vec3 seen, vec3 relative, vec3 interpolated_normal) {
  vec3 normal = normalize(gl_FrontFacing ? interpolated_normal : -interpolated_normal);
  out_color = vec4(reflects ? reflectance * seen : shade(vec3(back_albedo), vec3(0.0), normal, relative), 1.0);
}
