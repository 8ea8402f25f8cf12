// Biri et al. 2006, section 5.1, stage 1: edges of all meshes whose planes with the light bound a shadow, one edge per
// invocation; methods/shadow_planes/silhouette.cpp. In double precision: two triangles must agree about each edge.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "shadow_planes/edge.glsl"

layout(std430, binding = 1) readonly buffer Vertices { double vertex_coordinate[]; };  // [m]
layout(std430, binding = 2) readonly buffer Triangles { int corner[]; };                // three vertices each
layout(std430, binding = 3) readonly buffer MeshEdges { ivec4 mesh_edges[]; };          // ends, first side, sides
layout(std430, binding = 4) readonly buffer Sides { int sides[]; };  // twice the triangle, + 1 if it runs from a to b
layout(std430, binding = 0) writeonly buffer Edges { Edge edges[]; };
layout(std430, binding = 6) buffer EdgeCount { int edge_count; };
uniform int mesh_edge_count;
uniform dvec3 light;  // [m]

dvec3 from_light(int vertex) {
  int i = 3 * vertex;
  return dvec3(vertex_coordinate[i], vertex_coordinate[i + 1], vertex_coordinate[i + 2]) - light;
}
bool faces_light(int triangle) {
  int i = 3 * triangle;
  dvec3 a = from_light(corner[i]), b = from_light(corner[i + 1]), c = from_light(corner[i + 2]);
  dvec3 normal = cross(b - a, c - a);
  return dot(normal, a) <= 4e-15LF * sqrt(dot(normal, normal) * (dot(a, a) + dot(b, b) + dot(c, c)));
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= mesh_edge_count) return;
  ivec4 edge = mesh_edges[i];
  int sum = 0;
  for (int k = edge.z; k < edge.z + edge.w; ++k) sum += (sides[k] & 1) == int(faces_light(sides[k] >> 1)) ? 1 : -1;
  if (sum == 0) return;
  dvec3 a = from_light(sum > 0 ? edge.x : edge.y), b = from_light(sum > 0 ? edge.y : edge.x);
  edges[atomicAdd(edge_count, 1)] =
      Edge(vec4(vec3(a), length(a)), vec4(vec3(b), length(b)), double[3](a.x, a.y, a.z), double[3](b.x, b.y, b.z), abs(sum), i);
}
