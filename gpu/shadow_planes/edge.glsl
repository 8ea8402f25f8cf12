// A silhouette edge relative to its light; methods/shadow_planes/silhouette.h.
struct Edge {
  double a[3], b[3];  // [m]
  int multiplicity;
  int origin;  // its place among all edges of the meshes: the order in which the processor has them
};
