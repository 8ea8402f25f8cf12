// Does a ray cross a triangle? scene/geometry/ray_primitive.cpp: what passes through a shared edge crosses one of two triangles,
// because both compute the edge as it stands, but for the sign. Rays in general position need no exact products.

// Twice the area of (0, p, q); `side` is its sign, on a tie that after moving the origin by (e, e^2), e -> 0.
double edge_function(dvec3 p, dvec3 q, out int side) {
  precise double left = p.x * q.y, right = p.y * q.x, value = left - right;
  side = value != 0 ? (value > 0 ? 1 : -1) : p.y != q.y ? (p.y > q.y ? 1 : -1) : int(q.x > p.x) - int(q.x < p.x);
  return value;
}

// A direction as an axis: `axis` z its largest component, handedness kept; shear, and 1 over that component.
struct Shear {
  ivec3 axis;
  dvec3 by;
};
Shear shear_of(dvec3 direction) {
  dvec3 size = abs(direction);
  int z = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  ivec3 axis = ivec3((z + 1) % 3, (z + 2) % 3, z);
  if (direction[z] < 0) axis.xy = axis.yx;
  return Shear(axis, dvec3(direction[axis.x], direction[axis.y], 1) / direction[z]);
}
dvec3 sheared(Shear shear, dvec3 v) {
  precise double x = v[shear.axis.x] - shear.by.x * v[shear.axis.z], y = v[shear.axis.y] - shear.by.y * v[shear.axis.z],
                 z = shear.by.z * v[shear.axis.z];
  return dvec3(x, y, z);
}

// Corners from the origin of the ray; 0: they are passed by. Else where they are met.
double meet_corners(Shear shear, dvec3 a, dvec3 b, dvec3 c) {
  dvec3 p = sheared(shear, a), q = sheared(shear, b), r = sheared(shear, c);
  int side_u, side_v, side_w;
  double u = edge_function(q, r, side_u), v = edge_function(r, p, side_v), w = edge_function(p, q, side_w), all = u + v + w;
  if (side_u == 0 || side_u != side_v || side_u != side_w || all == 0) return 0;
  return p.z + v / all * (q.z - p.z) + w / all * (r.z - p.z);
}
