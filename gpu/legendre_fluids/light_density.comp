// A medium's density becomes that of a flow on this device, in three dispatches: taken over, its least value looked for at points, and
// drawn towards its mean where it is below 0: still a polynomial, of the same mass (section 10, theta).
layout(local_size_x = LOCAL_SIZE_X) in;
#include "legendre_fluids/light_media.glsl"
layout(std430, binding = AT_STATE) readonly buffer State { float state[]; };  // of fields.glsl
layout(std430, binding = AT_TARGETS) buffer Targets { float targets[]; };     // what densities are, as a storage block
layout(std430, binding = AT_STATUS) buffer Status { uint least_bits; };
uniform int part, medium, field, n;
const float margin = 0.02;  // of the distance from the mean, for what lies between points

// Floats in the order of unsigned integers.
uint ordered(float v) {
  uint bits = floatBitsToUint(v);
  return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}
float unordered(uint bits) { return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits); }

// Share that the limited polynomial keeps of its distance from the mean.
float share(float mean) {
  float least = unordered(least_bits);
  least -= margin * (mean - least);
  return mean <= 0 ? 0 : least < 0 ? mean / (mean - least) : 1;
}

void main() {
  int e = int(gl_GlobalInvocationID.x);
  if (part == 1) {
    int side = 2 * n, points = side * side * side;
    if (e >= points) return;
    vec3 at = (2 * vec3(e / (side * side), e / side % side, e % side) + 1) / float(side) - 1;
    at = sin(0.5 * 3.14159265 * at);  // denser towards the walls
    atomicMin(least_bits, ordered(density_at(medium, at)));
    return;
  }
  if (e >= n * n * n) return;
  ivec3 index = ivec3(e / (n * n), e / n % n, e % n);
  int to = ((medium * NX + index.x) * NY + index.y) * 4 * FOURS_Z + index.z;
  if (part == 0) {
    vec3 norm = sqrt(vec3(index) + 0.5);
    targets[to] = state[field * n * n * n + e] * norm.x * norm.y * norm.z;
    if (e == 0) least_bits = 0xffffffffu;
  } else {
    float mean = targets[medium * NX * NY * 4 * FOURS_Z];
    if (e > 0) targets[to] *= share(mean);
  }
}
