// Variant VS2: one Gaussian over the squared distance from the light, and the two nodes where its light is attenuated. The
// steps and their names are those of methods/fogshop/voigt.cpp, the sums are made for single precision.
#if VOIGT
// Of u = a (t - m) under the density exp(-u^2) / ((X - u)^2 + Y^2); all but the integral central.
struct VoigtMoments {
  float integral, mean, variance, third;
};

const float voigt_cut = 3, voigt_reach = 4.5;  // [widths]
const float rule_node[16] = float[16](RULE_NODES), rule_weight[16] = float[16](RULE_WEIGHTS);  // Gauss-Legendre, [-1, 1]

// By the trapezoidal rule, whose error for an entire function is exp(-(pi/h)^2) = 1e-11, and the residue of the pole at
// z = X + iY. With F(u) = (i/pi) u^k exp(-u^2) / (z - u), whose real part is Y/pi u^k times the density, and nodes at whole
// multiples of h,
//   integral of F = h sum F(u_n) + 2 z^k exp(-z^2) / (1 - exp(-2 pi i z/h)),
// and 1 + exp(...) for nodes half-way between them (Chiarella and Reichel 1968; k = 0 is the Faddeeva function). Of both rules
// that is taken whose nodes keep off X: then its sum and residue do not cancel, and neither do the moments about the mean.
const float trapezoid = 0.625;  // h: whole multiples are exact

VoigtMoments voigt_moments(float X, float Y) {
  const float h = trapezoid, whole_turn = 2 * pi;
  float off = X - h * round(X / h), turn = whole_turn * off / h;
  bool half_way = abs(off) <= 0.25 * h;
  vec2 pole = vec2(0);  // 2 pi/Y exp(-z^2) / (1 -+ exp(-2 pi i z/h)); beyond these bounds below 1e-10 of the integral
  if (Y < 5 && abs(X) < 9) {
    // Numerator and denominator times exp(-2 pi Y/h): neither overflows.
    float side = half_way ? 1 : -1, size = 2 * exp(Y * Y - X * X - whole_turn * Y / h);
    vec2 below = vec2(exp(-whole_turn * Y / h) + side * cos(turn), -side * sin(turn));
    vec2 above = vec2(cos(2 * X * Y), -sin(2 * X * Y));
    pole = pi / Y * size / dot(below, below) *
           vec2(above.x * below.x + above.y * below.y, above.y * below.x - above.x * below.y);
  }
  float density[16], first = (half_way ? -7.5 : -8) * h, sum = 0, about_zero = 0;
#define VOIGT_EIGHT(n, DO) DO(n) DO(n + 1) DO(n + 2) DO(n + 3) DO(n + 4) DO(n + 5) DO(n + 6) DO(n + 7)
#define VOIGT_DENSITY(n)                                                      \
  {                                                                           \
    float u = first + float(n) * h;                                           \
    density[n] = h * exp(-u * u) / ((u - X) * (u - X) + Y * Y);               \
    sum += density[n];                                                        \
    about_zero += u * density[n];                                             \
  }
  VOIGT_EIGHT(0, VOIGT_DENSITY)
  VOIGT_EIGHT(8, VOIGT_DENSITY)
  float integral = sum + pole.x;
  // Then about the mean that this gives, which need not be exact: powers of what is left of z and u.
  float mean = (about_zero + X * pole.x - Y * pole.y) / integral;
  vec2 z = vec2(X - mean, Y), one = vec2(z.x * pole.x - z.y * pole.y, z.x * pole.y + z.y * pole.x);
  vec2 two = vec2(z.x * one.x - z.y * one.y, z.x * one.y + z.y * one.x);
  vec3 m = vec3(one.x, two.x, z.x * two.x - z.y * two.y);
#define VOIGT_POWERS(n)                                \
  {                                                    \
    float u = first + float(n) * h - mean;             \
    m += u * density[n] * vec3(1, u, u * u);           \
  }
  VOIGT_EIGHT(0, VOIGT_POWERS)
  VOIGT_EIGHT(8, VOIGT_POWERS)
  m /= integral;
  return VoigtMoments(integral, mean + m.x, m.y - m.x * m.x, m.z - 3 * m.x * m.y + 2 * m.x * m.x * m.x);
}

// Of the part of the Gaussian between two values of u: 16 points at even angles from the light in each half. Powers are
// taken about the place closest to the light, where the density is greatest.
VoigtMoments part_moments(float X, float Y, float lo, float hi) {
  float about = clamp(X, lo, hi), middle = 0.5 * (lo + hi);
  vec4 sum = vec4(0);
  for (int part = 0; part < 2; ++part) {
    float begin = part == 0 ? lo : middle, end = part == 0 ? middle : hi, xa = begin - X, xb = end - X;
    float span = angle_of(Y * (end - begin), Y * Y + xa * xb);
    for (int k = 0; k < 16; ++k) {
      float slope = tan(0.5 * (1 + rule_node[k]) * span);
      // From the light where it is close, from the end of the part where it is far: each has lost the other's digits.
      float x = clamp((xa + Y * slope) / (1 - xa * slope / Y), xa, xb);
      float u = clamp(begin + slope * (Y * Y + xa * xa) / (Y - xa * slope), begin, end), v = X == about ? x : u - about;
      float weight = 0.5 * rule_weight[k] * span / Y * exp(-u * u);
      sum += weight * vec4(1, v, v * v, v * v * v);
    }
  }
  if (!(sum.x > 0)) return VoigtMoments(0, 0, 0, 0);
  vec3 m = sum.yzw / sum.x;
  return VoigtMoments(sum.x, about + m.x, m.y - m.x * m.x, m.z - 3 * m.x * m.y + 2 * m.x * m.x * m.x);
}

// Two places on the ray and what each counts: their sum is the integral of the Gaussian's extinction over d^2 [1/m^2].
struct VoigtNodes {
  vec2 t, weight;
};
VoigtNodes voigt_nodes(Crossing c, float length_, LightFromRay light) {
  float a = c.a, h = max(length(vec2(light.h, source_radius)), 1e-9);
  float X = a * (light.along - c.middle), Y = a * h, left = length_ - c.middle;
  VoigtMoments v;
  if (a * c.middle < voigt_cut || left < voigt_cut / a) {
    float lo = max(-a * c.middle, -voigt_reach), hi = a * min(left, voigt_reach / a);
    if (!(lo < hi)) return VoigtNodes(vec2(c.middle), vec2(0));
    v = part_moments(X, Y, lo, hi);
  } else {
    v = voigt_moments(X, Y);
  }
  // Extinction in the middle, du = a dt, and 1/d^2 is a^2 over the density's.
  float total = c.depth * 2 * a * a / sqrt(pi) * v.integral;
  float deviation = sqrt(max(v.variance, 1e-12)), skew = 0.5 * v.third / (deviation * deviation * deviation);
  // Where the light is close the skewness is great: one node near the light has nearly all, and the other's share and the
  // first one's offset are differences of great numbers unless written so.
  float side = skew < 0 ? -1 : 1, root = length(vec2(1, skew)), both = root + abs(skew);
  vec2 u = v.mean + side * deviation * vec2(-1 / both, both);
  return VoigtNodes(c.middle + u / a, total * 0.5 * vec2(1 + abs(skew) / root, 1 / (root * both)));
}
#endif
