// A vertex of the surroundings or of an optic; needs raster_view.glsl.

layout(location = 0) in vec3 in_position;  // mm, relative to the mesh's own origin
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec3 in_texture;   // surroundings: (s, t, -); optic: map coordinates (s q, t q, q)

// The view's origin less the mesh's, along the mesh's axes, in two floats that together hold a double's leading 48 bits.
layout(location = 0) uniform vec3 origin_high;
layout(location = 1) uniform vec3 origin_low;
layout(location = 16) uniform mat3 mesh_axes;  // the mesh's axes in the world

out vec3 v_relative;  // position relative to the view's origin
out vec3 v_normal;
out vec3 v_texture;

void main() {
  // `precise` keeps the compiler from adding the two halves first.
  precise vec3 from_origin = (in_position - origin_high) - origin_low;
  vec3 relative = mesh_axes * from_origin;
  v_relative = relative;
  v_normal = mesh_axes * in_normal;
  v_texture = in_texture;
  gl_Position = clip_from_relative * vec4(relative, 1.0);
  gl_ClipDistance[0] = dot(keep, vec4(relative, 1.0));
}
