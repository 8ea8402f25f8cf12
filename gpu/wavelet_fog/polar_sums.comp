// Sums along the spokes of a table, a spoke per invocation.
layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = AT_TABLE) buffer Table { double table[]; };
uniform int table_angles, table_steps;

void main() {
  int angle = int(gl_GlobalInvocationID.x);
  if (angle >= table_angles) return;
  dvec2 sum = dvec2(0);
  for (int k = 0; k <= table_steps; ++k) {
    int entry = 3 * (angle * (table_steps + 1) + k);
    sum += dvec2(table[entry], table[entry + 1]);
    table[entry] = sum.x;
    table[entry + 1] = sum.y;
  }
}
