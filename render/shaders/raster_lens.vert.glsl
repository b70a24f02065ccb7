// A vertex of the side at which the eye's rays enter a lens, with what it shows at SAMPLES wavelengths.
// Needs raster_view.glsl.

layout(location = 0) in vec3 in_position;  // mm, relative to the mesh's own origin
layout(location = 2) in vec4 in_exit;      // exit point relative to the same origin, transmittance
layout(location = 3) in vec2 in_mask;      // place of the exit point in the mask
layout(location = 4) in vec4 in_shown[SAMPLES];  // xyz: see the fragment shader; w > 0 where the path passes

layout(location = 0) uniform vec3 origin_high;
layout(location = 1) uniform vec3 origin_low;
layout(location = 16) uniform mat3 mesh_axes;  // as in raster_surface.vert.glsl

// Further wavelengths are added where depth is equal, drawn by another program.
invariant gl_Position;
out vec3 v_relative;
out vec4 v_exit;  // relative to the view's origin
out vec2 v_mask;
out vec4 v_shown[SAMPLES];

void main() {
  precise vec3 from_origin = (in_position - origin_high) - origin_low;
  vec3 relative = mesh_axes * from_origin;
  v_relative = relative;
  v_exit = vec4(mesh_axes * ((in_exit.xyz - origin_high) - origin_low), in_exit.w);
  v_mask = in_mask;
  v_shown = in_shown;
  gl_Position = clip_from_relative * vec4(relative, 1.0);
  gl_ClipDistance[0] = dot(keep, vec4(relative, 1.0));
}
