// Light that a camera ray collects by one scattering under one light, a ray per invocation: methods/legendre_fluids/light_rays.cpp. A
// dispatch takes each ray on by one stretch, between two cuts, in which density and depths are polynomials; what it leaves for the next
// lies in buffers by pixel. With NEGATIVE, light_cut.comp says where the stretch ends and light_columns.comp what light reaches it; where
// its kinks are no polynomial, the next round tries half of it. With SHADOWED, light_shadows.comp says where surfaces shade the ray, which
// waits where that is not known yet.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "common/loops_cut.glsl"
#include "common/phase.glsl"
#include "legendre_fluids/light_media.glsl"
#include "legendre_fluids/light_stretch.glsl"
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // along the rays [m]
layout(std430, binding = AT_REACHED) buffer Reached { double reached[]; };                // how far a ray is done [m]
layout(std430, binding = AT_COLUMNS) buffer Columns { float columns[]; };                 // of each medium up to there [m]
layout(std430, binding = AT_AIRLIGHT_LAYER) buffer Airlight { float airlight[]; };
#if NEGATIVE
layout(std430, binding = AT_STRETCHES) buffer Stretches { dvec2 stretches[]; };  // of light_cut.comp
layout(std430, binding = AT_WAYS) readonly buffer Ways { float ways[]; };        // of light_columns.comp
uniform float bent;                     // depth that may be missed where it has kinks
const float least_stretch = 1. / 4096;  // of half a box
float missed, missed_share;             // depth towards the light, of the medium where it is the most; over what may be
#endif
#if SHADOWED
#include "legendre_fluids/light_shade.glsl"
uniform int has_shadow;  // may surfaces stand before the light
#endif
#if NEGATIVE || SHADOWED
layout(std430, binding = AT_WALKED) buffer Walked {
  uint rounds;            // in which a ray still had a stretch
  uint at_limit;          // stretches that were not halved any more, though light has kinks in them
  uint most_missed_bits;  // greatest depth that the last orders of one of those had: a float
};
uniform int round;
// The ray still has a stretch in this round.
void note_round() {
  if (rounds <= uint(round)) atomicMax(rounds, uint(round) + 1u);
}
#endif
uniform int has_distances, begins, has_light, first_light;
uniform int phase_kind[MEDIA];
uniform float phase_g[MEDIA];
uniform vec3 irradiance;
uniform float tolerance, widest;  // widest: range of the depth over a panel
int lit_here;                     // does light reach the stretch
const int most_halvings = 22;

// Series over the stretch: of each medium the depth towards eye and light [m], the density.
vec4 depth_series[MEDIA * SERIES_FOURS], density_series[MEDIA * SERIES_FOURS];
vec3 source_of[MEDIA], source_noise;

#if NEGATIVE
// Rounding error of a column towards the light [m].
float noise_of(int m, vec3 rate) {
  float longest = 1e37;
  for (int a = 0; a < 3; ++a)
    if (rate[a] != 0) longest = min(longest, 2 / abs(rate[a]));
  return density_noise(m) * longest;
}
#endif

// Fills the series of a medium over a stretch; `before` is its column up to there. Gives that behind it.
float expand(int m, dvec3 middle, dvec3 direction, float half_length, bool within, float before, int at_way) {
  vec3 rate = vec3(to_light * per_half[m]), slope = vec3(direction * per_half[m]) * half_length;
  dvec3 local = (middle - box_middle[m]) * per_half[m];
  vec3 at = vec3(local);
  Way way = way_from(local, rate);
  if (lit_here == 0) way.lit = false;
  vec4 d[SERIES_FOURS], c[SERIES_FOURS];
  for (int b = 0; b < SERIES_FOURS; ++b) d[b] = c[b] = vec4(0);
  for (int q = 0; q < SERIES; ++q) {
    vec3 place = at + rule[RULE_NODES + q / 4][q % 4] * slope;
    float density = within ? max(density_at(m, place), 0) : 0;
#if NEGATIVE
    float column = lit_here != 0 ? ways[at_way + q] : 0;
#else
    float column = column_from(m, place, rate, way);
#endif
    for (int b = 0; b < SERIES_FOURS; ++b) {
      vec4 analysis = rule[RULE_ANALYSIS + q * SERIES_FOURS + b];
      d[b] += analysis * density;
      c[b] += analysis * column;
    }
  }
#if NEGATIVE
  float last_ones = 0, extinction = max(sigma_t[m].x, max(sigma_t[m].y, sigma_t[m].z));
  for (int k = SERIES > 3 ? SERIES - 3 : 0; k < SERIES; ++k) last_ones += abs(c[k / 4][k % 4]) / sqrt(float(k) + 0.5);
  float may_be = max(bent, extinction * noise_of(m, rate));
  missed = max(missed, extinction * last_ones);
  missed_share = max(missed_share, extinction * last_ones / may_be);
#endif
  c[0].x += before;
  // The integral from the stretch's begin: of P_k it is (P_{k+1} - P_{k-1}) / (2k + 1).
  for (int k = 0; k < SERIES; ++k) {
    float lower = k > 0 ? d[(k > 0 ? k - 1 : 0) / 4][(k > 0 ? k - 1 : 0) % 4] / float(2 * k - 1) : d[0].x;
    float upper = k + 1 < SERIES ? d[(k + 1) / 4][(k + 1) % 4] / float(2 * k + 3) : 0;
    c[k / 4][k % 4] += half_length * (lower - upper);
  }
  for (int b = 0; b < SERIES_FOURS; ++b) {
    density_series[m * SERIES_FOURS + b] = d[b];
    depth_series[m * SERIES_FOURS + b] = c[b];
  }
  return before + 2 * half_length * max(d[0].x, 0);
}

// Gauss points over the panel of that middle and half width of [-1, 1]; the least and greatest depth of each channel there.
vec3 panel(float middle, float half_width, inout vec3 least, inout vec3 greatest) {
  vec3 sum = vec3(0);
  for (int b = 0; b < PANEL_FOURS; ++b) {
    vec4 z = middle + half_width * rule[RULE_PANEL + 2 * b], weight = rule[RULE_PANEL + 2 * b + 1];
    vec4 depth[3], source[3];
    for (int c = 0; c < 3; ++c) depth[c] = source[c] = vec4(0);
    for (int m = 0; m < MEDIA; ++m) {
      vec4 before = vec4(0), p = vec4(1), e = vec4(0), r = vec4(0);
      for (int k = 0; k < SERIES; ++k) {
        e += depth_series[m * SERIES_FOURS + k / 4][k % 4] * p;
        r += density_series[m * SERIES_FOURS + k / 4][k % 4] * p;
        vec4 next = (float(2 * k + 1) * z * p - float(k) * before) / float(k + 1);
        before = p, p = next;
      }
      for (int c = 0; c < 3; ++c) {
        depth[c] += sigma_t[m][c] * e;
        source[c] += source_of[m][c] * r;
      }
    }
    for (int c = 0; c < 3; ++c) {
      sum[c] += half_width * dot(weight * exp(-clamp(depth[c], 0, 200)), source[c]);
      vec2 low = min(depth[c].xy, depth[c].zw), high = max(depth[c].xy, depth[c].zw);
      least[c] = min(least[c], min(low.x, low.y));
      greatest[c] = max(greatest[c], max(high.x, high.y));
    }
  }
  return sum;
}

// Over [-1, 1]: a panel is halved until its halves say the same, and the depth changes little over it.
vec3 integral(vec3 so_far) {
  vec3 sum = vec3(0);
  int level = 0, index = 0;
  for (int step_ = 0; step_ < 4096 && index < 1 << level; ++step_) {
    float half_width = exp2(float(-level)), middle = -1 + (2 * index + 1) * half_width;
    vec3 whole = vec3(0), halves = vec3(0);
    vec3 least = vec3(1e37), greatest = vec3(-1e37);
    for (int part = 0; part < 3; ++part) {
      float at = part == 0 ? middle : middle + (float(part) - 1.5) * half_width;
      vec3 got = panel(at, part == 0 ? half_width : 0.5 * half_width, least, greatest);
      if (part == 0)
        whole = got;
      else
        halves += got;
    }
    vec3 range = greatest - least;
    bool black = all(greaterThan(least - range, vec3(100))), fine = all(lessThanEqual(range, vec3(widest)));
    bvec3 close = lessThanEqual(abs(whole - halves), tolerance * (so_far + sum + halves) + half_width * source_noise);
    if (!(black || (fine && all(close))) && level < most_halvings) {
      ++level, index *= 2;
      continue;
    }
    sum += halves;
    ++index;
    if (level > 0 && (index & 1) == 0) --level, index /= 2;
  }
  if (index < 1 << level) sum = vec3(uintBitsToFloat(0x7fc00000u));  // no number, rather than a wrong one
  return sum;
}

#if !NEGATIVE
void begin(int place) {
  for (int m = 0; m < MEDIA; ++m) columns[place * MEDIA + m] = 0;
  for (int c = 0; c < 3 && first_light != 0; ++c) airlight[3 * place + c] = 0;
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int place = pixel.y * view_width + pixel.x;
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
#if NEGATIVE
  double last = reached[place], next = stretches[place].x;
  bool any = next < nowhere, waits = next < 0;  // for the edge of a shadow
#else
  double last = begins != 0 ? 0 : reached[place], next = nowhere;
  if (begins != 0) begin(place);
  if (last >= nowhere) return;
  double end = has_distances != 0 ? double(distances[place]) : nowhere;
  bool any = true, waits = false;
#if SHADOWED
  waits = has_shadow != 0 && (shades[place].flags & shade_waits) != 0;
#endif
  if (!waits) any = next_stretch(origin, direction, end, last, next);
#if SHADOWED
  if (has_shadow != 0 && any && !waits) waits = !cut_by_shade(place, last, next);
#endif
#endif
#if SHADOWED
  if (waits) {
    reached[place] = last;
    note_round();
    return;
  }
#endif
  lit_here = has_light;
#if SHADOWED
  if (has_shadow != 0 && (shades[place].flags & shade_lit) == 0) lit_here = 0;
  if (has_shadow != 0 && any) note_round();
#endif
  if (any) {
    dvec3 middle = origin + 0.5LF * (last + next) * direction;
    float half_length = float(0.5LF * (next - last)), after[MEDIA];
    double cosine = dot(to_light, direction);
#if NEGATIVE
    missed = missed_share = 0;
    note_round();
#endif
    source_noise = vec3(0);
    for (int m = 0; m < MEDIA; ++m) {
      after[m] = expand(m, middle, direction, half_length, inside(m, middle), columns[place * MEDIA + m], (place * MEDIA + m) * SERIES);
      source_of[m] = scattering[m] * phase_value(phase_kind[m], phase_g[m], float(1 - cosine), float(1 + cosine));
      source_noise += source_of[m] * density_noise(m);
    }
#if NEGATIVE
    bool again = missed_share > 1;
    stretches[place].y = again ? 0.5LF * (next - last) : 2 * stretches[place].y;
    for (int m = 0; m < MEDIA; ++m) again = again && float(next - last) * length(vec3(direction * per_half[m])) > least_stretch;
    if (again) return;  // by halves, in the next round
    if (missed_share > 1) {
      atomicAdd(at_limit, 1u);
      atomicMax(most_missed_bits, floatBitsToUint(missed));
    }
#endif
    for (int m = 0; m < MEDIA; ++m) columns[place * MEDIA + m] = after[m];
    vec3 before = vec3(airlight[3 * place], airlight[3 * place + 1], airlight[3 * place + 2]);
    if (lit_here != 0) {
      vec3 sum = before + irradiance * half_length * integral(abs(before) / max(abs(irradiance) * half_length, vec3(1e-30)));
      bool broken = loops_cut();
#if SHADOWED
      broken = broken || (has_shadow != 0 && (shades[place].flags & shade_broken) != 0);
#endif
      if (broken) sum = vec3(uintBitsToFloat(0x7fc00000u));  // no number, rather than a wrong one
      for (int c = 0; c < 3; ++c) airlight[3 * place + c] = sum[c];
    }
  }
  reached[place] = next;
}
