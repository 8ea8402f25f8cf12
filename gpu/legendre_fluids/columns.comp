// Columns along x in modes along y and z, one to an invocation: to modes along x, what pressure or diffusion does to each, and back. The
// pressure leaves two: what goes on along y and z, and what it adds to the component along x.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "legendre_fluids/fields.glsl"
layout(std430, binding = AT_PRESSURE) buffer Pressure { float pressure[]; };
layout(std430, binding = AT_SPREAD) buffer Spread { float spread[]; };
uniform int diffuses, first_field;
uniform vec3 per_area;                          // half size^-2 of each axis
uniform float velocity_amount, carried_amount;  // of diffusion, times time [m^2]

// Eigenvalue of mode (l, j, k). For the pressure all axes end at walls; for diffusion only a component's own axis does.
float rate(int field, int l, int j, int k) {
  bool all = diffuses == 0;
  int x = all || field == 0 ? TABLE_WALL_RATES : TABLE_FREE_RATES, y = all || field == 1 ? TABLE_WALL_RATES : TABLE_FREE_RATES;
  int z = all || field == 2 ? TABLE_WALL_RATES : TABLE_FREE_RATES;
  return per_area.x * number(x, l) + per_area.y * number(y, j) + per_area.z * number(z, k);
}

float changed(float mode, float rate, int field) {
  if (diffuses == 0) return rate > 0 ? -mode / rate : 0;
  return mode * exp(-min((field < D ? velocity_amount : carried_amount) * rate, 200));
}

void main() {
  int column = int(gl_GlobalInvocationID.x), field = first_field + int(gl_WorkGroupID.y);
  if (column >= SLAB) return;
  int table = diffuses != 0 ? modes_at(field, 0) : TABLE_PRESSURE_MODES, from = (diffuses != 0 ? field * SIZE : 0) + column;
  vec4 modes[SQUARE_FOURS];
  for (int b = 0; b < SQUARE_FOURS; ++b) modes[b] = vec4(0);
  for (int i = 0; i < N; ++i) {
    float v = diffuses != 0 ? spread[from + i * SLAB] : pressure[from + i * SLAB];
    for (int b = 0; b < SQUARE_FOURS; ++b) modes[b] += matrices[table + i * SQUARE_FOURS + b] * v;
  }
  for (int b = 0; b < SQUARE_FOURS; ++b)
    for (int c = 0; c < 4; ++c)
      modes[b][c] = 4 * b + c < N ? changed(modes[b][c], rate(field, 4 * b + c, column / NZ, column % NZ), field) : 0;
  for (int i = 0; i < N; ++i) {
    float sum = 0, along_x = 0;
    for (int b = 0; b < SQUARE_FOURS; ++b) {
      sum += dot(matrices[table + i * SQUARE_FOURS + b], modes[b]);
      along_x += dot(matrices[TABLE_LIFT + i * SQUARE_FOURS + b], modes[b]);
    }
    if (diffuses != 0) {
      spread[from + i * SLAB] = sum;
    } else {
      pressure[from + i * SLAB] = sum;
      pressure[SIZE + from + i * SLAB] = along_x;
    }
  }
}
