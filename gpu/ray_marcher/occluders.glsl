// Is a light hidden behind a surface? Triangles through the tree of all of them, spheres and planes one by one, all in single
// precision: for points in the media.
#define COUNT_NODE ++work;
#include "raster/tree.glsl"

struct Solid {
  vec3 place;   // centre, or a point of the plane
  float radius;  // 0: a plane
  vec3 normal;
  float unused;
};

layout(std430, binding = AT_SOLIDS) readonly buffer Solids { Solid blockers[]; };
uniform vec3 middle_in_tree;  // [m] of the marcher's places, from the tree's middle

bool solid_between(Solid s, vec3 origin, vec3 direction, float t_end) {
  if (s.radius == 0) {
    float height = dot(s.normal, s.place - origin), speed = dot(s.normal, direction);
    return height * speed > 0 && abs(height) < abs(speed) * t_end;
  }
  vec3 offset = s.place - origin;
  float along = dot(offset, direction), passing = length(offset - along * direction);
  if (!(passing < s.radius)) return false;
  float half_chord = sqrt((s.radius - passing) * (s.radius + passing));
  // One of the two roots can cancel. Their product is the power of the origin, which gives the other root without cancellation.
  float far = along >= 0 ? along + half_chord : along - half_chord, distance_ = length(offset);
  float near = far != 0 ? (distance_ - s.radius) * (distance_ + s.radius) / far : 0;
  return (near > 0 && near < t_end) || (far > 0 && far < t_end);
}

// Woop, Benthin and Wald 2013: edge functions after a shear that turns the ray into an axis. Edges belong to both sides.
bool triangle_between(TreeRay ray, int place, float along, float t_end) {
  vec3 a = corner_of(ray, place, 0), b = corner_of(ray, place, 1), c = corner_of(ray, place, 2);
  vec2 p = a.xy - ray.shear * a.z, q = b.xy - ray.shear * b.z, r = c.xy - ray.shear * c.z;
  float u = q.x * r.y - q.y * r.x, v = r.x * p.y - r.y * p.x, w = p.x * q.y - p.y * q.x;
  if (min(min(u, v), w) < 0 && max(max(u, v), w) > 0) return false;
  float whole = u + v + w;
  if (whole == 0) return false;
  float t = (a.z + (v * (b.z - a.z) + w * (c.z - a.z)) / whole) / along;
  return t > 0 && t < t_end;
}

bool occluded(vec3 origin, vec3 direction, float t_end) {
  work += uint(solid_count);
  for (int i = 0; i < solid_count; ++i)
    if (solid_between(blockers[i], origin, direction, t_end)) return true;
  TreeRay ray = tree_ray_of(origin + middle_in_tree, direction);
  float along = direction[ray.axis.z];
  for (int node = 0; node < tree_end;) {
    int leaf = next_leaf(ray, node, tree_end, t_end);
    for (int k = leaf >> 3; k < (leaf >> 3) + (leaf & 7); ++k)
      if (triangle_between(ray, k, along, t_end)) return true;
  }
  return false;
}
