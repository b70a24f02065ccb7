// The one shading model of all modes (docs/decisions/0001); needs raster_view.glsl. Variants: LIGHTS, of which the first
// DIRECTIONAL_LIGHTS have the directional kind. They are constants because a loop over a number known only at run time cost
// a tenth of a frame on llvmpipe. SKY_TEXTURE: instead of one colour. Programs
// that only show the sky do without them. LIGHT_POINTS: lights cast shadows, and raster_lights.glsl comes before.

#ifndef LIGHTS
#define LIGHTS 0
#define DIRECTIONAL_LIGHTS 0
#endif

const float kPi = 3.14159265358979;

layout(binding = 7) uniform sampler2D sky_texture;

/// Radiance of a Lambert surface. `normal`: interpolated, towards the viewer; `position`: relative to the view.
vec3 shade(vec3 albedo, vec3 emissive, vec3 normal, vec3 position) {
  vec3 irradiance = vec3(parameters.y);
#ifdef LIGHT_POINTS
  irradiance += irradiance_of_lights(normal, position);
#else
  for (int i = 0; i < DIRECTIONAL_LIGHTS; ++i)
    irradiance += lights[i].radiance.rgb * max(0.0, dot(normal, lights[i].position.xyz));
  for (int i = DIRECTIONAL_LIGHTS; i < LIGHTS; ++i) {
    vec3 to_light = lights[i].position.xyz - position;
    float inverse_distance = inversesqrt(dot(to_light, to_light));
    // Intensity is the irradiance at 1 m = 1000 mm, and falls with the distance squared.
    float fall_off = 1e6 * inverse_distance * inverse_distance;
    irradiance += lights[i].radiance.rgb * (fall_off * max(0.0, dot(normal, to_light) * inverse_distance));
  }
#endif
  return emissive + albedo * irradiance;
}

/// Radiance of the sky in a world direction of any length. Equirectangular: the top row is +z, the centre +y.
vec3 sky(vec3 direction) {
#ifdef SKY_TEXTURE
  vec3 d = normalize(direction);
  vec2 st = vec2(0.5 + atan(d.x, d.y) / (2.0 * kPi), acos(clamp(d.z, -1.0, 1.0)) / kPi);
  return textureLod(sky_texture, st, 0.0).rgb;
#else
  return sky_color.rgb;
#endif
}
