// Airlight of the lit parts of a ray, by counting (SHADOWS 1) or as a signed sum (2), or of all of it (0):
// methods/shadow_planes/lit_parts.cpp. `state.unfinished` on return: there are more crossings. `m_end`: m where it ends.
vec3 airlight_of(Ray ray, double end, int primitive, int m_origin, inout State state, out int m_end, out int parts) {
  parts = 0;
  m_end = m_origin;
  bool more = false;
#if CROSSINGS
  more = gather(ray, end, state.last_key, state.last_origin);
  m_end = m_origin + crossing_sum;
#endif
#if AIRLIGHT && (SHADOWS == 0 || !CROSSINGS)
  state.sum.rgb = intensity * lit_airlight(ray, 0, end);
  parts = 1;
  more = false;
#elif AIRLIGHT
  int m = state.m;
  double from = state.from;
  for (int e = 0;; ++e) {
    bool last = e >= hit_count;
    if (last && more) break;
    double to = last ? end : hit_key[min(e, most_hits - 1)];
    float share = SHADOWS == 1 ? (m == 0 ? 1 : 0) : 1 - 0.5 * float(m);
    if (to > from && share != 0) {
      state.sum.rgb += share * intensity * lit_airlight(ray, from, to);
      ++parts;
    }
    if (last) break;
    m += hit_change[e];
    from = to;
  }
  state.m = m;
  state.from = from;
#else
  more = false;
#endif
  state.unfinished = int(more);
  return state.sum.rgb;
}
