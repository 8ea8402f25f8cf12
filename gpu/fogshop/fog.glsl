// The medium: a constant plus Gaussians (Zhou et al. 2007, Eqs. 6, 7), and Eq. 31 for one of them along a ray.
#include "common/pi.glsl"
#include "common/far_away.glsl"

struct Gaussian {
  vec3 center;           // [m]
  float a;               // 1/width [1/m]
  float half_depth;      // c sqrt(pi) / (2 a) [-]
  float radius_squared;  // [m^2] beyond which it is left out
  float place;           // in the whole list
  float unused;
};

layout(std430, binding = AT_GAUSSIANS) readonly buffer Gaussians { Gaussian gaussians[]; };
uniform int gaussian_count;
uniform float constant;  // extinction without Gaussians where `extinction_ratio` is 1 [1/m]
uniform vec3 extinction_ratio;        // extinction per channel over the greatest
uniform float phase_g;   // of the phase function, Henyey-Greenstein's; 0: isotropic
uniform vec3 albedo;
#if COLOURED || NOISE || F_TABLE
layout(std430, binding = AT_FOG_TABLES) readonly buffer FogTables { float fog_table[]; };  // each from its place on
#endif
#if COLOURED  // what each Gaussian, by place, and the constant scatter of that
vec3 colour_of(int gaussian) {
  int at = COLOURS_FROM + 3 * gaussian;
  return vec3(fog_table[at], fog_table[at + 1], fog_table[at + 2]);
}
uniform vec3 constant_colour;
#endif

// 4 pi times the phase function, of light that goes along a direction whose cosine with the view ray is given, towards the viewer.
float phase_of(float along) {
  float square = 1 + phase_g * phase_g + 2 * phase_g * along;
  return (1 - phase_g * phase_g) / (square * sqrt(square));
}

// exp(-extinction_ratio * depth), computed once where all channels have one ratio.
vec3 decay(float depth) {
  vec3 result = vec3(exp(-extinction_ratio.x * depth));
  if (extinction_ratio != extinction_ratio.xxx) {
    result.yz = exp(-extinction_ratio.yz * depth);
  }
  return result;
}

// erfc(|x|): what the error function lacks to its limit. Two of these can be subtracted far out in the tails of a
// Gaussian, where two error functions are both 1.
#if ERF_COUNT == 0
// exp(-x^2) times a polynomial in t = 1/(1 + 0.4 |x|), a minimax fit: relative error 1.3e-7, 3.3e-7 in single precision.
float tail(float x) {
  float magnitude = min(abs(x), 1e4), t = 1 / (1 + 0.4 * magnitude), z = 2 * t - 1, sum = 0.000196337279453;
  sum = sum * z + 0.000141774147163;
  sum = sum * z - 0.00186304571398;
  sum = sum * z - 0.00333590900303;
  sum = sum * z + 0.0113241161312;
  sum = sum * z + 0.0684951686173;
  sum = sum * z + 0.181567895108;
  sum = sum * z + 0.32186109778;
  sum = sum * z + 0.421612690651;
  return exp(-magnitude * magnitude) * t * sum;
}
#else
// erf is x times a polynomial in z = ERF_SCALE x^2 - 1 up to ERF_CUT, 1 beyond: the coefficients of
// methods/fogshop/erf-inl.h.
const float erf_coefficient[ERF_COUNT] = float[ERF_COUNT](ERF_COEFFICIENTS);
float tail(float x) {
  float xc = min(abs(x), ERF_CUT), z = ERF_SCALE * xc * xc - 1, sum = erf_coefficient[ERF_COUNT - 1];
  for (int i = ERF_COUNT - 2; i >= 0; --i) sum = sum * z + erf_coefficient[i];
  return abs(x) > ERF_CUT ? 0 : max(1 - xc * sum, 0);
}
#endif

// A place on a line, in widths of a Gaussian from where the line is closest to it.
struct Place {
  float x, tail;
};
Place place_at(float x) { return Place(x, tail(x)); }
// erf(end.x) - erf(begin.x), begin.x <= end.x; not below 0, where the paper's polynomial is not monotone.
float erf_between(Place begin, Place end) {
  float d = begin.x >= 0 ? begin.tail - end.tail : end.x <= 0 ? end.tail - begin.tail : 2 - begin.tail - end.tail;
  return max(d, 0);
}
// From one place to another, begin <= end. `tail` of the nearer one is the greater. The other's is left out where that changes nothing in
// single precision: erfc(sqrt(x^2 + 17.5)) is below 3e-8 erfc(x) for any x.
float erf_between(float begin, float end, out float tail_of_begin) {
  bool across = begin <= 0 && end >= 0;
  float near = min(abs(begin), abs(end)), far = max(abs(begin), abs(end)), greater = tail(near), less = 0;
#if ERF_COUNT == 0
  if (far * far < near * near + 17.5) {
    less = tail(far);
  }
#else
  less = tail(far);
#endif
  tail_of_begin = abs(begin) > near ? less : greater;
  return max((across ? 2 - greater : greater) - less, 0);
}
float erf_between(float begin, float end) {
  float unused;
  return erf_between(begin, end, unused);
}
const float tail_length = 4.2;  // erfc of it is 2.9e-9, and changes neither 1 nor 2 in single precision
// From far before: erf(end) + 1.
float erf_up_to(float end) {
  float rest = tail(end);
  return end >= 0 ? 2 - rest : rest;
}

// A Gaussian as a line meets it: its optical depth between two places is depth times erf_between.
struct Crossing {
  bool met;
  float middle, chord;  // [m]
  float a, depth;
  Place start;  // of the line
};
// How far from a line a Gaussian is [m^2]: not |q|^2 - m^2, which loses all digits far away.
float square_beside(Gaussian g, vec3 origin, vec3 direction) {
  vec3 q = g.center - origin, p = q - dot(q, direction) * direction;
  return dot(p, p);
}
float depth_beside(Gaussian g, vec3 origin, vec3 direction) {
  return g.half_depth * exp(-g.a * g.a * square_beside(g, origin, direction));
}
// Without its depth and the start of the line, 0 both.
Crossing cross_geometry(Gaussian g, vec3 origin, vec3 direction, float length_) {
  float middle = dot(g.center - origin, direction), outside = max(max(-middle, middle - length_), 0);
  float chord_squared = g.radius_squared - square_beside(g, origin, direction), chord = sqrt(max(chord_squared, 0));
  bool met = chord_squared >= outside * outside;
  return Crossing(met, middle, chord, g.a, 0, Place(0, 0));
}
void complete(inout Crossing c, Gaussian g, vec3 origin, vec3 direction) {
  c.depth = depth_beside(g, origin, direction);
  c.start = place_at(-g.a * c.middle);
}
Crossing cross_line(Gaussian g, vec3 origin, vec3 direction, float length_) {
  Crossing c = cross_geometry(g, origin, direction, length_);
  complete(c, g, origin, direction);
  return c;
}
Place place_at(Crossing c, float t) { return place_at(c.a * (t - c.middle)); }
// Optical depth over [0, t].
float depth_at(Crossing c, float t) { return c.depth * erf_between(c.start, place_at(c, t)); }

// Optical depth of a Gaussian between two points, cut off at its radius.
float depth_between(Gaussian g, vec3 from, vec3 direction, float length_) {
  Crossing c = cross_geometry(g, from, direction, length_);
  float depth = 0;
  if (c.met) {  // few, before any exponential
    depth = depth_beside(g, from, direction) * erf_between(-g.a * c.middle, g.a * (length_ - c.middle));
  }
  return depth;
}

// Transmittance of each channel for the depth of a channel of extinction ratio 1. Where the ratio is 0 it is 1, however deep the fog is.
vec3 transmittance_of(float depth) { return mix(vec3(1), decay(depth), greaterThan(extinction_ratio, vec3(0))); }
