// Lights with shadows: one bit for each point and virtual light in each pixel, set by RasterShadows. Variants: LIGHT_POINTS,
// how many points there are; VIRTUAL_LIGHTS, which follow them; SHADOW_SAMPLES of a multisampled target. The formulas are
// those of optics/light_path.h. Needs raster_view.glsl.

#ifdef LIGHT_POINTS
struct LightPoint {
  vec4 place;   // as in Light, relative to the view
  vec4 power;   // rgb, w: gain
  vec4 plane;   // virtual lights: the face, dot(plane, (P, 1)) = 0, relative to the view; points: w = 1: as the one before
  vec4 passes;  // virtual lights: factor of light that passes or is reflected by a mirror, w: kind of step (kStep...)
  vec4 medium;  // indices before and behind the face; number of the light before; bit, -1: always seen
};
layout(std430, binding = 1) readonly buffer Lights { LightPoint light_points[]; };

const float kStepMirror = 0.0, kStepReflected = 1.0, kStepPassed = 2.0, kStepPaneReflected = 3.0, kStepPanePassed = 4.0;

#ifdef SHADOW_SAMPLES
layout(binding = 8) uniform sampler2DMSArray visibility;
#else
#define SHADOW_SAMPLES 1
layout(binding = 8) uniform sampler2DArray visibility;
#endif

uint shadow_words[SHADOW_SAMPLES];
int shadow_layer = -1;

void fetch_shadows(int layer) {
  if (layer == shadow_layer) return;
  shadow_layer = layer;
  for (int s = 0; s < SHADOW_SAMPLES; ++s)
    shadow_words[s] = packUnorm4x8(texelFetch(visibility, ivec3(gl_FragCoord.xy, layer), s));
}

/// The share of the fragment's samples that a light reaches.
float seen(float number) {
  int bit = int(number);
  if (bit < 0) return 1.0;
  fetch_shadows(bit >> 5);
#if SHADOW_SAMPLES == 1
  return float(shadow_words[0] >> (bit & 31) & 1u);
#else
  uint covered = uint(gl_SampleMaskIn[0]) & ((1u << SHADOW_SAMPLES) - 1u), lit = 0u;
  if (covered == 0u) covered = (1u << SHADOW_SAMPLES) - 1u;
  for (int s = 0; s < SHADOW_SAMPLES; ++s) lit |= (shadow_words[s] >> (bit & 31) & 1u) << s;
  return float(bitCount(covered & lit)) / float(bitCount(covered));
#endif
}

/// Irradiance of a unit light: intensity is the irradiance at 1 m = 1000 mm, and falls with the distance squared.
float unit_irradiance(vec4 place, vec3 position, vec3 normal) {
  vec3 way = place.xyz - place.w * position;
  float inverse_distance = inversesqrt(max(dot(way, way), 1e-6));
  float fall_off = place.w == 0.0 ? 1.0 : 1e6 * inverse_distance * inverse_distance;
  return fall_off * max(0.0, dot(normal, way) * inverse_distance);
}

#ifdef VIRTUAL_LIGHTS
/// Fresnel's reflectance of unpolarised light.
float fresnel(float cos_i, float n_from, float n_to) {
  float sin_t = n_from / n_to * sqrt(max(0.0, 1.0 - cos_i * cos_i));
  if (sin_t >= 1.0) return 1.0;
  float cos_t = sqrt(1.0 - sin_t * sin_t);
  float s = (n_from * cos_i - n_to * cos_t) / (n_from * cos_i + n_to * cos_t);
  float p = (n_to * cos_i - n_from * cos_t) / (n_to * cos_i + n_from * cos_t);
  return 0.5 * (s * s + p * p);
}

vec3 face_share(LightPoint step, float cos_i) {
  float kind = step.passes.w;
  if (kind == kStepMirror) return step.passes.rgb;
  float r = fresnel(min(cos_i, 1.0), step.medium.x, step.medium.y);
  if (kind >= kStepPaneReflected) r = 2.0 * r / (1.0 + r);
  return kind == kStepPassed || kind == kStepPanePassed ? (1.0 - r) * step.passes.rgb : vec3(r);
}

/// What the faces on the way leave of the light `last` that lights `position`, from the last face to the first.
vec3 way_share(int last, vec3 position) {
  vec3 share = vec3(1.0);
  for (int i = last; i >= LIGHT_POINTS;) {
    LightPoint step = light_points[i];
    vec3 way = step.place.xyz - step.place.w * position;
    position -= dot(step.plane, vec4(position, 1.0)) / dot(step.plane.xyz, way) * way;
    i = int(step.medium.z);
    vec4 before = light_points[i].place;
    share *= face_share(step, abs(dot(step.plane.xyz, normalize(before.xyz - before.w * position))));
  }
  return share;
}

/// Each lights little of the scene, so only those are looked at that reach the fragment: their bits are consecutive.
vec3 irradiance_of_virtual_lights(vec3 normal, vec3 position) {
  vec3 irradiance = vec3(0.0);
  int count = light_points.length() - LIGHT_POINTS;
  if (count <= 0) return irradiance;
  int first = int(light_points[LIGHT_POINTS].medium.w);
  for (int layer = first >> 5; 32 * layer < first + count; ++layer) {
    fetch_shadows(layer);
    uint reaching = 0u;
    for (int s = 0; s < SHADOW_SAMPLES; ++s) reaching |= shadow_words[s];
    // Bits of points before, and of nothing behind.
    int skipped = first - 32 * layer, used = first + count - 32 * layer;
    if (skipped > 0) reaching &= ~0u << skipped;
    if (used < 32) reaching &= (1u << used) - 1u;
    for (; reaching != 0u; reaching &= reaching - 1u) {
      int i = LIGHT_POINTS + 32 * layer + findLSB(reaching) - first;
      float share = unit_irradiance(light_points[i].place, position, normal) * light_points[i].power.w;
      if (share > 0.0) share *= seen(light_points[i].medium.w);
      if (share > 0.0) irradiance += light_points[i].power.rgb * share * way_share(i, position);
    }
  }
  return irradiance;
}
#endif

vec3 irradiance_of_lights(vec3 normal, vec3 position) {
  vec3 irradiance = vec3(0.0);
  float unit = 0.0;
  for (int i = 0; i < LIGHT_POINTS; ++i) {
    if (light_points[i].plane.w == 0.0) unit = unit_irradiance(light_points[i].place, position, normal);
    if (unit > 0.0) irradiance += light_points[i].power.rgb * (unit * seen(light_points[i].medium.w));
  }
#ifdef VIRTUAL_LIGHTS
  irradiance += irradiance_of_virtual_lights(normal, position);
#endif
  return irradiance;
}
#endif
