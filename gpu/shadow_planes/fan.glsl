// Silhouette edges by their angle around a line through the light: methods/shadow_planes/edge_fan.cpp. In double precision, and
// `precise`: the program that counts an edge and the one that lists it must find the same sectors.
uniform dvec3 fan_x, fan_y;  // across the line, unit

int sectors_of(int level) { return 4 << (2 * level); }
int first_sector(int level) { return (sectors_of(level) - 4) / 3; }

dvec2 across_line(dvec3 v) {
  precise double x = v.x * fan_x.x + v.y * fan_x.y + v.z * fan_x.z, y = v.x * fan_y.x + v.y * fan_y.y + v.z * fan_y.z;
  return dvec2(x, y);
}
// Grows with the angle, from 0 to 4, without being it.
double turn_of(dvec2 across) {
  precise double sum = abs(across.x) + abs(across.y), p = sum > 0 ? across.x / sum : 0.0LF;
  precise double turn = across.y >= 0 ? 1 - p : 3 + p;
  return turn;
}
double square_of(dvec2 v) {
  precise double result = v.x * v.x + v.y * v.y;
  return result;
}
bool is_across(dvec2 across, dvec3 v) {
  precise double least = FAN_LEAST_ACROSS * FAN_LEAST_ACROSS * (v.x * v.x + v.y * v.y + v.z * v.z);
  return square_of(across) > least;
}

// Level, first and last of the sectors in which an edge is kept; the last may be past the end.
ivec3 sector_range(dvec3 a, dvec3 b) {
  dvec2 a2 = across_line(a), b2 = across_line(b);
  precise double cross_ = a2.x * b2.y - a2.y * b2.x, dot_ = a2.x * b2.x + a2.y * b2.y;
  bool through = dot_ < 0 && abs(cross_) <= 1e-9LF * sqrt(square_of(a2) * square_of(b2));
  if (through || !is_across(a2, a) || !is_across(b2, b)) return ivec3(0, 0, sectors_of(0) - 1);
  // The short way round.
  precise double from = turn_of(a2), to = turn_of(b2);
  if (abs(to - from) <= 2 ? to < from : to > from) {
    double other = from;
    from = to;
    to = other;
  }
  if (to < from) to += 4;
  from -= FAN_MARGIN;
  to += FAN_MARGIN;
  ivec3 range = ivec3(0);
  for (int level = FAN_LEVELS - 1; level >= 0; --level) {
    double scale = 0.25LF * sectors_of(level);
    range = ivec3(level, int(floor(from * scale)), int(floor(to * scale)));
    if (range.z - range.y <= 2) return range;
  }
  return ivec3(0, range.y, min(range.z, range.y + sectors_of(0) - 1));
}
