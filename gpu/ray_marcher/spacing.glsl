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
  float rate;        // > 0: measure exp(-rate (t - lo) / 2) dt
  int zone;          // 1: around the light, measure proportional to du of the map
  float u_lo, u_hi;  // its ends there
  float weight;      // factor of the measure
};
const int most_parts = 4 * LAYERS + 3;
// One array per member: llvmpipe (Mesa 22.3) writes to the wrong one in an array of structures indexed at run time.
float part_lo[most_parts], part_hi[most_parts], part_rate[most_parts], part_u_lo[most_parts], part_u_hi[most_parts],
    part_weight[most_parts];
uint part_in_constant[most_parts], part_in_varied[most_parts];
int part_zone[most_parts];
int part_count;

Part part_at(int i) {
  return Part(part_lo[i], part_hi[i], part_in_constant[i], part_in_varied[i], part_rate[i], part_zone[i], part_u_lo[i],
              part_u_hi[i], part_weight[i]);
}
void put_part(int i, Part p) {
  part_lo[i] = p.lo, part_hi[i] = p.hi, part_in_constant[i] = p.in_constant, part_in_varied[i] = p.in_varied;
  part_rate[i] = p.rate, part_zone[i] = p.zone, part_u_lo[i] = p.u_lo, part_u_hi[i] = p.u_hi, part_weight[i] = p.weight;
}

float deepest;     // reference/ray_marcher/spacing.h
bvec3 never_ends;  // per channel: the medium behind the last step goes on for ever

float measure(Part p) {
  float fall = p.rate > 0 ? -exp_minus_one(-0.5 * p.rate * (p.hi - p.lo)) * 2 / p.rate : p.hi - p.lo;
  return p.weight * (p.zone != 0 ? p.u_hi - p.u_lo : fall);
}
float measure_of_all() {
  float sum = 0;
  for (int i = 0; i < part_count; ++i) sum += measure(part_at(i));
  return sum;
}

void cut_ray(vec3 origin, vec3 direction, float t_end) {
  vec2 extents[2 * LAYERS];
  uint constant_bit[2 * LAYERS], varied_bit[2 * LAYERS];
  float cuts[4 * LAYERS];
  int extent_count = 0, cut_count = 0;
  for (int k = 0; k < LAYERS; ++k) {
    vec2 whole = clip_region(k, origin, direction, vec2(0, t_end));
    for (int varied = 0; varied < 2; ++varied) {
      if (varied == 0 ? layers[k].constant == 0 : layers[k].field == field_none) continue;
      vec2 e = whole;
      if (varied == 1 && e.x < e.y) e = clip_field(k, origin, direction, e);
      if (!(e.x < e.y)) continue;
      extents[extent_count] = e;
      constant_bit[extent_count] = varied == 0 ? 1u << k : 0u;
      varied_bit[extent_count++] = varied == 1 ? 1u << k : 0u;
      for (int end = 0; end < 2; ++end) {
        float t = end == 0 ? e.x : e.y;
        int at = cut_count++;
        for (; at > 0 && cuts[at - 1] > t; --at) cuts[at] = cuts[at - 1];
        cuts[at] = t;
      }
    }
  }
  part_count = 0;
  for (int i = 0; i + 1 < cut_count; ++i) {
    if (!(cuts[i] < cuts[i + 1])) continue;
    uint in_constant = 0u, in_varied = 0u;
    for (int e = 0; e < extent_count; ++e)
      if (extents[e].x <= cuts[i] && extents[e].y >= cuts[i + 1])
        in_constant |= constant_bit[e], in_varied |= varied_bit[e];
    if ((in_constant | in_varied) != 0u)
      put_part(part_count++, Part(cuts[i], cuts[i + 1], in_constant, in_varied, 0, 0, 0, 0, 1));
  }
}

// Extinction of the constant media there, in the least extinct channel that sees any [1/m].
float constant_rate(uint inside) {
  vec3 sum = vec3(0);
  for (int k = 0; k < LAYERS; ++k)
    if ((inside >> k & 1u) != 0u) sum += layers[k].constant * layers[k].sigma_t;
  float least = far_away;
  for (int c = 0; c < 3; ++c)
    if (sum[c] > 0) least = min(least, sum[c]);
  return least == far_away ? 0 : least;
}

// Cuts the part within which t lies in two. A growing part goes on where it was.
void split_at(float t) {
  int i = 0;
  while (i < part_count && !(part_lo[i] < t && t < part_hi[i])) ++i;
  if (i == part_count) return;
  for (int j = part_count; j > i; --j) put_part(j, part_at(j - 1));
  ++part_count;
  if (part_rate[i] > 0) part_weight[i + 1] *= exp(-0.5 * part_rate[i] * (t - part_lo[i]));
  part_hi[i] = t;
  part_lo[i + 1] = t;
}

// Splits the parts at the zone around the light. False if there is no zone on this ray.
bool grade_light(Approach light) {
  float whole = measure_of_all();
  float radius = pow(whole / 12, 0.75) * pow(light.h, 0.25), lo = light.t - radius, hi = light.t + radius;
  if (!(radius > light.h)) return false;
  split_at(lo);
  split_at(hi);
  float weight = light.h * stretch_slope(unstretch(radius / light.h));
  bool met = false;
  for (int i = 0; i < part_count; ++i) {
    if (!(part_lo[i] >= lo && part_hi[i] <= hi)) continue;
    met = true;
    part_rate[i] = 0;
    part_zone[i] = 1;
    part_u_lo[i] = unstretch((part_lo[i] - light.t) / light.h);
    part_u_hi[i] = unstretch((part_hi[i] - light.t) / light.h);
    part_weight[i] = weight;
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
  cut_ray(origin, direction, t_end);
  if (part_count == 0) return false;
  int last = part_count - 1;
  if (part_hi[last] >= far_away) {
    for (int k = 0; k < LAYERS; ++k)
      if ((part_in_constant[last] >> k & 1u) != 0u)
        for (int c = 0; c < 3; ++c) never_ends[c] = never_ends[c] || layers[k].sigma_t[c] > 0;
    float rate = constant_rate(part_in_constant[last]);
    float reach = horizon / rate;
    float growing = has_light ? light.t : part_lo[last];
    vec3 rates = vec3(0);
    for (int k = 0; k < LAYERS; ++k)
      if ((part_in_constant[last] >> k & 1u) != 0u) rates += layers[k].constant * layers[k].sigma_t;
    float most = max(max(rates.x, rates.y), rates.z);
    for (int l = has_light ? balls - 1 : 0; l < balls; ++l) {
      Approach lamp = light;
      if (!has_light) lamp = approach(lights[l], origin, direction);
      if (rate * (lamp.t - part_lo[last]) > deep_lamp) growing = max(growing, lamp.t);
      reach = max(reach, beyond_lamp(lamp, part_lo[last], horizon / rate));
      deepest = max(deepest, min(40 + most * length(vec2(lamp.t - part_lo[last], lamp.h)), 110));
    }
    part_hi[last] = part_lo[last] + reach;
    // From there on steps grow.
    if (graded != 0 && growing < part_hi[last]) {
      if (growing > part_lo[last]) split_at(growing);
      part_rate[part_count - 1] = rate;
    }
  }
  if (graded == 0) return false;
  // At most as many steps for the constant parts as for the varying ones.
  float varied = 0, constant = 0;
  for (int i = 0; i < part_count; ++i) {
    float share = measure(part_at(i));
    varied += part_in_varied[i] != 0u ? share : 0;
    constant += part_in_varied[i] != 0u ? 0 : share;
  }
  if (varied > 0 && constant > varied)
    for (int i = 0; i < part_count; ++i)
      if (part_in_varied[i] == 0u) part_weight[i] = varied / constant;
  return has_light && light.h > 0 && grade_light(light);
}
