// Media as polynomials in boxes, MEDIA of them: densities, and columns towards a directional light. Coefficients are those of Legendre
// polynomials P without a norm, [x][y][z], NX x NY x 4 FOURS_Z for every medium. With NEGATIVE a density below 0 is taken as 0.
layout(std140, binding = AT_DENSITIES) uniform Densities { vec4 densities[MEDIA * NX * NY * FOURS_Z]; };
layout(std140, binding = AT_RULE) uniform Rule { vec4 rule[RULE]; };  // Rule of lit_media.cpp
uniform dvec3 box_middle[MEDIA], per_half[MEDIA];                    // [m], [1/m]
uniform vec3 sigma_t[MEDIA], scattering[MEDIA];                      // [1/m]
uniform dvec3 to_light;
const double nowhere = 1e37LF;
#define SERIES_FOURS ((SERIES + 3) / 4)

// P_0 to P_{3 + 4 FOURS_Z} and so on at a place of [-1, 1]^3, and the density there.
float density_at(int medium, vec3 at) {
  vec4 pz[FOURS_Z];
  float py[NY], before = 0, p = 1;
  for (int k = 0; k < 4 * FOURS_Z; ++k) {
    pz[k / 4][k % 4] = p;
    float next = (float(2 * k + 1) * at.z * p - float(k) * before) / float(k + 1);
    before = p, p = next;
  }
  before = 0, p = 1;
  for (int j = 0; j < NY; ++j) {
    py[j] = p;
    float next = (float(2 * j + 1) * at.y * p - float(j) * before) / float(j + 1);
    before = p, p = next;
  }
  before = 0, p = 1;
  float sum = 0;
  int row = medium * NX * NY * FOURS_Z;
  for (int i = 0; i < NX; ++i) {
    float plane = 0;
    for (int j = 0; j < NY; ++j) {
      float line = 0;
      for (int b = 0; b < FOURS_Z; ++b) line += dot(densities[row + j * FOURS_Z + b], pz[b]);
      plane += py[j] * line;
    }
    row += NY * FOURS_Z;
    sum += p * plane;
    float next = (float(2 * i + 1) * at.x * p - float(i) * before) / float(i + 1);
    before = p, p = next;
  }
  return sum;
}

const float rounding = 2e-7;  // of sums in single precision, of the size of their terms

// Rounding error of densities: they are sums of terms that cancel.
float density_noise(int medium) {
  float squares = 0;
  for (int i = 0; i < NX * NY * FOURS_Z; ++i) {
    vec4 c = densities[medium * NX * NY * FOURS_Z + i];
    squares += dot(c, c);
  }
  return rounding * sqrt(squares);
}

#if NEGATIVE
#include "common/sign_changes.glsl"
#endif

// A ray in a medium's own coordinates.
struct Local {
  dvec3 origin, slope;  // slope per metre
};
Local local_ray(int medium, dvec3 origin, dvec3 direction) {
  return Local((origin - box_middle[medium]) * per_half[medium], direction * per_half[medium]);
}

// The part of [0, end] in the box; x >= y: none.
dvec2 chord(Local ray, double end) {
  dvec2 part = dvec2(0, end);
  for (int a = 0; a < 3; ++a) {
    if (ray.slope[a] == 0) {
      if (abs(ray.origin[a]) > 1) part.y = -1;
      continue;
    }
    double inverse = 1 / ray.slope[a], s = (-1 - ray.origin[a]) * inverse, t = (1 - ray.origin[a]) * inverse;
    part = dvec2(max(part.x, min(s, t)), min(part.y, max(s, t)));
  }
  return part;
}

// How light comes in over a stretch of a ray: by the same faces everywhere, told by its middle.
struct Way {
  bool lit;
  int in_axis, out_axis;  // in: -1 within the box
};
Way way_from(dvec3 middle, vec3 rate) {
  Local ray = Local(middle, to_light * 1);
  ray.slope = dvec3(rate);
  dvec2 part = chord(ray, nowhere);
  Way way = Way(part.x < part.y, -1, -1);
  float last = 0, nearest = 1e37;
  for (int a = 0; a < 3; ++a) {
    if (rate[a] == 0) continue;
    float side = rate[a] > 0 ? 1 : -1, in_ = float((-side - middle[a]) / rate[a]), out_ = float((side - middle[a]) / rate[a]);
    if (in_ > last) last = in_, way.in_axis = a;
    if (out_ < nearest) nearest = out_, way.out_axis = a;
  }
  return way;
}

// The integral of the density from a place to the light [m]: by as many Gauss points as are exact.
float column_from(int medium, vec3 at, vec3 rate, Way way) {
  if (!way.lit) return 0;
  for (int a = 0; a < 3; ++a)
    if (way.in_axis == a) at += ((rate[a] > 0 ? -1 : 1) - at[a]) / rate[a] * rate;
  float length_ = 0, sum = 0;
  for (int a = 0; a < 3; ++a)
    if (way.out_axis == a) length_ = max(((rate[a] > 0 ? 1 : -1) - at[a]) / rate[a], 0);
#if NEGATIVE
  vec4 c[SERIES_FOURS];
  series_of(medium, at + 0.5 * length_ * rate, 0.5 * length_ * rate, c);
  return 0.5 * length_ * positive_part(c);
#else
  for (int g = 0; g < WAY_POINTS; ++g) {
    vec4 point = rule[RULE_WAY + g];  // on [0, 1]; weight
    sum += point.y * density_at(medium, at + point.x * length_ * rate);
  }
  return max(sum * length_, 0);
#endif
}
