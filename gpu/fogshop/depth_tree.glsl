// Average depths on surfaces by the tree of methods/fogshop/depth_tree.h. Needs `tables`; after average_depth.glsl.
uniform int tree_children_at, tree_cells_at, tree_lists_at;
uniform dvec3 tree_corner;              // [m]
uniform vec3 tree_center;               // [m]
uniform double tree_scale;              // 2^32 over the side of the root [1/m]; 0: there are no cells
uniform float tree_far;                 // [m^2]
const int TREE_CELL = TREE_COEFFICIENTS + 2;  // a polynomial, and where its list begins and ends

// x, y, z in [-1, 1]. TREE_POLYNOMIAL is Horner's form, of c(0), c(1), ... and x.
#define c(k) tables[at + k]
float cell_polynomial(int at, vec3 x) { return TREE_POLYNOMIAL; }
#undef c

float tree_depth(dvec3 point) {
  dvec3 place = (point - tree_corner) * tree_scale;
  if (tree_scale == 0 || any(lessThan(place, dvec3(0))) || any(greaterThanEqual(place, dvec3(4294967296.0LF)))) {
    vec3 away = vec3(point) - tree_center;
    return tree_far / dot(away, away);
  }
  // The first bits choose the parts, the others are the place in the cell.
  uvec3 bits = uvec3(place);
  int node = 0;
  while (node >= 0) {
    uvec3 upper = bits >> 31;
    bits <<= 1;
    node = int(tables[tree_children_at + 8 * node + int(upper.x + 2u * upper.y + 4u * upper.z)]);
  }
  int at = tree_cells_at + TREE_CELL * (-1 - node);
  float sum = cell_polynomial(at, vec3(bits) * (1.0 / 2147483648.0) - 1);
  for (int k = int(tables[at + TREE_COEFFICIENTS]), end = int(tables[at + TREE_COEFFICIENTS + 1]); k < end; ++k)
    sum += average_depth(gaussians[int(tables[tree_lists_at + k])], vec3(point));
  return sum;
}
