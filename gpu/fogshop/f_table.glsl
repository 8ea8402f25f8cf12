// L_a^h as printed before Eq. 17 of Zhou et al. 2007, by the paper's table of F (methods/fogshop/f_table.cpp).
//
// The table holds the difference F(u, pi/2) - F. It falls along v at an ever smaller rate, so that no difference of two entries is
// below 1/255 of them, and digits are kept. F itself comes so close to its limit that the difference of two values has no digits left
// in single precision.
float rest_of_f(int entry) { return fog_table[F_TABLE_FROM + entry]; }  // u slowest
const float u_max = 10;

// F(u, v + step) - F(u, v) in one row of the table, linear between its entries; places in entries.
float f_between(int row, float v, float step_) {
  const int last = F_TABLE - 2;
  int i = min(int(v), last), j = min(int(v + step_), last);
  int from = row * F_TABLE + i, to = row * F_TABLE + j;
  float here = rest_of_f(from) - rest_of_f(from + 1);
  if (i == j) return here * step_;
  float there = rest_of_f(to) - rest_of_f(to + 1);
  // Both shares from the step itself, whose digits a sum with v would lose.
  return (float(i + 1) - v) * here + (rest_of_f(from + 1) - rest_of_f(to)) + (step_ - (float(j) - v)) * there;
}

float homogeneous_airlight(LightFromRay light, float length_, float beta) {
  if (!(beta > 0) || !(length_ > 0)) return 0;
  float d_sv = length(vec2(light.along, light.h));
  if (!(d_sv > 0)) return far_away;
  float h = max(light.h, 1e-12 * d_sv);  // the printed form divides by sin gamma
  // v runs from gamma/2 on by half the angle between the ends of the ray as seen from the light.
  float angle = angle_of(h, h * (h / length_) - light.along * ((length_ - light.along) / length_));
  const float entries = float(F_TABLE - 1) / pi;  // to an angle of 2
  float x = sqrt(clamp(beta * h / u_max, 0, 1)) * float(F_TABLE - 1);
  int row = min(int(x), F_TABLE - 2);
  float from = angle_of(h, light.along) * entries, step_ = angle * entries;
  float difference = mix(f_between(row, from, step_), f_between(row + 1, from, step_), x - float(row));
  if (!(difference > 0)) return 0;
  // The exponential in two halves: behind the light it alone may be beyond what a float can hold.
  float half_way = exp(-0.5 * beta * light.along);
  return min(half_way * (beta / (2 * pi * h) * difference) * half_way, far_away);
}
