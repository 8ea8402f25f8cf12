// Where a camera ray is sampled: reference/ray_marcher/spacing.cpp, in single precision. Parts near a light are measured from the
// light, so that short steps far from the camera keep their digits.
uniform int steps;
uniform float step_length;  // [m]; > 0: instead of the count
uniform float horizon;      // [-]

// x / h = u / (1 - u^2)^3 from (-1, 1) onto the line, its derivative, its inverse.
float stretch(float u) {
  float w = (1 - u) * (1 + u);
  return u / (w * w * w);
}
float stretch_slope(float u) {
  float w = (1 - u) * (1 + u);
  return (1 + 5 * u * u) / (w * w * w * w);
}
float unstretch(float x) {
  float size = abs(x), lo = 0, hi = 1;
  float u = size < 1 ? 0.5 * size : 1 - 0.5 / pow(size, 1.0 / 3);
  for (int i = 0; i < 40; ++i) {
    float value = stretch(u);
    if (value > size)
      hi = u;
    else
      lo = u;
    // Newton on the logarithm where the map is steep, on the map itself near 0.
    float next = size < 1 ? u - (value - size) / stretch_slope(u) : u - value * log(value / size) / stretch_slope(u);
    if (abs(next - u) <= 1e-7) break;
    u = next > lo && next < hi ? next : 0.5 * (lo + hi);
  }
  return x < 0 ? -u : u;
}

// log(1 + x) for x in (-1, 0], its digits kept near 0; and exp(x) - 1 for x <= 0.
float log_one_plus(float x) {
  if (x < -0.25) return log(1 + x);
  float z = x / (2 + x), w = z * z;
  return 2 * z * (1 + w * (1.0 / 3 + w * (1.0 / 5 + w / 7)));
}
float exp_minus_one(float x) {
  if (x < -0.25) return exp(x) - 1;
  return x * (1 + x / 2 * (1 + x / 3 * (1 + x / 4 * (1 + x / 5 * (1 + x / 6)))));
}

// Between two cuts. Its measure is proportional to the number of its steps, each of which has the same share.
struct Part {
  float lo, hi;     // [m]
  uint in_constant;  // bit k: in the region of layer k, which has a constant
  uint in_varied;    // bit k: where layer k varies
  bool grows;        // measure exp(-growth (t - lo) / 2) dt
  bool zone;         // around the light, measure proportional to du of the map
  float u_lo, u_hi;  // its ends there
  float weight;      // factor of the measure
};
const int most_parts = 4 * LAYERS + 3;

// Lists of an invocation lie in shared memory while 32 KiB are enough: compilers spill thousands of registers over private
// arrays that are indexed at run time, and llvmpipe (Mesa 22.3) writes to the wrong member of structures in them.
#if LAYERS * LOCAL_SIZE_X * LOCAL_SIZE_Y <= 320
#define LIST(type, name, size) shared type name[(size) * LOCAL_SIZE_X * LOCAL_SIZE_Y]
#define MINE(i) ((i) * LOCAL_SIZE_X * LOCAL_SIZE_Y + int(gl_LocalInvocationIndex))
#else
#define LIST(type, name, size) type name[size]
#define MINE(i) (i)
#endif
LIST(float, part_lo, most_parts);
LIST(float, part_hi, most_parts);
LIST(uint, part_flags, most_parts);   // up to 15 layers in_varied, in_constant << 15; grows << 30, zone << 31
#if LAYERS > 15
LIST(uint, part_varied, most_parts);
LIST(uint, part_constant, most_parts);
#endif
LIST(float, part_share, most_parts);  // weight; in the zone u_lo
LIST(float, part_u_hi, most_parts);
int part_count;
float growth;       // [1/m]
float zone_weight;  // of all parts there

#if LAYERS > 15
uint varied_at(int i, uint flags) { return part_varied[MINE(i)]; }
uint constant_at(int i, uint flags) { return part_constant[MINE(i)]; }
#else
uint varied_at(int i, uint flags) { return flags & 0x7fffu; }
uint constant_at(int i, uint flags) { return flags >> 15 & 0x7fffu; }
#endif
Part part_at(int i) {
  uint flags = part_flags[MINE(i)];
  float share = part_share[MINE(i)];
  bool zone = (flags >> 31) != 0u;
  return Part(part_lo[MINE(i)], part_hi[MINE(i)], constant_at(i, flags), varied_at(i, flags), (flags >> 30 & 1u) != 0u, zone, share,
              part_u_hi[MINE(i)], zone ? zone_weight : share);
}
void put_part(int i, float lo, float hi, uint in_varied, uint in_constant) {
  part_lo[MINE(i)] = lo, part_hi[MINE(i)] = hi, part_share[MINE(i)] = 1;
#if LAYERS > 15
  part_flags[MINE(i)] = 0u, part_varied[MINE(i)] = in_varied, part_constant[MINE(i)] = in_constant;
#else
  part_flags[MINE(i)] = in_varied | in_constant << 15;
#endif
}
void move_part(int from, int to) {
  part_lo[MINE(to)] = part_lo[MINE(from)], part_hi[MINE(to)] = part_hi[MINE(from)];
  part_flags[MINE(to)] = part_flags[MINE(from)], part_share[MINE(to)] = part_share[MINE(from)];
#if LAYERS > 15
  part_varied[MINE(to)] = part_varied[MINE(from)], part_constant[MINE(to)] = part_constant[MINE(from)];
#endif
}
bool varies_at(int i) { return varied_at(i, part_flags[MINE(i)]) != 0u; }

float deepest;     // reference/ray_marcher/spacing.h
bvec3 never_ends;  // per channel: the medium behind the last step goes on for ever

float measure(Part p) {
  if (p.zone) return p.weight * (p.u_hi - p.u_lo);
  return p.weight * (p.grows ? -exp_minus_one(-0.5 * growth * (p.hi - p.lo)) * 2 / growth : p.hi - p.lo);
}
float measure_of_all() {
  float sum = 0;
  for (int i = 0; i < part_count; ++i) sum += measure(part_at(i));
  return sum;
}

void cut_ray(vec3 origin, vec3 direction, float t_end) {
  // Cuts and ranges are stored in the lists of the parts: cuts stand in front of the parts made from them. For each layer there is a
  // range where its constant holds, and one where it varies.
  int cut_count = 0;
  for (int k = 0; k < layer_count; ++k) {
    vec2 whole = clip_region(k, origin, direction, vec2(0, t_end));
    for (int varied = 0; varied < 2; ++varied) {
      vec2 e = (varied == 0 ? layers[k].constant == 0 : layers[k].field == field_none) ? nothing : whole;
      if (varied == 1 && e.x < e.y) e = clip_field(k, origin, direction, e);
      part_u_hi[MINE(4 * k + 2 * varied)] = e.x, part_u_hi[MINE(4 * k + 2 * varied + 1)] = e.y;
      for (int end = 0; end < 2 && e.x < e.y; ++end) {
        float t = end == 0 ? e.x : e.y;
        int at = cut_count++;
        for (; at > 0 && part_lo[MINE(at - 1)] > t; --at) part_lo[MINE(at)] = part_lo[MINE(at - 1)];
        part_lo[MINE(at)] = t;
      }
    }
  }
  part_count = 0;
  for (int i = 0; i + 1 < cut_count; ++i) {
    float lo = part_lo[MINE(i)], hi = part_lo[MINE(i + 1)];
    if (!(lo < hi)) continue;
    uint in_varied = 0u, in_constant = 0u;
    for (int k = 0; k < layer_count; ++k) {
      if (part_u_hi[MINE(4 * k)] <= lo && part_u_hi[MINE(4 * k + 1)] >= hi) in_constant |= 1u << k;
      if (part_u_hi[MINE(4 * k + 2)] <= lo && part_u_hi[MINE(4 * k + 3)] >= hi) in_varied |= 1u << k;
    }
    if ((in_varied | in_constant) != 0u) put_part(part_count++, lo, hi, in_varied, in_constant);
  }
}

// Extinction of constant media in the least extinct channel that sees any [1/m].
float least_rate(vec3 sum) {
  float least = far_away;
  for (int c = 0; c < 3; ++c)
    if (sum[c] > 0) least = min(least, sum[c]);
  return least == far_away ? 0 : least;
}

// Cuts the part within which t lies in two. A growing part goes on where it was. Before there is a zone.
void split_at(float t) {
  int i = 0;
  while (i < part_count && !(part_lo[MINE(i)] < t && t < part_hi[MINE(i)])) ++i;
  if (i == part_count) return;
  for (int j = part_count; j > i; --j) move_part(j - 1, j);
  ++part_count;
  if ((part_flags[MINE(i)] >> 30 & 1u) != 0u) part_share[MINE(i + 1)] *= exp(-0.5 * growth * (t - part_lo[MINE(i)]));
  part_hi[MINE(i)] = t;
  part_lo[MINE(i + 1)] = t;
}

// Splits the parts at the zone around the light. False if there is no zone on this ray.
bool grade_light(Approach light) {
  float whole = measure_of_all();
  float radius = pow(whole / 12, 0.75) * pow(light.h, 0.25), lo = light.t - radius, hi = light.t + radius;
  if (!(radius > light.h)) return false;
  split_at(lo);
  split_at(hi);
  zone_weight = light.h * stretch_slope(unstretch(radius / light.h));
  bool met = false;
  for (int i = 0; i < part_count; ++i) {
    float from = part_lo[MINE(i)], to = part_hi[MINE(i)];
    if (!(from >= lo && to <= hi)) continue;
    met = true;
    part_flags[MINE(i)] = (part_flags[MINE(i)] & 0x3fffffffu) | 1u << 31;
    part_share[MINE(i)] = unstretch((from - light.t) / light.h);
    part_u_hi[MINE(i)] = unstretch((to - light.t) / light.h);
  }
  return met;
}

// reference/ray_marcher/spacing.h
float beyond_lamp(Approach lamp, float from, float longer) {
  float along = lamp.t - from, d = length(vec2(along, lamp.h));
  float turn = along > 0 ? lamp.h * lamp.h / (d + along) : d - along;
  return 0.5 * longer * (2 * d + longer) / (turn + longer);
}

const float deep_lamp = 4;

// The parts of the ray over [0, t_end]; with a light, graded around it, and true if that makes a difference.
bool lay_parts(vec3 origin, vec3 direction, float t_end, bool has_light, Approach light) {
  never_ends = bvec3(false);
  deepest = 40;
  growth = zone_weight = 0;
  cut_ray(origin, direction, t_end);
  if (part_count == 0) return false;
  int last = part_count - 1;
  if (part_hi[MINE(last)] >= far_away) {
    uint inside = constant_at(last, part_flags[MINE(last)]);
    float from = part_lo[MINE(last)];
    vec3 rates = vec3(0);
    for (int k = 0; k < layer_count; ++k)
      if ((inside >> k & 1u) != 0u) {
        rates += layers[k].constant * layers[k].sigma_t;
        for (int c = 0; c < 3; ++c) never_ends[c] = never_ends[c] || layers[k].sigma_t[c] > 0;
      }
    float rate = least_rate(rates), reach = horizon / rate, growing = has_light ? light.t : from;
    float most = max(max(rates.x, rates.y), rates.z);
    for (int l = has_light ? balls - 1 : 0; l < balls; ++l) {
      Approach lamp = light;
      if (!has_light) lamp = approach(lights[l], origin, direction);
      if (rate * (lamp.t - from) > deep_lamp) growing = max(growing, lamp.t);
      reach = max(reach, beyond_lamp(lamp, from, horizon / rate));
      deepest = max(deepest, min(40 + most * length(vec2(lamp.t - from, lamp.h)), 110));
    }
    part_hi[MINE(last)] = from + reach;
    // From there on steps grow.
    if (graded != 0 && growing < from + reach) {
      if (growing > from) split_at(growing);
      growth = rate;
      part_flags[MINE(part_count - 1)] |= 1u << 30;
    }
  }
  if (graded == 0) return false;
  // At most as many steps for the constant parts as for the varying ones.
  float varied = 0, constant = 0;
  for (int i = 0; i < part_count; ++i) {
    float share = measure(part_at(i));
    varied += varies_at(i) ? share : 0;
    constant += varies_at(i) ? 0 : share;
  }
  if (varied > 0 && constant > varied)
    for (int i = 0; i < part_count; ++i)
      if (!varies_at(i)) part_share[MINE(i)] = varied / constant;
  return has_light && light.h > 0 && grade_light(light);
}
