// LANE_ROWS rows of three numbers for each invocation, in shared memory, a lane beside the other: private arrays that are indexed lie
// in scratch memory, and spill registers.
const int lane_count = LOCAL_SIZE_X * LOCAL_SIZE_Y;
shared float lane_rows[3 * (LANE_ROWS) * lane_count];

vec3 row_at(int row) {
  int k = 3 * row * lane_count + int(gl_LocalInvocationIndex);
  return vec3(lane_rows[k], lane_rows[k + lane_count], lane_rows[k + 2 * lane_count]);
}
void set_row(int row, vec3 value) {
  int k = 3 * row * lane_count + int(gl_LocalInvocationIndex);
  for (int c = 0; c < 3; ++c) lane_rows[k + c * lane_count] = value[c];
}
