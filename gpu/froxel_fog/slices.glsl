// View depths of slices: reference/froxel_fog/slices.h.
const int distribution_equal = 0, distribution_log = 1, distribution_power = 2, distribution_exponential = 3;
uniform int distribution;
uniform float parameter;  // c [1/m] of log, the exponent of power

// log(1 + x) and exp(x) - 1 for x >= 0, with the digits of small ones.
float log_of_more(float x) {
  if (x > 0.5) return log(1 + x);
  float z = x / (2 + x), w = z * z;
  return 2 * z * (1 + w * (1.0 / 3 + w * (1.0 / 5 + w * (1.0 / 7 + w * (1.0 / 9 + w / 11)))));
}
float growth_of(float x) {
  if (x > 0.5) return exp(x) - 1;
  return x * (1 + x / 2 * (1 + x / 3 * (1 + x / 4 * (1 + x / 5 * (1 + x / 6 * (1 + x / 7 * (1 + x / 8)))))));
}
float raised(float x, float power) { return x > 0 ? (power == 2 ? x * x : power == 0.5 ? sqrt(x) : pow(x, power)) : 0; }

// [m]
float decode_depth(float u, vec2 range) {
  float span = range.y - range.x, z = range.x + span * u;
  if (distribution == distribution_log) z = range.x + growth_of(u * log_of_more(parameter * span)) / parameter;
  if (distribution == distribution_power) z = range.x + span * raised(u, parameter);
  if (distribution == distribution_exponential) z = range.x * exp(u * log(range.y / range.x));
  return clamp(z, range.x, range.y);
}
// In [0, 1].
float encode_depth(float z, vec2 range) {
  if (!(z > range.x)) return 0;
  if (!(z < range.y)) return 1;
  float span = range.y - range.x, share = (z - range.x) / span, u = share;
  if (distribution == distribution_log) u = log_of_more(parameter * (z - range.x)) / log_of_more(parameter * span);
  if (distribution == distribution_power) u = raised(share, 1 / parameter);
  if (distribution == distribution_exponential) u = log(z / range.x) / log(range.y / range.x);
  return clamp(u, 0.0, 1.0);
}
