// Transmittance of smoke and objects on the way to a point, in harmonics of lookup directions: SourceRadiance::passed of
// methods/compensated_ray_marching. A work group computes a point; Gaussians, spheres and coefficients are divided among its lanes.
#include "common/private_doubles.glsl"
#include "compensated_ray_marching/doubles.glsl"
#include "compensated_ray_marching/centre_tables.glsl"
#include "compensated_ray_marching/triple_product.glsl"
layout(std430, binding = AT_CENTRES) readonly buffer Centres { double gaussians[]; };  // center, width [m], amplitude
layout(std430, binding = AT_SPHERES) readonly buffer Spheres { double spheres[]; };    // center, radius [m], surface
uniform int gaussian_count, sphere_count;
#define lane int(gl_LocalInvocationIndex)
const int lanes = LOCAL_SIZE_X;
const double root_4_pi = 3.5449077018110318LF;
shared double rows[BANDS * lanes];  // of each coefficient, by lane
shared double vectors[6 * BANDS];
#define HIDDEN 0  // logarithm of what objects leave
#define DEPTH BANDS  // minus the depth for an extinction of 1
#define GIVEN (2 * BANDS)
#define RESULT (3 * BANDS)
#define SMALL (4 * BANDS)
#define LOBE (5 * BANDS)  // of surfaces
shared int within_sphere;

uvec2 band[SH_ORDER];  // bits of doubles: coefficients of a zonal function times sqrt(4 pi / (2l+1))

// Adds the zonal function `band` about a unit axis, times a factor, to the lane's row.
void add_about(dvec3 axis, double factor) {
  for (Harmonic y = first_harmonic(); y.m < sh_order; next_harmonic(y, axis)) {
    int at = (y.l * (y.l + 1) + y.m) * lanes + lane;
    double q = factor * from_bits(band[y.l]) * y.q;
    rows[at] += q * y.turn.x;
    if (y.m > 0) rows[at - 2 * y.m * lanes] += q * y.turn.y;
  }
}

void clear_rows() {
  for (int b = 0; b < BANDS; ++b) rows[b * lanes + lane] = 0;
}
void sum_rows(int to) {
  barrier();
  if (lane < BANDS) {
    double sum = 0;
    for (int k = 0; k < lanes; ++k) sum += rows[lane * lanes + k];
    vectors[to + lane] = sum;
  }
  barrier();
}

void find_depth(dvec3 x) {
  clear_rows();
  for (int i = lane; i < gaussian_count; i += lanes) {
    dvec3 offset = dvec3(gaussians[5 * i], gaussians[5 * i + 1], gaussians[5 * i + 2]) - x;
    double far = sqrt(dot(offset, offset)), width = gaussians[5 * i + 3], d = far / width;
    double place = d / (1 + d) * DEPTH_LAST, scale = 1 / (1 + d * d);
    for (int l = 0; l < SH_ORDER; ++l) band[l] = bits_of(scale * between(DEPTH_AT + l, SH_ORDER, DEPTH_LAST, place));
    add_about(far > 0 ? offset / far : dvec3(0, 0, 1), -width * gaussians[5 * i + 4]);
  }
  sum_rows(DEPTH);
}

// Where the table of shadows has the angle of which this is the sine: found among those of its samples.
double place_of_shadow(double sine) {
  int low = 0, high = SHADOW_LAST;
  while (high - low > 1) {
    int middle_ = (low + high) / 2;
    if (tables[SINES_AT + middle_] <= sine)
      low = middle_;
    else
      high = middle_;
  }
  // sin(angle - that of the sample), at most 1/160: three terms of the arc sine leave 1e-17.
  double more = sine * tables[COSINES_AT + low] - sqrt(max(1 - sine * sine, 0.0LF)) * tables[SINES_AT + low], two = more * more;
  return double(low) + more * (1 + two * (1 / 6.0LF + two * 0.075LF)) * SHADOWS_PER_ANGLE;
}

// Past all spheres but that of a surface (-1: past all): log_visibility of sphere_shadow.h.
void find_hidden(dvec3 x, int surface) {
  if (lane == 0) within_sphere = 0;
  clear_rows();
  barrier();
  for (int s = lane; s < sphere_count; s += lanes) {
    if (int(spheres[5 * s + 4]) == surface) continue;
    dvec3 offset = dvec3(spheres[5 * s], spheres[5 * s + 1], spheres[5 * s + 2]) - x;
    double far = sqrt(dot(offset, offset)), radius = spheres[5 * s + 3];
    if (far <= radius) within_sphere = 1;
    double sine = radius / far;
    if (far <= radius || sine < LEAST_SINE) continue;
    double place = place_of_shadow(sine);
    for (int l = 0; l < SH_ORDER; ++l) band[l] = bits_of(between(SHADOW_AT + l, SH_ORDER, SHADOW_LAST, place));
    add_about(offset / far, 1);
  }
  sum_rows(HIDDEN);
}

double product_at(int k, int a, int b) {
  double sum = 0;
  for (int t = terms[k].i; t < terms[k].j; ++t) sum += terms[t].value * vectors[a + terms[t].i] * vectors[b + terms[t].j];
  return sum;
}
// Replaces the first vector by the triple product of both, times the factor.
void multiply(int a, int b, double factor) {
  double product = lane < BANDS ? factor * product_at(lane, a, b) : 0;
  barrier();
  if (lane < BANDS) vectors[a + lane] = product;
  barrier();
}
double size_of(int v) {
  double sum = 0;
  // To a uniform: NVIDIA refuses the tables' constant indices that follow from a sum over no band.
  for (int b = 1; b < sh_order * sh_order; ++b) sum += vectors[v + b] * vectors[v + b];
  return sqrt(sum);
}

// LinearExponential of a vector into the result.
void linear_exponential(int f) {
  double place = min(size_of(f) / LINEAR_LONGEST, 1.0LF) * LINEAR_LAST, mean = vectors[f] / root_4_pi;
  double slope = exp_double(mean + between(LOG_B_AT, 1, LINEAR_LAST, place));
  double constant = root_4_pi * exp_double(mean + between(LOG_A_AT, 1, LINEAR_LAST, place));
  barrier();
  if (lane < BANDS) vectors[RESULT + lane] = lane == 0 ? constant : slope * vectors[f + lane];
  barrier();
}

// exp of what is given: harmonic_exponential.h. All lanes decide the same.
void exponential() {
#if EXPONENTIAL == EXPONENTIAL_LINEAR
  linear_exponential(GIVEN);
#else
  double ratio = size_of(GIVEN) / THRESHOLD, log_scale = vectors[GIVEN] / root_4_pi;
  int times = 0;
  if (ratio > 1) times = exponent_of(ratio) + (ratio > power_of_two(exponent_of(ratio)) ? 1 : 0);
  double shrink = power_of_two(-times);
  log_scale *= shrink;
  if (lane < BANDS) vectors[SMALL + lane] = lane == 0 ? 0 : shrink * vectors[GIVEN + lane];
  barrier();
#if EXPONENTIAL == EXPONENTIAL_SQUARED
  linear_exponential(SMALL);
#else
  if (lane < BANDS) vectors[RESULT + lane] = lane == 0 ? root_4_pi : 0;
  barrier();
  for (int degree = 3; degree > 0; --degree) {
    multiply(RESULT, SMALL, 1 / double(degree));
    if (lane == 0) vectors[RESULT] += root_4_pi;
    barrier();
  }
#endif
  bool nothing = false;
  for (int i = 0; i < times && !nothing; ++i) {
    multiply(RESULT, RESULT, 1);
    double largest = 0;
    for (int b = 0; b < BANDS; ++b) largest = max(largest, abs(vectors[RESULT + b]));
    nothing = !(largest > 1e-300LF);
    int taken = nothing ? 0 : exponent_of(largest);
    log_scale = 2 * log_scale + double(taken) * 0.69314718055994531LF;
    barrier();
    if (lane < BANDS) vectors[RESULT + lane] *= power_of_two(-taken);
    barrier();
  }
  double scale = nothing ? 0 : exp_double(log_scale);
  if (lane < BANDS) vectors[RESULT + lane] *= scale;
  barrier();
#endif
}

// Leaves it in vectors[RESULT + b], of an air of that extinction [1/m], after find_depth and find_hidden.
void pass(double extinction) {
  if (lane < BANDS) vectors[GIVEN + lane] = extinction * vectors[DEPTH + lane] + vectors[HIDDEN + lane];
  barrier();
  exponential();
  if (within_sphere != 0 && lane < BANDS) vectors[RESULT + lane] = 0;
  barrier();
}
