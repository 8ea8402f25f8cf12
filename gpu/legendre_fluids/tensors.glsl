// What a work group does together with numbers in double precision: sums, and matrices along one axis of a tensor. The includer declares
// the buffers `tables` and `work`.
#define lane int(gl_LocalInvocationID.x)
shared double partial[LOCAL_SIZE_X];

void together() {
  memoryBarrierBuffer();
  barrier();
}

// Sum over all lanes, returned to all of them.
double total(double mine) {
  partial[lane] = mine;
  barrier();
  for (int half_ = LOCAL_SIZE_X / 2; half_ > 0; half_ /= 2) {
    if (lane < half_) partial[lane] += partial[lane + half_];
    barrier();
  }
  double sum = partial[0];
  barrier();
  return sum;
}

// Along one axis of [outer][columns][inner]: entry (r, k) of the matrix is tables[table + r steps.x + k steps.y].
void transform(int table, ivec2 steps, int rows, int columns, int outer, int inner, int from, int to) {
  int all = outer * rows * inner;
  for (int e = lane; e < all; e += LOCAL_SIZE_X) {
    int i = e % inner, r = e / inner % rows, first = from + e / (inner * rows) * columns * inner + i, at = table + r * steps.x;
    double sum = 0;
    for (int k = 0; k < columns; ++k) sum += tables[at + k * steps.y] * work[first + k * inner];
    work[to + e] = sum;
  }
  together();
}
