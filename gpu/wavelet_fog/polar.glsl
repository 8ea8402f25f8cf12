// Integrals from the eye by angle and distance: methods/wavelet_fog/polar_table.h. Needs column.glsl. In double precision, since what
// counts are differences: where a ray is steep, of what is nearly the same.
#include "common/angle.glsl"
layout(std430, binding = AT_TABLE) readonly buffer Table { double table[]; };  // [angle][distance]: of f, of s f, and f there
uniform int table_angles, table_steps;
uniform int table_first_step;  // of entry 0, from the eye
uniform float table_middle_u, table_middle_v;  // direction in the middle of the fan, unit
uniform float table_span, table_spacing, table_step;  // [rad], [rad], [cells]
const double upright = UPRIGHT;         // [cells] over the ground below which the table has nothing to say

// From 0 to b with these slopes at the ends.
float hermite(float t, float slope_a, float b, float slope_b) {
  float w = 1 - t;
  return w * w * t * slope_a + t * t * ((1 + 2 * w) * b - w * slope_b);
}

// Integrals of f and s f up to r cells along a spoke.
dvec2 on_spoke(int angle, float r) {
  int first = clamp(angle, 0, table_angles - 1) * (table_steps + 1);
  float place = clamp(r / table_step - float(table_first_step), 0.0, float(table_steps));
  int k = min(int(place), table_steps - 1), a = 3 * (first + k), b = a + 3;
  float t = place - float(k), slope = table_step * table_step;
  float at_a = float(table[a + 2]), at_b = float(table[b + 2]);
  dvec2 m = dvec2(table[a], 0);
  m.x += hermite(t, table_step * at_a, float(table[b] - table[a]), table_step * at_b);
#if PROFILE == PROFILE_LAYERS
  m.y = table[a + 1] + hermite(t, slope * float(table_first_step + k) * at_a, float(table[b + 1] - table[a + 1]),
                               slope * float(table_first_step + k + 1) * at_b);
#endif
  return m;
}

dvec2 looked_up(vec2 along, float r) {
  vec2 turned_ = vec2(table_middle_u * along.x + table_middle_v * along.y, table_middle_u * along.y - table_middle_v * along.x);
  float place = (angle_of(turned_.y, turned_.x) + 0.5 * table_span) / table_spacing + 1;
  int i = clamp(int(place), 0, table_angles - 2);
  float t = place - float(i);
  dvec2 q = on_spoke(i, r);
  vec2 p = vec2(on_spoke(i - 1, r) - q), u = vec2(on_spoke(i + 1, r) - q), v = vec2(on_spoke(i + 2, r) - q);
  return q + 0.5 * t * (u - p + t * (2 * p + 4 * u - v + t * (v - p - 3 * u)));
}

float column_of_table(dvec3 origin, dvec3 direction, double length_, inout uint lookups) {
  Line line = line_over(origin, direction);
  dvec2 t = clip_to_region(origin, direction, dvec2(0, length_));
  double across = length(line.along), reach = double(table_first_step + table_steps) * double(table_step);
  if (across * t.y > reach) t.y = reach / across;  // the map need not be met: the table knows where it is
  if (!(t.y > t.x)) return 0;
  if (!(across * (t.y - t.x) > upright)) return column(origin, direction, length_);
  vec2 along = vec2(line.along / across);
  dvec2 before = dvec2(0);
  if (t.x > 0) before = looked_up(along, float(t.x * across)), ++lookups;
  float sum = 0;
  for (int k = 0; k < pieces_of(line); ++k) {
    int below;
    dvec2 piece = between_knots(line, t, k, below);
    if (!(piece.y > piece.x)) continue;
    dvec2 upto = looked_up(along, float(piece.y * across)), of_piece = upto - before;
    ++lookups;
    before = upto;
    // The factor from where the piece begins, so that what a steep one takes away is not lost in what lies before it.
    Factor factor = factor_between(line, below);
    sum += float(factor.value + factor.slope * piece.x) * float(of_piece.x) +
           float(factor.slope / across) * float(of_piece.y - piece.x * across * of_piece.x);
  }
  return sum / float(across);
}
