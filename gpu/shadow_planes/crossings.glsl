// Where the number of surfaces between a ray and the light changes: methods/shadow_planes/shadow_volumes.cpp, in double
// precision. Crossings are met in the order of their keys, 32 at a time: when there are more, the next 32 are gathered
// again, so none is lost. Needs raster/primitive.glsl, raster/view.glsl, edge.glsl and ray.glsl.
#include "shadow_planes/fan.glsl"
layout(std430, binding = 0) readonly buffer Edges { Edge edges[]; };
layout(std430, binding = 3) readonly buffer Starts { int starts[]; };  // of the lists of sectors
layout(std430, binding = 4) readonly buffer Lists { int lists[]; };
uniform int solid_count, edge_count, edge_split;

const int most_hits = 32;
double hit_key[most_hits];
int hit_origin[most_hits];  // decides between equal keys
int hit_change[most_hits];
#if STENCIL
double hit_place[most_hits];
int hit_edge[most_hits];  // -1: a sphere's shadow
double hit_share[most_hits], hit_times[most_hits];  // where on the edge's plane (methods/shadow_planes/shadow_volumes.h)
double stencil_end;  // [m]: changes before it sum up to
int stencil_sum;
#endif
int hit_count;
int crossing_sum;  // changes of all crossings, those of other gatherings included
int crossing_count;
double last_key;   // what was gathered before ends here
int last_origin;

// Keeps the first most_hits of those after the last gathering.
void keep_crossing(double key, int origin, int change, double place, int edge, double share, double times) {
  crossing_sum += change;
#if STENCIL
  if (place < stencil_end) stencil_sum += change;
#endif
  ++crossing_count;
  if (key < last_key || (key == last_key && origin <= last_origin)) return;
  int to = min(hit_count, most_hits);
  ++hit_count;
  if (to == most_hits) {
    --to;
    if (key > hit_key[to] || (key == hit_key[to] && origin > hit_origin[to])) return;
  }
  while (to > 0 && (hit_key[to - 1] > key || (hit_key[to - 1] == key && hit_origin[to - 1] > origin))) {
    hit_key[to] = hit_key[to - 1];
    hit_origin[to] = hit_origin[to - 1];
    hit_change[to] = hit_change[to - 1];
#if STENCIL
    hit_place[to] = hit_place[to - 1];
    hit_edge[to] = hit_edge[to - 1];
    hit_share[to] = hit_share[to - 1];
    hit_times[to] = hit_times[to - 1];
#endif
    --to;
  }
  hit_key[to] = key;
  hit_origin[to] = origin;
  hit_change[to] = change;
#if STENCIL
  hit_place[to] = place;
  hit_edge[to] = edge;
  hit_share[to] = share;
  hit_times[to] = times;
#endif
}

// `side`: normal to the plane through light and ray, `normal` its direction; `to_origin`: from the light, unit.
void cross_edge(Ray ray, double end, int e, dvec3 side, vec3 normal, dvec3 to_origin) {
  if (surely_beside(edges[e].near_a, edges[e].near_b, normal)) return;
  dvec3 a = dvec3(edges[e].a[0], edges[e].a[1], edges[e].a[2]), b = dvec3(edges[e].b[0], edges[e].b[1], edges[e].b[2]);
  double sa = dot(side, a), sb = dot(side, b);
  if ((sa >= 0) == (sb >= 0)) return;
  double share = sa / (sa - sb);
  dvec3 p = a + (b - a) * share;
  double towards = dot(p, ray.n);
  if (!(towards > 0) || towards > ray.h) return;  // not between light and ray
  double x = ray.T + ray.h * dot(p, ray.direction) / towards;
  if (!(x > 0) || !(x < end)) return;
  int change = dot(cross(a, b), ray.direction) > 0 ? -edges[e].multiplicity : edges[e].multiplicity;
  double key = x;
#if STENCIL
  double pieces = double(edge_split), middle = (min(floor(share * pieces), pieces - 1) + 0.5LF) / pieces;
  key = dot(normalize(a + (b - a) * middle), to_origin);
#endif
  keep_crossing(key, edges[e].origin, change, x, e, share, ray.h / towards);
}

// Of the edges that the ray may cross: those of its sectors in the fan.
void cross_edges(Ray ray, double end) {
  if (!(ray.h > 1e-12LF * length(ray.to_light))) return;
  dvec3 side = cross(ray.direction, ray.to_light), to_origin = -normalize(ray.to_light);
  vec3 normal = vec3(normalize(side));
  dvec3 v = view_perspective != 0 ? ray.direction : -ray.to_light;
  dvec2 across = dvec2(dot(v, fan_x), dot(v, fan_y));
  if (is_across(across, v)) {
    double turn = turn_of(across);
    for (int level = 0; level < fan_levels; ++level) {
      int sector = first_sector(level) + min(int(turn * 0.25LF * sectors_of(level)), sectors_of(level) - 1);
      int last = starts[sector + 1];
      for (int i = starts[sector]; i < last; ++i) cross_edge(ray, end, lists[i], side, normal, to_origin);
    }
  } else {
    for (int e = 0; e < edge_count; ++e) cross_edge(ray, end, e, side, normal, to_origin);
  }
}

// Does the open segment from the light to y, relative to it, meet the sphere around c?
bool hides(dvec3 c, double radius, dvec3 y) {
  double length_ = length(y);
  if (!(length_ > 0)) return false;
  dvec3 u = y / length_;
  double along = dot(c, u), beside = length(c - along * u);
  if (beside >= radius) return false;
  double half_chord = sqrt((radius - beside) * (radius + beside)), near = along - half_chord, far = along + half_chord;
  double least = 1e-12LF * radius;  // a light on the sphere is outside
  return far > least && ((near > -least && near < length_) || far < length_);
}

// What a ball hides from the light is convex: one stretch of the ray, which ends on the tangent cone or on the ball.
void cross_spheres(Ray ray, double end) {
  end *= 1 - 1e-10LF;  // where the ray ends on a ball it does not enter it, whatever rounding says
  for (int i = 0; i < solid_count; ++i) {
    Solid s = solids[i];
    if (s.kind != 1) continue;
    dvec3 center = dvec3(s.point[0], s.point[1], s.point[2]), c = center - light, y = -ray.to_light, w = ray.direction;
    dvec3 from_center = ray.origin - center;
    dvec2 cone = cross_tangent_cone(c, s.radius, y, w);
    dvec2 ball = roots_of(1, dot(from_center, w), dot(from_center, from_center) - s.radius * s.radius);
    // In turn the least place beyond the last one, with 0 the first.
    double place = 0;
    bool before = hides(c, s.radius, y);
    for (int k = 0; k < 5; ++k) {
      double next = 1e37LF;
      for (int j = 0; j < 4; ++j) {
        double other = j < 2 ? cone[j] : ball[j - 2];
        if (other > place && other < end) next = min(next, other);
      }
      bool last = next >= 1e37LF;
      double beyond = last ? min(end, 2 * place + 1 + length(c) + length(y)) : next;
      bool hidden = hides(c, s.radius, y + 0.5LF * (place + beyond) * w);
      if (hidden != before) {
        double key = place;
#if STENCIL
        key = dot(normalize(y + place * w), normalize(y));
#endif
        keep_crossing(key, 0x40000000 + 5 * i + k, hidden ? 2 : -2, place, -1, 0, 0);
      }
      before = hidden;
      if (last) break;
      place = next;
    }
  }
}

// Gathers the next crossings within (0, end) in order, after `key` and `origin`, which then are those of the last; true if
// more are left.
bool gather(Ray ray, double end, inout double key, inout int origin) {
  hit_count = 0;
  crossing_sum = 0;
  crossing_count = 0;
#if STENCIL
  stencil_sum = 0;
#endif
  last_key = key;
  last_origin = origin;
  Ray from = ray_in_general_position(ray);
  cross_edges(from, end);
  cross_spheres(from, end);
  if (hit_count <= most_hits) return false;
  hit_count = most_hits;
  key = hit_key[most_hits - 1];
  origin = hit_origin[most_hits - 1];
  return true;
}
