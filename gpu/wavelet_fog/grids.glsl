// Grids of numbers over the map, in one buffer: coefficients of the map and its coarser grids, details, what is known of blocks.
// VALUES_ACCESS: readonly, or nothing; not defined: without the numbers.
struct Grid {
  int lo_u, lo_v, size_u, size_v;  // indices [lo, lo + size)
  int offset, stride;              // of index lo; between rows
};
layout(std430, binding = AT_GRIDS) readonly buffer Grids { Grid grids[]; };
#ifdef VALUES_ACCESS
layout(std430, binding = AT_VALUES) VALUES_ACCESS buffer Values { float values[]; };
#endif

int place_of(Grid g, ivec2 at) { return g.offset + (at.y - g.lo_v) * g.stride + at.x - g.lo_u; }
ivec2 lo_of(Grid g) { return ivec2(g.lo_u, g.lo_v); }
ivec2 size_of(Grid g) { return ivec2(g.size_u, g.size_v); }
bool holds(Grid g, ivec2 at) {
  ivec2 i = at - lo_of(g);
  return i.x >= 0 && i.y >= 0 && i.x < g.size_u && i.y < g.size_v;
}
#ifdef VALUES_ACCESS
// 0 outside.
float value_in(Grid g, ivec2 at) { return holds(g, at) ? values[place_of(g, at)] : 0; }
#endif
