// Airlight of the lit parts of a ray, by counting (SHADOWS 1) or as a signed sum (2), or of all of it (0):
// methods/shadow_planes/lit_parts.cpp. `state.unfinished` on return: there are more crossings. `m_end`: m where it ends.
vec3 airlight_of(Line line, double end, int primitive, int m_origin, inout State state, out int m_end, out Work work) {
  work = Work(0, 0, 0);
  m_end = m_origin;
  bool more = false, met = meets_air(line, end);
  // A surface asks for m where the ray ends.
  for (int gathering = 0; met || primitive >= 0; ++gathering) {
#if CROSSINGS
    more = gather(line, end, state.last_key, state.last_origin);
    m_end = m_origin + crossing_sum;
    work.crossings = crossing_count;
#endif
#if AIRLIGHT && (SHADOWS == 0 || !CROSSINGS)
    if (met) state.sum.rgb = intensity * lit_airlight(line, 0, end);
    work.parts = int(met);
    more = false;
#elif AIRLIGHT
    for (int e = 0;; ++e) {
      bool last = e >= hit_count;
      if (last && more) break;
      double to = last ? end : hit_key[slot_of(min(e, MOST_HITS - 1))];
      float share = SHADOWS == 1 ? (state.m == 0 ? 1 : 0) : 1 - 0.5 * float(state.m);
      if (met && to > state.from && share != 0) {
        state.sum.rgb += share * intensity * lit_airlight(line, state.from, to);
        ++work.parts;
      }
      if (last) break;
      state.m += change_of(hit_name[slot_of(e)]);
      state.from = to;
    }
#else
    more = false;
#endif
    work.gatherings += int(more);
    if (!more || gathering + 1 >= most_gatherings) break;
  }
  state.unfinished = int(more);
  return state.sum.rgb;
}
