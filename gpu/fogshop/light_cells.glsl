// Directions from a light in the square cells of an octahedral map.
uniform int cells;  // to a side, even (0: there are no lists): so a cell lies on one face of the octahedron, or is cut along its diagonal
const float list_margin = 0.08;  // rays of lists leave those of the cell by up to this, per metre

vec2 octahedral(vec3 d) {
  vec2 q = d.xy / max(abs(d.x) + abs(d.y) + abs(d.z), 1e-30);
  return d.z >= 0 ? q : (1 - abs(q.yx)) * vec2(q.x < 0 ? -1 : 1, q.y < 0 ? -1 : 1);
}
int cell_of(int light, vec3 direction) {
  ivec2 cell = clamp(ivec2(0.5 * float(cells) * (octahedral(direction) + 1)), ivec2(0), ivec2(cells - 1));
  return (light * cells + cell.y) * cells + cell.x;
}
// On the map, -1 to 1.
vec3 direction_at(vec2 p) {
  float z = 1 - abs(p.x) - abs(p.y);
  return normalize(vec3(z >= 0 ? p : (1 - abs(p.yx)) * vec2(p.x < 0 ? -1 : 1, p.y < 0 ? -1 : 1), z));
}
