// One colour; what lies between a map's viewpoint and the optic is cut as in raster_surface.frag.glsl.
// Variant: CLIP_AGAINST_OPTIC.

layout(location = 2) uniform vec3 color;
#ifdef CLIP_AGAINST_OPTIC
layout(binding = 1) uniform sampler2D optic_depth;
#endif
layout(location = 0) out vec4 out_color;

void main() {
#ifdef CLIP_AGAINST_OPTIC
  if (gl_FragCoord.z > texelFetch(optic_depth, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
  out_color = vec4(color, 1.0);
}
