// Biri et al. 2006, section 5.1, stage 1: edges of all meshes whose planes with the light bound a shadow, one edge per
// invocation; methods/shadow_planes/silhouette.cpp. In double precision: two triangles must agree about each edge.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "shadow_planes/edge.glsl"
#include "shadow_planes/edge_meshes.glsl"
#include "shadow_planes/facing.glsl"
#define FINDS_LIGHT_STATE 1
#include "shadow_planes/light_state.glsl"

layout(std430, binding = AT_MESH_EDGES) readonly buffer MeshEdges { ivec4 mesh_edges[]; };  // ends, first side, sides
// Twice the triangle, + 1 if it runs from a to b.
layout(std430, binding = AT_MESH_SIDES) readonly buffer MeshSides { int sides[]; };
layout(std430, binding = AT_EDGES) writeonly buffer Edges { Edge edges[]; };
uniform int mesh_edge_count, plane_rows;
uniform dvec3 light;  // [m]

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= mesh_edge_count) return;
  ivec4 edge = mesh_edges[i];
  int sum = 0;
  for (int k = edge.z; k < edge.z + edge.w; ++k) {
    ivec3 corners = corners_of(sides[k] >> 1);
    bool faces = faces_light(place_of_vertex(corners.x) - light, place_of_vertex(corners.y) - light,
                             place_of_vertex(corners.z) - light);
    sum += (sides[k] & 1) == int(faces) ? 1 : -1;
  }
  if (sum == 0) return;
  dvec3 a = place_of_vertex(sum > 0 ? edge.x : edge.y) - light, b = place_of_vertex(sum > 0 ? edge.y : edge.x) - light;
  int place = atomicAdd(edge_count, 1);
  float slack = 1e-6 * float(max(length(a), length(b)));
  edges[place] =
      Edge(vec4(vec3(a), slack), vec3(b), abs(sum), double[3](a.x, a.y, a.z), double[3](b.x, b.y, b.z), i, 0);
  if (place % EDGES_PER_GROUP != 0) return;
  atomicAdd(edge_groups[0], 1);
  atomicAdd(plane_groups[0], 1);
  if (place != 0) return;
  edge_groups[1] = edge_groups[2] = plane_groups[2] = 1;
  plane_groups[1] = uint(plane_rows);
}
