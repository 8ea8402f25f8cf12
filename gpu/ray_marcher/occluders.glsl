// Is a light hidden behind a surface? Triangles through a tree of boxes without a stack: nodes lie in depth-first order, and a
// box that is missed names the node behind its whole branch. Spheres and planes one by one.
struct Node {
  vec3 lo;
  int behind;
  vec3 hi;
  int leaf;  // 8 * first triangle + their number; -1 for a branch
};
struct Triangle {
  vec4 a, b, c;
};
struct Solid {
  vec3 place;   // centre, or a point of the plane
  float radius;  // 0: a plane
  vec3 normal;
  float unused;
};

layout(std430, binding = 7) readonly buffer Nodes { Node nodes[]; };
layout(std430, binding = 8) readonly buffer Triangles { Triangle triangles[]; };
layout(std430, binding = 9) readonly buffer Solids { Solid solids[]; };
uniform int node_count, solid_count;

bool solid_between(Solid s, vec3 origin, vec3 direction, float t_end) {
  if (s.radius == 0) {
    float height = dot(s.normal, s.place - origin), speed = dot(s.normal, direction);
    return height * speed > 0 && abs(height) < abs(speed) * t_end;
  }
  vec3 offset = s.place - origin;
  float along = dot(offset, direction), passing = length(offset - along * direction);
  if (!(passing < s.radius)) return false;
  float half_chord = sqrt((s.radius - passing) * (s.radius + passing));
  // Of the two roots one may cancel; their product is the power of the origin.
  float far = along >= 0 ? along + half_chord : along - half_chord, distance_ = length(offset);
  float near = far != 0 ? (distance_ - s.radius) * (distance_ + s.radius) / far : 0;
  return (near > 0 && near < t_end) || (far > 0 && far < t_end);
}

// Woop, Benthin and Wald 2013: edge functions after a shear that turns the ray into an axis. Edges belong to both sides.
bool triangle_between(Triangle s, ivec3 axis, vec3 shear, vec3 origin, float t_end) {
  vec3 a = s.a.xyz - origin, b = s.b.xyz - origin, c = s.c.xyz - origin;
  vec2 p = vec2(a[axis.x], a[axis.y]) - shear.xy * a[axis.z], q = vec2(b[axis.x], b[axis.y]) - shear.xy * b[axis.z],
       r = vec2(c[axis.x], c[axis.y]) - shear.xy * c[axis.z];
  float u = q.x * r.y - q.y * r.x, v = r.x * p.y - r.y * p.x, w = p.x * q.y - p.y * q.x;
  if (min(min(u, v), w) < 0 && max(max(u, v), w) > 0) return false;
  float whole = u + v + w;
  if (whole == 0) return false;
  float t = shear.z * (a[axis.z] + (v * (b[axis.z] - a[axis.z]) + w * (c[axis.z] - a[axis.z])) / whole);
  return t > 0 && t < t_end;
}

bool occluded(vec3 origin, vec3 direction, float t_end) {
  work += uint(solid_count);
  for (int i = 0; i < solid_count; ++i)
    if (solid_between(solids[i], origin, direction, t_end)) return true;
  vec3 size = abs(direction);
  int z = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  ivec3 axis = ivec3((z + 1) % 3, (z + 2) % 3, z);
  vec3 shear = vec3(direction[axis.x], direction[axis.y], 1) / direction[z];
  vec3 inverse;
  for (int a = 0; a < 3; ++a) inverse[a] = 1 / (size[a] < 1e-20 ? 1e-20 : direction[a]);
  for (int i = 0; i < node_count;) {
    Node node = nodes[i];
    ++work;
    vec3 s = (node.lo - origin) * inverse, e = (node.hi - origin) * inverse;
    vec3 first = min(s, e), last = max(s, e);
    float enter = max(max(first.x, first.y), max(first.z, 0)), leave = min(min(last.x, last.y), min(last.z, t_end));
    if (!(enter <= leave)) {
      i = node.behind;
      continue;
    }
    if (node.leaf >= 0)
      for (int k = node.leaf >> 3; k < (node.leaf >> 3) + (node.leaf & 7); ++k)
        if (triangle_between(triangles[k], axis, shear, origin, t_end)) return true;
    ++i;
  }
  return false;
}
