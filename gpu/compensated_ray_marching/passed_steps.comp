// A step of passed.glsl by itself: what oracle vectors are compared with.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/passed.glsl"
layout(std430, binding = AT_PASSED) readonly buffer Given { double given[]; };
layout(std430, binding = AT_RESULT) writeonly buffer Result { double result[]; };
uniform int step_;  // Step of experiments/verify/harmonics_on_device.h
dvec3 given_place(int at) { return dvec3(given[at], given[at + 1], given[at + 2]); }

void main() {
  int from = LOBE;
  if (step_ == 0) {  // the product of two vectors
    if (lane < BANDS) vectors[GIVEN + lane] = given[lane];
    if (lane < BANDS) vectors[SMALL + lane] = given[BANDS + lane];
    barrier();
    multiply(GIVEN, SMALL, 1);
    from = GIVEN;
  } else if (step_ == 1) {  // a zonal function about an axis, which stands behind it
    for (int l = 0; l < SH_ORDER; ++l) band[l] = bits_of(given[l]);
    clear_rows();
    if (lane == 0) add_about(given_place(SH_ORDER), 1);
    sum_rows(LOBE);
  } else if (step_ == 2) {  // what passes to a point, of an extinction; minus the depth of an extinction of 1 after it
    find_hidden(given_place(0), -1);
    find_depth(given_place(0));
    pass(given[3]);
    if (lane < BANDS) result[BANDS + lane] = vectors[DEPTH + lane];
    from = RESULT;
  } else {  // the angle of a sine by the table of shadows, or how many terms all products have
    int count = 0;
    for (int b = 0; b < BANDS; ++b) count += terms[b].j - terms[b].i;
    if (lane == 0) result[0] = step_ == 3 ? place_of_shadow(given[0]) / SHADOWS_PER_ANGLE : double(count);
    return;
  }
  if (lane < BANDS) result[lane] = vectors[from + lane];
}
