// A silhouette edge relative to its light; methods/shadow_planes/silhouette.h.
struct Edge {
  vec4 near_a, near_b;  // the ends rounded to single precision, and their distances [m]
  double a[3], b[3];    // [m]
  int multiplicity;
  int origin;  // its place among all edges of the meshes: the order in which the processor has them
};

// Does single precision tell that both ends lie on the same side of the plane through the light with that unit normal? Where
// it cannot, double precision has to.
bool surely_beside(vec4 a, vec4 b, vec3 normal) {
  float sa = dot(normal, a.xyz), sb = dot(normal, b.xyz), slack = 1e-6 * max(a.w, b.w);
  return (sa > slack && sb > slack) || (sa < -slack && sb < -slack);
}
