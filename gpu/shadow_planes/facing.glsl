// The side of a triangle that a light sees: methods/shadow_planes/silhouette.h. `precise`: every invocation that asks for a triangle
// must get an equal answer, and so must the count of surfaces.

dvec3 precise_cross(dvec3 a, dvec3 b) {
  precise dvec3 result = a.yzx * b.zxy - a.zxy * b.yzx;
  return result;
}
double precise_dot(dvec3 a, dvec3 b) {
  precise double result = a.x * b.x + a.y * b.y + a.z * b.z;
  return result;
}

// Corners from the light [m].
bool faces_light(dvec3 a, dvec3 b, dvec3 c) {
  dvec3 normal = precise_cross(b - a, c - a);
  precise double slack = 4e-15LF * sqrt(precise_dot(normal, normal) * (precise_dot(a, a) + precise_dot(b, b) + precise_dot(c, c)));
  return precise_dot(normal, a) <= slack;
}
