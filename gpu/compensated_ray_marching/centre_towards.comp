// Source radiance of the centres towards the camera, of either sign: CentreSources::towards.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "compensated_ray_marching/centre_tables.glsl"
layout(std430, binding = AT_CENTRES) readonly buffer Centres { double gaussians[]; };   // center, width [m], amplitude
layout(std430, binding = AT_SINGLE_BANDS) readonly buffer Single { double single[]; };  // [channel][band][centre]
layout(std430, binding = AT_AGAIN) readonly buffer Again { double again[]; };           // [channel][4][centre]
layout(std430, binding = AT_CENTRE_SOURCES) writeonly buffer CentreSources { vec4 sources[]; };
uniform int gaussian_count, perspective_;
uniform dvec3 eye, forward;  // [m], unit

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= gaussian_count) return;
  dvec3 way = eye - dvec3(gaussians[5 * i], gaussians[5 * i + 1], gaussians[5 * i + 2]);
  double far = sqrt(dot(way, way));
  way = perspective_ == 0 || !(far > 0) ? -forward : way / far;
  double sum[3];
  for (int c = 0; c < 3; ++c) sum[c] = 0;
  for (Harmonic y = first_harmonic(); y.m < sh_order; next_harmonic(y, way)) {
    int above = y.l * (y.l + 1) + y.m, below = above - 2 * y.m;
    for (int c = 0; c < 3; ++c) {
      double plus = single[(c * BANDS + above) * gaussian_count + i], minus = single[(c * BANDS + below) * gaussian_count + i];
      if (y.l < 2) {
        plus += again[(c * 4 + above) * gaussian_count + i];
        minus += again[(c * 4 + below) * gaussian_count + i];
      }
      sum[c] += y.q * (plus * y.turn.x + (y.m > 0 ? minus * y.turn.y : 0));
    }
  }
  sources[i] = vec4(float(sum[0]), float(sum[1]), float(sum[2]), 0);
}
