// Shadows by what a light sees, and by all there is (gpu/raster/light_distances.h).
#include "raster/shadow_tree.glsl"

layout(std430, binding = 5) readonly buffer LightPrimitives { int light_primitive[]; };
uniform int map_side;        // texels; 0: there are no maps

// Texel in which a direction from the light lies: the faces and their axes are those of LightDistances::face_view.
int map_texel_of(vec3 u) {
  vec3 m = abs(u);
  int axis = m.x >= m.y && m.x >= m.z ? 0 : (m.y >= m.z ? 1 : 2);
  bool negative = u[axis] < 0;
  float across = (negative ? -1 : 1) * u[(axis + 2) % 3] / m[axis], upwards = u[(axis + 1) % 3] / m[axis];
  ivec2 texel = clamp(ivec2(floor(0.5 * float(map_side) * vec2(1 + across, 1 - upwards))), ivec2(0), ivec2(map_side - 1));
  return ((2 * axis + (negative ? 1 : 0)) * map_side + texel.y) * map_side + texel.x;
}

// Is anything between a point of primitive `own` and the light, `end` metres along `to_light`? The primitives of the nine texels
// around the direction are tried first: in a shadow one of them is the answer mostly. Then all, by the tree.
bool in_shadow(int light, int own, dvec3 point, dvec3 to_light, double end) {
  if (primitive_blocks(own, true, point, to_light, end)) return true;
  if (map_side == 0) return false;
  // The point's place on its face of the cube, and one texel to each side; across an edge that is the next face.
  vec3 u = vec3(-to_light), m = abs(u);
  int axis = m.x >= m.y && m.x >= m.z ? 0 : (m.y >= m.z ? 1 : 2);
  u /= m[axis];
  float step_ = 2 / float(map_side);
  int last = own;
  for (int i = 0; i < 9; ++i) {
    vec3 beside = u;
    beside[(axis + 1) % 3] += float(i % 3 - 1) * step_;
    beside[(axis + 2) % 3] += float(i / 3 - 1) * step_;
    int primitive = light_primitive[light * 6 * map_side * map_side + map_texel_of(beside)];
    if (primitive < 0 || primitive == own || primitive == last) continue;
    last = primitive;
    if (primitive_blocks(primitive, false, point, to_light, end)) return true;
  }
  return tree_blocks(own, point, to_light, end);
}
