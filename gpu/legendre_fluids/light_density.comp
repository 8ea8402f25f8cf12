// A medium's density becomes that of a flow on this device.
layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = AT_STATE) readonly buffer State { float state[]; };         // of fields.glsl
layout(std430, binding = AT_TARGETS) writeonly buffer Targets { float targets[]; };  // what densities are, as a storage block
uniform int medium, field, n;

void main() {
  int e = int(gl_GlobalInvocationID.x);
  if (e >= n * n * n) return;
  ivec3 index = ivec3(e / (n * n), e / n % n, e % n);
  vec3 norm = sqrt(vec3(index) + 0.5);
  targets[((medium * NX + index.x) * NY + index.y) * 4 * FOURS_Z + index.z] = state[field * n * n * n + e] * norm.x * norm.y * norm.z;
}
