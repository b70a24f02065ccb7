// An opaque surface of the surroundings, or an optic seen by another one. Variants: TEXTURED, ALPHA_TEST,
// CLIP_AGAINST_OPTIC, GEOMETRY, DEPTH_ONLY. Needs raster_view.glsl, raster_shading.glsl.

in vec3 v_relative;
in vec3 v_normal;
in vec3 v_texture;

layout(location = 2) uniform vec3 albedo;
layout(location = 3) uniform vec3 emissive;
layout(location = 4) uniform vec2 alpha;  // material's alpha, cutoff

#ifdef TEXTURED
layout(binding = 0) uniform sampler2D albedo_texture;
#endif
#ifdef CLIP_AGAINST_OPTIC
layout(binding = 1) uniform sampler2D optic_depth;
#endif

#ifndef DEPTH_ONLY
layout(location = 0) out vec4 out_color;
#endif
#ifdef GEOMETRY
layout(location = 1) out vec4 out_position;  // world, w = 1
layout(location = 2) out vec4 out_detail;    // maps: geometric normal
#endif

void main() {
#ifndef DEPTH_ONLY
  vec3 color = albedo;
#endif
#if defined(TEXTURED) && !defined(DEPTH_ONLY)
  // Level = 1/2 log2(area of the pixel's footprint in texels), before any lane of the quad may be gone.
  vec2 size = vec2(textureSize(albedo_texture, 0));
  vec2 dx = dFdx(v_texture.xy) * size, dy = dFdy(v_texture.xy) * size;
  float level = 0.5 * log2(max(abs(dx.x * dy.y - dx.y * dy.x), 1e-20)) + parameters.x;
#endif
#ifdef GEOMETRY
  vec3 geometric_normal = cross(dFdx(v_relative), dFdy(v_relative));
#endif
#ifdef CLIP_AGAINST_OPTIC
  // Depth is reversed: what is nearer to the viewpoint than the optic's own surface lies behind the mirror.
  if (gl_FragCoord.z > texelFetch(optic_depth, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
#ifdef TEXTURED
#ifdef ALPHA_TEST
  if (alpha.x * textureLod(albedo_texture, v_texture.xy, 0.0).a < alpha.y) discard;
#endif
#ifndef DEPTH_ONLY
  color *= textureLod(albedo_texture, v_texture.xy, level).rgb;
#endif
#elif defined(ALPHA_TEST)
  if (alpha.x < alpha.y) discard;
#endif
#ifndef DEPTH_ONLY
  vec3 normal = normalize(gl_FrontFacing ? v_normal : -v_normal);
  out_color = vec4(shade(color, emissive, normal, v_relative), 1.0);
#endif
#ifdef GEOMETRY
  out_position = vec4(v_relative + origin.xyz, 1.0);
  float area = length(geometric_normal);
  out_detail = vec4(area > 0.0 ? geometric_normal / area : vec3(0.0), 0.0);
#endif
}
