// One triangle over the whole view at the farthest depth; needs raster_view.glsl.

out vec3 v_direction;

void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  v_direction = sky_center.xyz + corner.x * sky_x.xyz + corner.y * sky_y.xyz;
  gl_Position = vec4(corner, 0.0, 1.0);
  gl_ClipDistance[0] = 1.0;
}
