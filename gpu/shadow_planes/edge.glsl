// A silhouette edge relative to its light; methods/shadow_planes/silhouette.h.
struct Edge {
  vec4 near_a;  // the ends rounded to single precision; w: what this may be off [m], with room for products
  vec3 near_b;
  int multiplicity;
  double a[3], b[3];  // [m]
  int origin;         // its place among all edges of the meshes: the order in which the processor has them
  int left_out;       // its plane cannot cut the medium in question (left_out.comp)
};

// The triangle of light, origin of a ray and its end, in single precision: unit normals of its plane and of those through the light
// and either end, outwards; across the ray, which lies `h` [m] from the light.
struct Wedge {
  vec3 side, before, beyond, across;
  float h;
};

// Does single precision tell that an edge passes by the triangle, both its ends outside one of the planes? Where it cannot, double
// precision has to.
bool surely_beside(vec3 a, vec3 b, float slack, Wedge wedge) {
  float sa = dot(wedge.side, a), sb = dot(wedge.side, b), before = min(dot(wedge.before, a), dot(wedge.before, b));
  float beyond = min(dot(wedge.beyond, a), dot(wedge.beyond, b)), across = min(dot(wedge.across, a), dot(wedge.across, b)) - wedge.h;
  return min(sa, sb) > slack || max(sa, sb) < -slack || max(max(before, beyond), across) > slack;
}
