// What all ways to draw a lens share: the sum over SAMPLES wavelengths, and the pixels that no light passes.
// Needs raster_view.glsl, raster_shown.glsl.

in vec3 v_relative;
centroid in vec4 v_exit;            // last point on the lens, relative to the view's origin; transmittance
centroid in vec2 v_mask;
centroid in vec4 v_shown[SAMPLES];

layout(binding = 5) uniform sampler2D exit_mask;  // above 1/2 on the exit surface, below beside it

layout(location = 3) uniform vec3 blocked_color;     // radiance where the path does not pass
layout(location = 12) uniform mat3 weight[SAMPLES];  // of each wavelength's colour in the picture's

/// At all wavelengths: the exit surface is there.
bool meets_exit() { return gl_FrontFacing && textureLod(exit_mask, v_mask, 0.0).r > 0.5; }

vec3 transmitted(bool passes, int k, vec3 seen) { return weight[k] * (passes ? v_exit.w * seen : blocked_color); }

#ifdef GEOMETRY
/// `shown`: by one wavelength, in pictures the reference wavelength, which is the first.
/// `last`: as shown_in_map() gives it.
void write_lens_geometry(bool passes, vec4 shown, vec4 last) {
  // Where nothing is seen through it, the lens counts as a body like any other.
  out_position = passes ? shown : vec4(v_relative + origin.xyz, 1.0);
  vec4 body = body_detail(v_relative);
  out_detail = passes ? passed_detail(last) : body;
}
#endif
