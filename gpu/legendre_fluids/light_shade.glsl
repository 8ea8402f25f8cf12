// Where surfaces stand between a light and a ray: the ray is lit and dark by turns, and its next edge is known before it goes on.
struct Shade {
  double edge;       // where visibility changes next [m]; `nowhere`: it does not
  double low, high;  // between these an edge is looked for [m]
  int next_ray;      // number of the next shadow ray
  int flags;
};
const int shade_lit = 1, shade_waits = 2, shade_searches = 4, shade_broken = 8;  // lit up to the edge; the edge is not known yet
layout(std430, binding = AT_SHADES) buffer Shades { Shade shades[]; };

// Ends a stretch at the next edge. False where that lies before the stretch: the edge after it is needed first.
bool cut_by_shade(int place, double last, inout double next) {
  double edge = shades[place].edge;
  next = min(next, edge);
  return edge > last;
}
