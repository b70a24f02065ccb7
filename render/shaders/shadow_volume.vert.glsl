// A vertex of a shadow volume, on the caster or moved away from the light; needs raster_view.glsl.

layout(location = 0) in vec4 in_position;  // mm, relative to the mesh's own origin; w = 0: moved away from the light

layout(location = 0) uniform vec3 origin_high;  // these as in raster_surface.vert.glsl
layout(location = 1) uniform vec3 origin_low;
layout(location = 16) uniform mat3 mesh_axes;
layout(location = 2) uniform vec4 light;   // in the mesh's frame: position, w = 1; or direction towards it, w = 0
layout(location = 3) uniform float reach;  // mm by which vertices are moved away; 0: to infinity

out gl_PerVertex {
  vec4 gl_Position;
  float gl_ClipDistance[1];
};

void main() {
  precise vec3 from_origin = (in_position.xyz - origin_high) - origin_low;
  vec3 away = light.w * in_position.xyz - light.xyz;
  vec4 relative = vec4(mesh_axes * from_origin, 1.0);
  if (in_position.w == 0.0)
    relative = reach > 0.0 ? vec4(mesh_axes * (from_origin + reach * normalize(away)), 1.0)
                           : vec4(mesh_axes * away, 0.0);
  gl_Position = clip_from_relative * relative;
  // Depth is clamped, for what lies beyond the far plane; the near one cuts as it does elsewhere.
  gl_ClipDistance[0] = gl_Position.w - gl_Position.z;
}
