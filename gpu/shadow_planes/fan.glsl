// Silhouette edges by their angle around a line through the light: methods/shadow_planes/edge_fan.cpp. In double precision.
uniform dvec3 fan_x, fan_y;  // across the line, unit

const int fan_levels = 8;  // of 4, 16, ... 65536 sectors
const double fan_margin = 1e-8LF, least_across = 1e-6LF;

int sectors_of(int level) { return 4 << (2 * level); }
int first_sector(int level) { return (sectors_of(level) - 4) / 3; }

// Grows with the angle, from 0 to 4, without being it.
double turn_of(dvec2 across) {
  double sum = abs(across.x) + abs(across.y), p = sum > 0 ? across.x / sum : 0.0LF;
  return across.y >= 0 ? 1 - p : 3 + p;
}
bool is_across(dvec2 across, dvec3 v) { return dot(across, across) > least_across * least_across * dot(v, v); }

// Level, first and last of the sectors in which an edge is kept; the last may be past the end.
ivec3 sector_range(dvec3 a, dvec3 b) {
  dvec2 a2 = dvec2(dot(a, fan_x), dot(a, fan_y)), b2 = dvec2(dot(b, fan_x), dot(b, fan_y));
  double cross_ = a2.x * b2.y - a2.y * b2.x, dot_ = dot(a2, b2);
  bool through = dot_ < 0 && abs(cross_) <= 1e-9LF * sqrt(dot(a2, a2) * dot(b2, b2));
  if (through || !is_across(a2, a) || !is_across(b2, b)) return ivec3(0, 0, sectors_of(0) - 1);
  // The short way round.
  double from = turn_of(a2), to = turn_of(b2);
  if (abs(to - from) <= 2 ? to < from : to > from) {
    double other = from;
    from = to;
    to = other;
  }
  if (to < from) to += 4;
  from -= fan_margin;
  to += fan_margin;
  ivec3 range;
  for (int level = fan_levels - 1; level >= 0; --level) {
    double scale = 0.25LF * sectors_of(level);
    range = ivec3(level, int(floor(from * scale)), int(floor(to * scale)));
    if (range.z - range.y <= 2) return range;
  }
  return ivec3(0, range.y, min(range.z, range.y + sectors_of(0) - 1));
}
