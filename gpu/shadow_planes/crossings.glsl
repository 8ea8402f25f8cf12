// Where the number of surfaces between a ray and the light changes: methods/shadow_planes/shadow_volumes.cpp, in double
// precision. Crossings are met in the order of their keys, MOST_HITS at a time: when there are more, the next of them are
// gathered again, so none is lost. Needs raster/primitive.glsl, raster/view.glsl, edge.glsl, light_state.glsl and ray.glsl.
#include "shadow_planes/facing.glsl"
#include "shadow_planes/fan.glsl"
#include "shadow_planes/spheres.glsl"
layout(std430, binding = AT_EDGES) readonly buffer Edges { Edge edges[]; };
layout(std430, binding = AT_LISTS) readonly buffer Lists {
  ivec2 sector_list[FAN_SECTORS];  // begin and end in lists
  int lists[];
};
uniform int solid_count, edge_split;

// Crossings of every invocation, slot by slot, in shared memory because registers would spill. `hit_order` has the slots in the order
// of keys, 4 bits each, so that sorting moves nothing in memory. A crossing's name tells all but its key: twice the edge, + 1 where the
// ray leaves a shadow; for spheres ~(twice the crossing's number, + 1 where the ray enters).
shared double hit_key[MOST_HITS * LOCAL_SIZE_X * LOCAL_SIZE_Y];
shared int hit_name[MOST_HITS * LOCAL_SIZE_X * LOCAL_SIZE_Y];
uvec2 hit_order;
int place_in_memory(int slot) { return slot * LOCAL_SIZE_X * LOCAL_SIZE_Y + int(gl_LocalInvocationIndex); }
int nth_slot(int n) { return int((n < 8 ? hit_order.x : hit_order.y) >> 4 * (n & 7) & 15u); }
int slot_of(int hit) { return place_in_memory(nth_slot(hit)); }

// Inserts a slot as the n-th. Later slots move by one; the last of MOST_HITS is dropped.
void insert_slot(int n, int slot) {
  uint word = n < 8 ? hit_order.x : hit_order.y, before = (1u << 4 * (n & 7)) - 1u;
  word = (word & before) | uint(slot) << 4 * (n & 7) | (word & ~before) << 4;
  hit_order = n < 8 ? uvec2(word, hit_order.y << 4 | hit_order.x >> 28) : uvec2(hit_order.x, word);
}

#if STENCIL
double stencil_end;  // [m]: changes before it sum up to
int stencil_sum;
#endif
int hit_count;
int crossing_sum;  // changes of all crossings, those of other gatherings included
int crossing_count;
double last_key;   // what was gathered before ends here
int last_origin;

// Decides between equal keys.
int origin_of(int name) { return name >= 0 ? edges[name >> 1].origin : 0x40000000 + (~name >> 1); }
int change_of(int name) {
  if (name < 0) return (~name & 1) != 0 ? 2 : -2;
  return (name & 1) != 0 ? -edges[name >> 1].multiplicity : edges[name >> 1].multiplicity;
}

// Keeps the first MOST_HITS of those after the last gathering.
void keep_crossing(double key, int name, int change, double place) {
  crossing_sum += change;
#if STENCIL
  if (place < stencil_end) stencil_sum += change;
#endif
  ++crossing_count;
#if SHADOWS
  if (key < last_key || (key == last_key && origin_of(name) <= last_origin)) return;
  int kept = min(hit_count, MOST_HITS), to = kept;
  ++hit_count;
  for (; to > 0; --to) {
    int before = slot_of(to - 1);
    double other = hit_key[before];
    if (other < key || (other == key && origin_of(hit_name[before]) <= origin_of(name))) break;
  }
  if (to == MOST_HITS) return;
  int slot = kept < MOST_HITS ? kept : nth_slot(MOST_HITS - 1);  // the last makes room
  insert_slot(to, slot);
  hit_key[place_in_memory(slot)] = key;
  hit_name[place_in_memory(slot)] = name;
#endif
}

// Where the plane of edge e is crossed: at `place` on the ray [m], `share` of the edge, `times` as far from the light; `leaves`: out of
// the shadow. False: nowhere between light and ray. `side`: normal to the plane through light and ray.
bool cross_plane(Ray ray, int e, dvec3 side, out double place, out double share, out double times, out bool leaves) {
  dvec3 a = dvec3(edges[e].a[0], edges[e].a[1], edges[e].a[2]), b = dvec3(edges[e].b[0], edges[e].b[1], edges[e].b[2]);
  double sa = precise_dot(side, a), sb = precise_dot(side, b);  // edges that share a vertex agree about it
  bool crossed = (sa >= 0) != (sb >= 0);
  leaves = sa >= 0;  // the sign of dot(cross(a, b), ray.direction), where p is towards the ray
  place = share = times = 0;
  if (crossed) {
    share = sa / (sa - sb);
    dvec3 p = a + (b - a) * share;
    double towards = dot(p, ray.n);
    crossed = towards > 0 && towards <= ray.h;
    times = ray.h / towards;
    place = ray.T + ray.h * dot(p, ray.direction) / towards;
  }
  return crossed;
}

// The triangle's planes are as exact as light and ends are apart; where these are not, no edge is told to be beyond.
Wedge wedge_of(Ray ray, double end, dvec3 side) {
  dvec3 before = ray.T * ray.n + ray.h * ray.direction, beyond = before - end * ray.n;
  double apart = length(beyond);
  beyond = apart > 1e-6LF * length(before) ? beyond / apart : dvec3(0);
  return Wedge(vec3(normalize(side)), vec3(-normalize(before)), vec3(beyond), vec3(ray.n), float(ray.h));
}

void cross_edge(Ray ray, double end, int e, dvec3 side, Wedge wedge) {
  if (surely_beside(edges[e].near_a.xyz, edges[e].near_b, edges[e].near_a.w, wedge)) return;
  double place, share, times;
  bool leaves;
  if (!cross_plane(ray, e, side, place, share, times, leaves) || !(place > 0) || !(place < end)) return;
  double key = place;
#if STENCIL
  dvec3 a = dvec3(edges[e].a[0], edges[e].a[1], edges[e].a[2]), b = dvec3(edges[e].b[0], edges[e].b[1], edges[e].b[2]);
  double pieces = double(edge_split), middle = (min(floor(share * pieces), pieces - 1) + 0.5LF) / pieces;
  key = dot(normalize(a + (b - a) * middle), -normalize(ray.to_light));
#endif
  keep_crossing(key, 2 * e + int(leaves), leaves ? -edges[e].multiplicity : edges[e].multiplicity, place);
}

// Crossings of the edges in the ray's sectors of the fan: only these edges may be crossed.
void cross_edges(Ray ray, double end) {
  if (!(ray.h > 1e-12LF * length(ray.to_light))) return;
  dvec3 side = cross(ray.direction, ray.to_light);
  Wedge wedge = wedge_of(ray, end, side);
  dvec3 v = view_perspective != 0 ? ray.direction : -ray.to_light;
  dvec2 across = across_line(v);
  bool all = !is_across(across, v);
  double turn = turn_of(across);
  for (int level = 0; level < (all ? 1 : FAN_LEVELS); ++level) {
    ivec2 list = ivec2(0, edge_count);
    if (!all) list = sector_list[first_sector(level) + min(int(turn * 0.25LF * sectors_of(level)), sectors_of(level) - 1)];
    for (int i = list.x; i < list.y; ++i) cross_edge(ray, end, all ? i : lists[i], side, wedge);
  }
}

#if SPHERES
// Places where the shadow of a sphere may begin or end: on its tangent cone, or on itself.
struct SphereShadow {
  dvec3 center;  // from the light [m]
  double radius;
  dvec2 cone, ball;
};
SphereShadow shadow_of(Solid s, Ray ray) {
  dvec3 center = dvec3(s.point[0], s.point[1], s.point[2]), c = center - light, from_center = ray.origin - center;
  return SphereShadow(c, s.radius, cross_tangent_cone(c, s.radius, -ray.to_light, ray.direction),
                      roots_of(1, dot(from_center, ray.direction), dot(from_center, from_center) - s.radius * s.radius));
}
// The least of them beyond `place`; 1e37: none before `end`.
double next_place(SphereShadow s, double place, double end) {
  double next = 1e37LF;
  for (int j = 0; j < 4; ++j) {
    double other = j < 2 ? s.cone[j] : s.ball[j - 2];
    if (other > place && other < end) next = min(next, other);
  }
  return next;
}

// The shadow of a ball is convex: one stretch of the ray, which ends on the tangent cone or on the ball.
void cross_spheres(Ray ray, double end) {
  end *= 1 - 1e-10LF;  // where the ray ends on a ball it does not enter it, whatever rounding says
  for (int i = 0; i < solid_count; ++i) {
    if (solids[i].kind != 1) continue;
    SphereShadow s = shadow_of(solids[i], ray);
    dvec3 y = -ray.to_light;
    // In turn the least place beyond the last one, with 0 the first.
    double place = 0;
    bool before = hides(s.center, s.radius, y);
    for (int k = 0; k < 5; ++k) {
      double next = next_place(s, place, end);
      bool last = next >= 1e37LF;
      double beyond = last ? min(end, 2 * place + 1 + length(s.center) + length(y)) : next;
      bool hidden = hides(s.center, s.radius, y + 0.5LF * (place + beyond) * ray.direction);
      if (hidden != before) {
        double key = place;
#if STENCIL
        key = dot(normalize(y + place * ray.direction), normalize(y));
#endif
        keep_crossing(key, ~(2 * (5 * i + k) + int(hidden)), hidden ? 2 : -2, place);
      }
      before = hidden;
      if (last) break;
      place = next;
    }
  }
}
#endif

#if STENCIL
// Where crossing `name` lies on the ray [m]; of an edge also where on its plane.
double place_of(Ray ray, double end, int name, out double share, out double times) {
  double place = 0;
  share = times = 0;
  bool leaves;
  if (name >= 0) cross_plane(ray, name >> 1, cross(ray.direction, ray.to_light), place, share, times, leaves);
#if SPHERES
  if (name < 0) {
    int number = ~name >> 1;
    SphereShadow s = shadow_of(solids[number / 5], ray);
    for (int k = number % 5; k > 0; --k) place = next_place(s, place, end * (1 - 1e-10LF));
  }
#endif
  return place;
}
#endif

// Gathers the next crossings within (0, end) in order, after `key` and `origin`, which then are those of the last; true if
// more are left.
bool gather(Line line, double end, inout double key, inout int origin) {
  hit_count = crossing_sum = crossing_count = 0;
#if STENCIL
  stencil_sum = 0;
#endif
  last_key = key;
  last_origin = origin;
  Ray ray = ray_in_general_position(line);
  cross_edges(ray, end);
#if SPHERES
  cross_spheres(ray, end);
#endif
  if (hit_count <= MOST_HITS) return false;
  hit_count = MOST_HITS;
  key = hit_key[slot_of(MOST_HITS - 1)];
  origin = origin_of(hit_name[slot_of(MOST_HITS - 1)]);
  return true;
}
