// Offsets of steps: reference/half_resolution_march/jitter.cpp. In double precision, or noise loses its digits on large films.
uniform int jitter;  // 0 none, 1 bayer, 2 noise

float step_offset(ivec2 at, int frame) {
  if (jitter == 0) return 0.5;
  double first;
  if (jitter == 1) {
    int value = 0;
    for (int bit = 0; bit < 3; ++bit) {
      int i = at.x >> bit & 1, j = at.y >> bit & 1;
      value = 4 * value + 2 * (i ^ j) + j;
    }
    first = (double(value) + 0.5LF) / 64;
  } else {
    first = fract(52.9829189LF * fract(0.06711056LF * double(at.x) + 0.00583715LF * double(at.y)));
  }
  return float(clamp(fract(first + double(frame) * 0.6180339887498949LF), 1e-6LF, 1 - 1e-6LF));
}
