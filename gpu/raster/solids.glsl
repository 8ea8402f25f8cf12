// Surfaces that are met exactly, without triangles, and the balls of lights.
struct Solid {
  double point[3];  // of the plane, or the centre [m]
  double radius;    // [m]
  double normal[3];
  int kind;  // 0: plane, 1: sphere, 2: ball
  int surface;
};
layout(std430, binding = 12) readonly buffer Solids { Solid solids[]; };

// First distance > 0 at which a ray meets it, 0 if none; scene/geometry/ray_primitive.cpp, scene/ray_end.cpp. `normal` has
// either side.
double meet_solid(Solid s, dvec3 origin, dvec3 direction, out dvec3 normal) {
  dvec3 offset = dvec3(s.point[0], s.point[1], s.point[2]) - origin;
  if (s.kind == 0) {
    normal = dvec3(s.normal[0], s.normal[1], s.normal[2]);
    double speed = dot(normal, direction);
    return speed == 0 ? 0.0LF : dot(normal, offset) / speed;
  }
  double along = dot(offset, direction), passing = length(offset - along * direction), r = s.radius;
  normal = direction;
  if (!(passing < r)) return 0;  // a tangent does not cross
  double half_chord = sqrt((r - passing) * (r + passing));
  // One of the two roots can cancel. Their product is the power of the origin, which gives the other root without cancellation.
  double distance_ = length(offset), power = (distance_ - r) * (distance_ + r);
  double far = along >= 0 ? along + half_chord : along - half_chord;
  double near = far != 0 ? power / far : 0.0LF;
  double first = min(near, far), t = first > 0 ? first : max(near, far);
  if (s.kind == 2 && !(first > 0)) return 0;  // from inside a ball nothing of it is seen
  normal = normalize(t * direction - offset);
  return t;
}
