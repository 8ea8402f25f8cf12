// The meshes of a scene, one after the other.
layout(std430, binding = 10) readonly buffer Vertices { double vertex_coordinate[]; };  // [m]
layout(std430, binding = 11) readonly buffer Triangles { ivec4 triangles[]; };          // three vertices, surface

dvec3 mesh_vertex(int i) {
  return dvec3(vertex_coordinate[3 * i], vertex_coordinate[3 * i + 1], vertex_coordinate[3 * i + 2]);
}

// Where a ray meets the plane of a triangle [m], within the triangle's reach: coverage is decided to a fraction of a pixel
// only, and on a triangle seen from its edge the plane may be met far outside. 0 if the triangle has no area. `normal` has
// either side.
double meet_triangle_plane(ivec4 corners, dvec3 origin, dvec3 direction, dvec3 forward, out dvec3 normal) {
  dvec3 a = mesh_vertex(corners.x), ab = mesh_vertex(corners.y) - a, ac = mesh_vertex(corners.z) - a;
  normal = cross(ab, ac);
  double scale = length(normal);
  if (!(scale > 0)) return 0;
  normal /= scale;
  a -= origin;
  double za = dot(a, forward), zb = za + dot(ab, forward), zc = za + dot(ac, forward);
  double nearest = max(min(za, min(zb, zc)), 0.0LF), farthest = max(za, max(zb, zc));
  double cosine = dot(direction, forward), speed = dot(normal, direction);
  double t = speed != 0 ? dot(normal, a) / speed : nearest / cosine;
  return clamp(t, nearest / cosine, farthest / cosine);
}
