// Lines and balls of the overlays; needs raster_view.glsl.

layout(location = 0) in vec3 in_position;  // mm, relative to the overlay's own origin
layout(location = 3) in vec4 in_ball;      // centre and radius of an instanced ball; (0, 0, 0, 1) for lines

layout(location = 0) uniform vec3 origin_high;
layout(location = 1) uniform vec3 origin_low;
layout(location = 16) uniform mat3 mesh_axes;  // as in raster_surface.vert.glsl
layout(location = 5) uniform float lift;  // share of its distance by which the line is moved towards the viewer

void main() {
  precise vec3 relative = ((in_ball.xyz - origin_high) - origin_low) + in_ball.w * in_position;
  vec3 place = mesh_axes * relative * (1.0 - lift);
  gl_Position = clip_from_relative * vec4(place, 1.0);
  gl_ClipDistance[0] = dot(keep, vec4(place, 1.0));
}
