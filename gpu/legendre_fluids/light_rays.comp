// Light that a camera ray collects by one scattering under one light, a ray per invocation: methods/legendre_fluids/light_rays.cpp for
// densities that are nowhere below 0. A dispatch takes each ray on by one stretch, between two cuts, in which density and depths are
// polynomials; what it leaves for the next lies in buffers by pixel.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "common/loops_cut.glsl"
#include "common/phase.glsl"
#include "legendre_fluids/light_media.glsl"
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // along the rays [m]
layout(std430, binding = AT_REACHED) buffer Reached { double reached[]; };                // how far a ray is done [m]
layout(std430, binding = AT_COLUMNS) buffer Columns { float columns[]; };                 // of each medium up to there [m]
layout(std430, binding = AT_AIRLIGHT) buffer Airlight { float airlight[]; };
uniform int has_distances, begins, has_light, first_light;
uniform int phase_kind[MEDIA];
uniform float phase_g[MEDIA];
uniform vec3 irradiance;
uniform float tolerance, widest;  // widest: range of the depth over a panel
#define SERIES_FOURS ((SERIES + 3) / 4)
const int most_halvings = 22;
const double least_share = 1e-14LF;

// Series over the stretch: of each medium the depth towards eye and light [m], the density.
vec4 depth_series[MEDIA * SERIES_FOURS], density_series[MEDIA * SERIES_FOURS];
vec3 source_of[MEDIA];

// The next cut after `last`; `nowhere` where there is none.
double next_cut(dvec3 origin, dvec3 direction, double end, double last) {
  double next = nowhere, after = last + least_share * last;
  for (int m = 0; m < MEDIA; ++m) {
    Local ray = local_ray(m, origin, direction);
    dvec2 part = chord(ray, end);
    bool meets = part.x < part.y;
    if (meets && part.x > after) next = min(next, part.x);
    if (meets && part.y > after) next = min(next, part.y);
    dvec3 rate = to_light * per_half[m];
    for (int a = 0; a < 3; ++a) {
      int b = (a + 1) % 3;
      double turn = ray.slope[a] * rate[b] - ray.slope[b] * rate[a];
      if (turn == 0) continue;
      double side_a = rate[a] > 0 ? 1 : -1, side_b = rate[b] > 0 ? 1 : -1;
      for (int edge = MEDIA > 1 ? 0 : 3; edge < 4; ++edge) {
        double at_a = (edge & 1) != 0 ? side_a : -side_a, at_b = (edge & 2) != 0 ? side_b : -side_b;
        double t = ((at_a - ray.origin[a]) * rate[b] - (at_b - ray.origin[b]) * rate[a]) / turn;
        if (t > after && t < (MEDIA > 1 ? end : part.y) && (MEDIA > 1 || t > part.x)) next = min(next, t);
      }
    }
  }
  return next;
}

bool inside(int medium, dvec3 at) { return all(lessThanEqual(abs((at - box_middle[medium]) * per_half[medium]), dvec3(1))); }

// Fills the series of a medium over a stretch; `before` is its column up to there. Gives that behind it.
float expand(int m, dvec3 middle, dvec3 direction, float half_length, bool within, float before) {
  vec3 rate = vec3(to_light * per_half[m]), slope = vec3(direction * per_half[m]) * half_length;
  dvec3 local = (middle - box_middle[m]) * per_half[m];
  vec3 at = vec3(local);
  Way way = way_from(local, rate);
  if (has_light == 0) way.lit = false;
  vec4 d[SERIES_FOURS], c[SERIES_FOURS];
  for (int b = 0; b < SERIES_FOURS; ++b) d[b] = c[b] = vec4(0);
  for (int q = 0; q < SERIES; ++q) {
    vec3 place = at + rule[RULE_NODES + q / 4][q % 4] * slope;
    float density = within ? max(density_at(m, place), 0) : 0, column = column_from(m, place, rate, way);
    for (int b = 0; b < SERIES_FOURS; ++b) {
      vec4 analysis = rule[RULE_ANALYSIS + q * SERIES_FOURS + b];
      d[b] += analysis * density;
      c[b] += analysis * column;
    }
  }
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
    bvec3 close = lessThanEqual(abs(whole - halves), tolerance * (so_far + sum + halves));
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

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int place = pixel.y * view_width + pixel.x;
  double last = begins != 0 ? 0 : reached[place];
  if (begins != 0) {
    for (int m = 0; m < MEDIA; ++m) columns[place * MEDIA + m] = 0;
    for (int c = 0; c < 3 && first_light != 0; ++c) airlight[3 * place + c] = 0;
  }
  if (last >= nowhere) return;
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  double end = has_distances != 0 ? double(distances[place]) : nowhere, next = 0;
  bool any = false;
  while (!any) {
    next = next_cut(origin, direction, end, last);
    if (next >= nowhere) break;
    dvec3 middle = origin + 0.5LF * (last + next) * direction;
    for (int m = 0; m < MEDIA; ++m) any = any || inside(m, middle);
    if (!any) last = next;
  }
  if (any) {
    dvec3 middle = origin + 0.5LF * (last + next) * direction;
    float half_length = float(0.5LF * (next - last));
    double cosine = dot(to_light, direction);
    for (int m = 0; m < MEDIA; ++m) {
      int at = place * MEDIA + m;
      columns[at] = expand(m, middle, direction, half_length, inside(m, middle), columns[at]);
      source_of[m] = scattering[m] * phase_value(phase_kind[m], phase_g[m], float(1 - cosine), float(1 + cosine));
    }
    vec3 before = vec3(airlight[3 * place], airlight[3 * place + 1], airlight[3 * place + 2]);
    if (has_light != 0) {
      vec3 sum = before + irradiance * half_length * integral(before / max(irradiance * half_length, vec3(1e-30)));
      if (loops_cut()) sum = vec3(uintBitsToFloat(0x7fc00000u));  // no number, rather than a wrong one
      for (int c = 0; c < 3; ++c) airlight[3 * place + c] = sum[c];
    }
  }
  reached[place] = next;
}
