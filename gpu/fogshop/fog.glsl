// The medium: a constant plus Gaussians (Zhou et al. 2007, Eqs. 6, 7), and Eq. 31 for one of them along a ray.
const float pi = 3.14159265358979;
const float far_away = 1e37;  // [m] and beyond: an infinite ray

struct Gaussian {
  vec3 center;           // [m]
  float a;               // 1/width [1/m]
  float half_depth;      // c sqrt(pi) / (2 a) [-]
  float radius_squared;  // [m^2] beyond which it is left out
  float place;           // in the whole list
  float unused;
};

layout(std430, binding = 0) readonly buffer Gaussians { Gaussian gaussians[]; };
uniform int gaussian_count;
uniform float constant;  // extinction without Gaussians where the hue is 1 [1/m]
uniform vec3 hue;        // extinction per channel over the greatest
uniform vec3 albedo;

// x times a polynomial in z = ERF_SCALE x^2 - 1 up to ERF_CUT, +-1 beyond: the coefficients of methods/fogshop/erf-inl.h.
const float erf_coefficient[ERF_COUNT] = float[ERF_COUNT](ERF_COEFFICIENTS);
float erf(float x) {
  float magnitude = abs(x), xc = min(magnitude, ERF_CUT), z = ERF_SCALE * xc * xc - 1, sum = erf_coefficient[ERF_COUNT - 1];
  for (int i = ERF_COUNT - 2; i >= 0; --i) sum = sum * z + erf_coefficient[i];
  float value = magnitude > ERF_CUT ? 1 : min(xc * sum, 1);
  return x < 0 ? -value : value;
}

// A Gaussian as a line meets it: its optical depth over [0, t] is depth (erf(a (t - middle)) + erf(a middle)).
struct Crossing {
  bool met;
  float middle, chord;  // [m]
  float a, depth, base;
};
Crossing cross_line(Gaussian g, vec3 origin, vec3 direction, float length_) {
  Crossing c;
  vec3 q = g.center - origin;
  c.middle = dot(q, direction);
  vec3 p = q - c.middle * direction;  // not |q|^2 - m^2, which loses all digits far away
  float pp = dot(p, p), chord_squared = g.radius_squared - pp;
  c.chord = sqrt(max(chord_squared, 0));
  c.met = chord_squared >= 0 && c.middle + c.chord >= 0 && c.middle - c.chord <= length_;
  c.a = g.a;
  c.depth = g.half_depth * exp(-g.a * g.a * pp);
  c.base = erf(g.a * c.middle);
  return c;
}
float depth_at(Crossing c, float t) { return c.depth * max(erf(c.a * (t - c.middle)) + c.base, 0); }

// Optical depth of the Gaussians between two points, each cut off at its radius.
float depth_between(vec3 from, vec3 to, int without) {
  float length_ = length(to - from), sum = 0;
  vec3 direction = length_ > 0 ? (to - from) / length_ : vec3(0, 0, 1);
  for (int i = 0; i < gaussian_count; ++i) {
    Gaussian g = gaussians[i];
    vec3 q = g.center - from, p = q - dot(q, direction) * direction;
    if (dot(p, p) > g.radius_squared || i == without) continue;  // most, before any exponential
    Crossing c = cross_line(g, from, direction, length_);
    if (c.met) sum += depth_at(c, length_);
  }
  return sum;
}

// Of a depth where the hue is 1; a channel that the medium does not dim stays 1 however deep it is.
vec3 transmittance_of(float depth) { return mix(vec3(1), exp(-hue * depth), greaterThan(hue, vec3(0))); }
