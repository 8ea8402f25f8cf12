// The splines of degree DEGREE in one cell, and exact integrals over a piece of a line in it: scene/media/spline_integral.h.
#if MEDIA > 1  // of each medium's degree; rows and cells hold zeros beyond it
#define Row vec4
#define Cell mat4
Row row_at(int p) {
  Row row = Row(values[p], 0, 0, 0);
  if (DEGREE > 0) row.y = values[p - 1];
  if (DEGREE > 1) row.z = values[p - 2];
  if (DEGREE > 2) row.w = values[p - 3];
  return row;
}
Cell cell_at(int p, int stride) {
  // At once: NVIDIA's compiler (580) loses columns that are set one by one under conditions.
  return Cell(row_at(p), DEGREE > 0 ? row_at(p - stride) : Row(0), DEGREE > 1 ? row_at(p - 2 * stride) : Row(0),
              DEGREE > 2 ? row_at(p - 3 * stride) : Row(0));
}
Row basis(float u) {
  float w = 1 - u;
  if (DEGREE == 0) return Row(1, 0, 0, 0);
  if (DEGREE == 1) return Row(u, w, 0, 0);
  if (DEGREE == 2) return Row(0.5 * u * u, 0.5 + u * w, 0.5 * w * w, 0);
  return Row(u * u * u, 1 + 3 * u * (1 + u * w), 1 + 3 * w * (1 + u * w), w * w * w) * (1.0 / 6);
}
float in_cell(Cell c, vec2 x) { return dot(basis(x.x) * c, basis(x.y)); }
#else
#if DEGREE == 0
#define Row float
#define Cell float
Row row_at(int p) { return values[p]; }
Cell cell_at(int p, int stride) { return row_at(p); }
float in_cell(Cell c, vec2 x) { return c; }
#else
#if DEGREE == 1
#define Row vec2
#define Cell mat2
Row row_at(int p) { return vec2(values[p], values[p - 1]); }
Cell cell_at(int p, int stride) { return Cell(row_at(p), row_at(p - stride)); }
Row basis(float u) { return vec2(u, 1 - u); }
#elif DEGREE == 2
#define Row vec3
#define Cell mat3
Row row_at(int p) { return vec3(values[p], values[p - 1], values[p - 2]); }
Cell cell_at(int p, int stride) { return Cell(row_at(p), row_at(p - stride), row_at(p - 2 * stride)); }
Row basis(float u) {
  float w = 1 - u;
  return vec3(0.5 * u * u, 0.5 + u * w, 0.5 * w * w);
}
#else
#define Row vec4
#define Cell mat4
Row row_at(int p) { return vec4(values[p], values[p - 1], values[p - 2], values[p - 3]); }
Cell cell_at(int p, int stride) { return Cell(row_at(p), row_at(p - stride), row_at(p - 2 * stride), row_at(p - 3 * stride)); }
Row basis(float u) {
  float w = 1 - u;
  return vec4(u * u * u, 1 + 3 * u * (1 + u * w), 1 + 3 * w * (1 + u * w), w * w * w) * (1.0 / 6);
}
#endif
// Column k of the cell belongs to v, entry m of it to u.
float in_cell(Cell c, vec2 x) { return dot(basis(x.x) * c, basis(x.y)); }
#endif
#endif

const float node[POINTS] = float[](NODES), weight[POINTS] = float[](WEIGHTS);

// Integrals of f and s f over s from x to y; `at` where the line is at s = 0, from the cell's corner.
vec2 moments_in_cell(Cell c, vec2 at, vec2 along, vec2 s) {
  float length_ = s.y - s.x;
  vec2 sum = vec2(0);
  for (int k = 0; k < POINTS; ++k) {
    COUNT_LOOP
    float here = s.x + node[k] * length_;
    sum += weight[k] * in_cell(c, at + here * along) * vec2(1, here);
  }
  return length_ * sum;
}

#if FALLS
const float fall_node[FALL_POINTS] = float[](FALL_NODES), fall_weight[FALL_POINTS] = float[](FALL_WEIGHTS);

// Integral of f exp(-(height + fall s)) over s in a cell. `height`: height over the base at s = 0, in scale heights; `fall`: its change
// per unit of s. Parts of at most one scale height are summed from the lower end until the rest is below rounding.
float falling_in_cell(Cell c, vec2 at, vec2 along, vec2 s, float height, float fall) {
  const float deep = 24;
  float length_ = s.y - s.x, zeta = abs(fall) * length_, parts = max(1.0, ceil(zeta));
  float part = length_ / parts, fallen = zeta / parts, low = fall > 0 ? s.x : s.y, step_ = fall > 0 ? part : -part;
  float least = height + low * fall, sum = 0;
  for (float i = 0; i < parts && i * fallen < deep; ++i) {
    COUNT_LOOP
    float of_part = 0;
    for (int k = 0; k < FALL_POINTS; ++k) {
      COUNT_LOOP
      of_part += fall_weight[k] * exp(-fallen * fall_node[k]) * in_cell(c, at + (low + (i + fall_node[k]) * step_) * along);
    }
    sum += exp(-(least + i * fallen)) * of_part;
  }
  return part * sum;
}
#endif
