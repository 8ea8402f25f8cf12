// A line of numbers of an invocation, and products of matrices with it. Lines lie in the shared `work`, their numbers `step_` apart. All
// loops run to constants where these are called, so that the line is in registers.
shared float work[WORK];
vec4 line[FOURS];

// line = T^T v: entry o is the sum over k of row k, column o of T, times v_k.
void combine(int table, int fours, int count, int from, int step_) {
  for (int b = 0; b < fours; ++b) line[b] = vec4(0);
  for (int k = 0; k < count; ++k) {
    float v = work[from + k * step_];
    for (int b = 0; b < fours; ++b) line[b] += matrices[table + k * fours + b] * v;
  }
}

void take(int fours, int count, int from, int step_) {
  for (int b = 0; b < fours; ++b)
    for (int c = 0; c < 4; ++c) line[b][c] = 4 * b + c < count ? work[from + (4 * b + c) * step_] : 0;
}

void put(int fours, int count, int to, int step_) {
  for (int b = 0; b < fours; ++b)
    for (int c = 0; c < 4; ++c)
      if (4 * b + c < count) work[to + (4 * b + c) * step_] = line[b][c];
}

// Row i of T times the line.
float row_times_line(int table, int fours, int i) {
  float sum = 0;
  for (int b = 0; b < fours; ++b) sum += dot(matrices[table + i * fours + b], line[b]);
  return sum;
}
