// What all ways to draw an optic share: the outputs, and the exact point behind a map's texel. Needs raster_view.glsl.
// Variants: GEOMETRY; IN_MAP: seen in the map of another optic; CLIP_AGAINST_OPTIC: only before that optic's surface.

layout(location = 6) uniform float optic_id;

layout(location = 0) out vec4 out_color;
#ifdef GEOMETRY
layout(location = 1) out vec4 out_position;  // world point shown, w = 1; or direction, w = 0
layout(location = 2) out vec4 out_detail;    // last surface point, w = the way (passed_detail)

/// The point that a map shows along a ray, free of the map's resolution: the ray meets the plane of the nearest texel.
/// `surface`: the point on the optic, before which nothing is shown.
vec4 point_on_ray(vec3 ray_origin, vec3 ray_direction, vec3 surface, vec4 texel_position, vec3 texel_normal) {
  vec3 d = normalize(ray_direction);
  if (texel_position.w == 0.0) return vec4(d, 0.0);
  float slope = dot(texel_normal, d);
  float distance = dot(texel_normal, texel_position.xyz - ray_origin) / slope;
  vec3 point = ray_origin + distance * d;
  // A plane seen on edge says little about the distance along the ray; the texel's own point then has to do.
  if (abs(slope) < 1e-4 || !(dot(point - surface, d) > 0.0)) return texel_position;
  return vec4(point, 1.0);
}

/// What a map with geometry in `positions` and `details` shows at `at`, row 0 the top. Where it shows a further optic,
/// that optic's own map has said what is shown and `last` becomes the last point on an optic (w > 0: which ones the light
/// has passed); both then are interpolated between texels that the light reaches by the same way. Else `last` is
/// `surface`.
vec4 shown_in_map(sampler2D positions, sampler2D details, vec2 at, vec3 ray_origin, vec3 ray_direction, vec3 surface,
                  out vec4 last) {
  vec4 detail = textureLod(details, at, 0.0), position = textureLod(positions, at, 0.0);
  last = vec4(surface, 0.0);
  if (detail.w == 0.0) return point_on_ray(ray_origin, ray_direction, surface, position, detail.xyz);
  last = detail;
  ivec2 size = textureSize(details, 0);
  vec2 texel = at * vec2(size) - 0.5, share = fract(texel);
  vec4 shown = vec4(0.0);
  vec3 point = vec3(0.0);
  float weights = 0.0;
  for (int k = 0; k < 4; ++k) {
    ivec2 corner = ivec2(k & 1, k >> 1);
    ivec2 place = clamp(ivec2(floor(texel)) + corner, ivec2(0), size - 1);
    vec4 other_position = texelFetch(positions, place, 0), other_detail = texelFetch(details, place, 0);
    if (other_detail.w != detail.w || other_position.w != position.w) continue;
    vec2 part = mix(1.0 - share, share, vec2(corner));
    float weight = part.x * part.y;
    shown += weight * other_position;
    point += weight * other_detail.xyz;
    weights += weight;
  }
  if (weights < 1e-3) return position;
  last.xyz = point / weights;
  return shown / weights;
}

/// The detail that is written of light that has left the optic by the way `last.w`. A way is the sum of (index + 1)
/// (number of optics + 1)^k over its optics, k = 0 for the first one that the eye sees; what a float cannot hold is left
/// out from its end (as RasterPicture reads it).
vec4 passed_detail(vec4 last) {
  return vec4(last.xyz, optic_id + 1.0 + parameters.z * mod(last.w, parameters.w));
}

/// That of a body like any other: maps need its normal.
vec4 body_detail(vec3 relative) {
#ifdef IN_MAP
  vec3 normal = cross(dFdx(relative), dFdy(relative));
  float area = length(normal);
  return vec4(area > 0.0 ? normal / area : vec3(0.0), 0.0);
#else
  return vec4(0.0);
#endif
}
#endif

#ifdef CLIP_AGAINST_OPTIC
layout(binding = 1) uniform sampler2D optic_depth;
#endif
/// In a map: whether the fragment lies behind the optic that the map is of (as in raster_surface.frag.glsl).
bool behind_optic() {
#ifdef CLIP_AGAINST_OPTIC
  return gl_FragCoord.z > texelFetch(optic_depth, ivec2(gl_FragCoord.xy), 0).r;
#else
  return false;
#endif
}
