// Is anything between a point and a light?
#include "raster/primitive.glsl"
#include "raster/tree.glsl"

// Does it meet the ray in (0, end)? Moeller and Trumbore 1997 for triangles. The origin may lie on it if `own`.
bool primitive_blocks(int primitive, bool own, dvec3 origin, dvec3 direction, double end) {
  dvec3 normal;
  if (primitive >= triangle_count) {
    Solid s = solids[primitive - triangle_count];
    if (own) {  // a plane has no other crossing, a sphere that of the whole chord
      if (s.kind == 0) return false;
      dvec3 offset = dvec3(s.point[0], s.point[1], s.point[2]) - origin;
      double chord = 2 * dot(offset, direction);
      return chord > 1e-12LF * s.radius && chord < end;
    }
    double t = meet_solid(s, origin, direction, normal);
    return t > 0 && t < end;
  }
  if (own) return false;
  ivec4 corners = triangles[primitive];
  dvec3 a = mesh_vertex(corners.x), ab = mesh_vertex(corners.y) - a, ac = mesh_vertex(corners.z) - a;
  dvec3 p = cross(direction, ac), from = origin - a, q = cross(from, ab);
  double det = dot(ab, p);
  if (det == 0) return false;
  double inverse = 1 / det, u = dot(from, p) * inverse, v = dot(direction, q) * inverse, t = dot(ac, q) * inverse;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < end;
}

bool tree_blocks(int own, dvec3 point, dvec3 to_light, double end) {
  for (int i = 0; i < solid_count; ++i)
    if (triangle_count + i != own && primitive_blocks(triangle_count + i, false, point, to_light, end)) return true;
  TreeRay ray = tree_ray_of(vec3(point - tree_middle), vec3(to_light));
  float until = float(end) * (1 + 1e-6);
  for (int node = 0; node < tree_end;) {
    int leaf = next_leaf(ray, node, tree_end, until);
    for (int bits = may_be_met(ray, leaf); bits != 0; bits &= bits - 1) {
      int triangle = triangle_at((leaf >> 3) + findLSB(bits));
      if (triangle != own && primitive_blocks(triangle, false, point, to_light, end)) return true;
    }
  }
  return false;
}
