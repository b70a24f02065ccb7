// One colour; what lies between a map's viewpoint and the optic is cut as in raster_surface.frag.glsl.
// Variants: CLIP_AGAINST_OPTIC, ZOOMING.

layout(location = 2) uniform vec3 color;
#ifdef CLIP_AGAINST_OPTIC
layout(binding = 1) uniform sampler2D optic_depth;
#endif
layout(location = 0) out vec4 out_color;

void main() {
#ifdef CLIP_AGAINST_OPTIC
  float surface_depth = texelFetch(optic_depth, ivec2(gl_FragCoord.xy), 0).r;
#ifdef ZOOMING
  // Looking back towards the optic, what is farther than it lies behind the mirror.
  if (gl_FragCoord.z < surface_depth) discard;
#else
  if (gl_FragCoord.z > surface_depth) discard;
#endif
#endif
  out_color = vec4(color, 1.0);
}
