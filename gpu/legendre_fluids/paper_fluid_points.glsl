// Takes the term of a field's work to the points: into its region `one`; `two` is overwritten.
void to_points(int base) {
  int one = base + ONE_AT, two = base + TWO_AT;
  const ivec2 columns = ivec2(1, M);
#if D == 3
  transform(VALUES_AT, columns, M, N, 1, N * N, base + TERM_AT, one);
  transform(VALUES_AT, columns, M, N, M, N, one, two);
  transform(VALUES_AT, columns, M, N, M * M, 1, two, one);
#else
  transform(VALUES_AT, columns, M, N, 1, N, base + TERM_AT, two);
  transform(VALUES_AT, columns, M, N, M, 1, two, one);
#endif
}
