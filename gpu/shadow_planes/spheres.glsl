// Occlusion of a light by a ball; methods/shadow_planes/surface_count.h. In double precision.

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
