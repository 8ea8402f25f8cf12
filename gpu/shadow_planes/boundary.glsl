// The boundary of a convex medium as a mesh: methods/shadow_planes/media_boundary.cpp, vertices computed where they are needed.
uniform int boundary_cells;

// Where it lies: a box or a sphere.
void boundary_frame(out dvec3 centre, out dvec3 half_size) {
  dvec3 lo = region_lo(air_medium), hi = region_hi(air_medium);
  bool sphere = media[air_medium].region == region_sphere;
  centre = sphere ? lo : 0.5LF * (lo + hi);
  half_size = sphere ? dvec3(hi.x) : 0.5LF * (hi - lo);
}

// From the middle, i and j in [0, cells].
dvec3 boundary_vertex(dvec3 half_size, int face, int i, int j) {
  int axis = face / 2;
  // Along the face's axis, the next and the last.
  dvec3 p = dvec3(face % 2 == 0 ? 1 : -1, 2.0LF * i / boundary_cells - 1, 2.0LF * j / boundary_cells - 1);
  dvec3 u = axis == 0 ? p : axis == 1 ? p.zxy : p.yzx;
  return half_size * (media[air_medium].region == region_sphere ? normalize(u) : u);
}

// The triangle in front of a point, seen from the middle: its corners, their numbers, the point's weights.
void locate_on_boundary(dvec3 point, out dvec3 corners[3], out ivec3 numbers, out vec3 weight) {
  dvec3 centre, half_size;
  boundary_frame(centre, half_size);
  dvec3 d = point - centre, u = d / half_size, size = abs(u);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  int face = 2 * axis + (u[axis] < 0 ? 1 : 0), side = boundary_cells + 1;
  double along_i = 0.5LF * boundary_cells * (u[(axis + 1) % 3] / size[axis] + 1);
  double along_j = 0.5LF * boundary_cells * (u[(axis + 2) % 3] / size[axis] + 1);
  int i = clamp(int(along_i), 0, boundary_cells - 1), j = clamp(int(along_j), 0, boundary_cells - 1);
  ivec2 second = ivec2(1, 1), third = ivec2(0, 1);  // from the first corner
  if (!(along_j - j > along_i - i)) second = ivec2(1, 0), third = ivec2(1, 1);
  corners[0] = boundary_vertex(half_size, face, i, j);
  corners[1] = boundary_vertex(half_size, face, i + second.x, j + second.y);
  corners[2] = boundary_vertex(half_size, face, i + third.x, j + third.y);
  int first = face * side * side + j * side + i;
  numbers = ivec3(first, first + second.y * side + second.x, first + third.y * side + third.x);
  dvec3 w = dvec3(dot(d, cross(corners[1], corners[2])), dot(d, cross(corners[2], corners[0])),
                  dot(d, cross(corners[0], corners[1])));
  weight = vec3(w / (w.x + w.y + w.z));
  for (int k = 0; k < 3; ++k) corners[k] += centre;
}
