// Depth of the Gaussians around a point, averaged over all directions: Zhou et al. 2007, Eq. 26. After fog.glsl.

// Dawson's integral D(u) / u for w = u^2: a rational minimax fit up to u = 33, relative error 1.1e-8, all of whose terms are
// positive, and the series of w -> infinity beyond.
float dawson_over_u(float w) {
  float v = min(w, 1e3), over = 0.5 / max(w, 1e3);
  float p = 1.0000000104 + v * (0.079803895585 + v * (0.042635073672 + v * (0.0059185214178 + v * (0.00084339777875 +
            v * (8.366913958e-05 + v * (9.758087878e-06 + v * (1.8779453754e-07 + v * 7.2662859375e-08)))))));
  float q = 1 + v * (0.74647114264 + v * (0.27361055358 + v * (0.065476104432 + v * (0.011437623136 + v * (0.0015778737707 +
            v * (0.00015742161784 + v * (1.9254103607e-05 + v * (3.0293155113e-07 + v * 1.4532571383e-07))))))));
  return w < 1e3 ? p / q : over * (1 + over * (1 + 3 * over));
}

float average_depth(vec3 point) {
  float sum = 0;
  for (int i = 0; i < gaussian_count; ++i) {
    Gaussian g = gaussians[i];
    vec3 u = g.a * (g.center - point);
    sum += g.half_depth * dawson_over_u(dot(u, u));
  }
  return sum;
}
