// Depth of the Gaussians around a point, averaged over all directions: Zhou et al. 2007, Eq. 26. After fog.glsl.

// Dawson's integral D(u) / u for w = u^2, by DawsonFit (methods/fogshop/surface_psf.h).
const float dawson_numerator[10] = float[10](DAWSON_NUMERATOR), dawson_denominator[10] = float[10](DAWSON_DENOMINATOR);
float dawson_over_u(float w) {
  float v = min(w, DAWSON_END), over = 0.5 / max(w, DAWSON_END), p = dawson_numerator[9], q = dawson_denominator[9];
#define ADD(k)                  \
  p = p * v + dawson_numerator[k]; \
  q = q * v + dawson_denominator[k];
  ADD(8) ADD(7) ADD(6) ADD(5) ADD(4) ADD(3) ADD(2) ADD(1) ADD(0)
#undef ADD
  return w < DAWSON_END ? p / (q * v + 1) : over * (1 + over * (1 + 3 * over));
}

float average_depth(Gaussian g, vec3 point) {
  vec3 u = g.a * (g.center - point);
  return g.half_depth * dawson_over_u(dot(u, u));
}
float average_depth(vec3 point) {
  float sum = 0;
  for (int i = 0; i < gaussian_count; ++i) sum += average_depth(gaussians[i], point);
  return sum;
}
