// J_ss(w) = mean + direction.w at a centre: linear_source of diffusion_system.h.
double mean_of(int c, int i) { return 0.28209479177387814LF * single[c * BANDS * gaussian_count + i]; }
dvec3 direction_of(int c, int i) {
#if SH_ORDER > 1
  int at = (c * BANDS + 1) * gaussian_count + i;
  return 0.48860251190291992LF * dvec3(-single[at + 2 * gaussian_count], -single[at], single[at + gaussian_count]);
#else
  return dvec3(0);
#endif
}
