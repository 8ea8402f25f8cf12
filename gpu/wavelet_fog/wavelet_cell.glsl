// The part of the wavelets of one level in half a cell, as splines of the next finer level: what `pre` sums there, read from the three
// bands (methods/wavelet_fog/band_grid.h).
const float p_taps[P_TAPS] = float[](P_VALUES), q_taps[Q_TAPS] = float[](Q_VALUES);
int wavelets = -1;        // first of the grids ad, da, dd of the level; -1: splines alone
uint wavelet_cells = 0u;  // cells of wavelets that were read
#if DEGREE == 0
#define OUTER(a, b) ((a) * (b))
#define TAPS_ROW(tap, i) tap(i)
#else
#define OUTER(a, b) outerProduct(a, b)
#if DEGREE == 1
#define TAPS_ROW(tap, i) Row(tap(i), tap(i - 1))
#else
#define TAPS_ROW(tap, i) Row(tap(i), tap(i - 1), tap(i - 2))
#endif
#endif

float p_tap(int i) { return i >= P_FIRST && i < P_FIRST + P_TAPS ? p_taps[i - P_FIRST] : 0; }
float q_tap(int i) { return i >= Q_FIRST && i < Q_FIRST + Q_TAPS ? q_taps[i - Q_FIRST] : 0; }

// `half_cell`: in cells of the finer level.
Cell cell_of_wavelets(ivec2 half_cell) {
  ivec2 last = (half_cell - LEAST_TAP) >> 1;
  Cell sum = Cell(0);
  for (int k = 0; k < WINDOW; ++k) {
    int y = half_cell.y - 2 * (last.y - k);
    Row with_p = Row(0), with_q = Row(0);
    for (int m = 0; m < WINDOW; ++m) {
      ivec2 at = last - ivec2(m, k);
      int x = half_cell.x - 2 * at.x;
      Row q = TAPS_ROW(q_tap, x);
      with_p += value_in(grids[wavelets + 1], at) * q;
      with_q += value_in(grids[wavelets], at) * TAPS_ROW(p_tap, x) + value_in(grids[wavelets + 2], at) * q;
    }
    sum += OUTER(with_p, TAPS_ROW(p_tap, y)) + OUTER(with_q, TAPS_ROW(q_tap, y));
  }
  return sum;
}
