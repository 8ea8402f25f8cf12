// Airlight of the lit parts of a ray, by counting (SHADOWS 1) or as a signed sum (2), or of all of it (0):
// methods/shadow_planes/shadow_planes.cpp.
vec3 airlight_of(Ray ray, double end, int primitive, int tile, int m, out int m_end, out int parts, out int gatherings) {
  vec3 sum = vec3(0);
  parts = 0;
  gatherings = 1;
  m_end = m;
#if CROSSINGS
  last_key = -1e300LF;
  last_origin = -1;
  bool more = gather(ray, end, tile);
  m_end = m + crossing_sum;
#endif
#if AIRLIGHT && (SHADOWS == 0 || !CROSSINGS)
  sum = intensity * lit_airlight(ray, 0, end);
  parts = 1;
#elif AIRLIGHT
  double from = 0;
  for (int e = 0;; ++e) {
    if (e >= hit_count && more) {
      more = gather(ray, end, tile);
      ++gatherings;
      e = 0;
    }
    bool last = e >= hit_count;
    double to = last ? end : hit_key[min(e, most_hits - 1)];
    float share = SHADOWS == 1 ? (m == 0 ? 1 : 0) : 1 - 0.5 * float(m);
    if (to > from && share != 0) {
      sum += share * intensity * lit_airlight(ray, from, to);
      ++parts;
    }
    if (last) break;
    m += hit_change[e];
    from = to;
  }
#endif
  return sum;
}
