// Adds one sample's picture, weighted, to the sum (blending does the adding).
layout(binding = 0) uniform sampler2D picture;
layout(location = 2) uniform float weight;
layout(location = 0) out vec4 out_color;
void main() { out_color = weight * texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }
