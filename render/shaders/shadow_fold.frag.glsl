// Takes one light's bit from the pixels that the stencil selects (a logical operation does it).
layout(location = 0) uniform uint bits;
layout(location = 0) out vec4 out_bits;
void main() { out_bits = unpackUnorm4x8(bits); }
