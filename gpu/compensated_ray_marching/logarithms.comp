// Logarithms of the source radiance of all cells, which are interpolated between cells.
layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = AT_RADIANCE) readonly buffer Radiance { vec4 radiance[]; };
layout(std430, binding = AT_LOGARITHMS) writeonly buffer Logarithms { vec4 logarithms[]; };
layout(std430, binding = AT_GREATEST) readonly buffer Greatest { uint greatest; };
uniform int cells;

void main() {
  int cell = int(gl_GlobalInvocationID.x);
  if (cell >= cells) return;
  float least = max(1e-6 * uintBitsToFloat(greatest), 1.2e-38);  // LitGrid::towards
  // Without any light the result must be exactly 0.
  logarithms[cell] = greatest == 0u ? vec4(-1000) : log(max(radiance[cell], vec4(least)));
}
