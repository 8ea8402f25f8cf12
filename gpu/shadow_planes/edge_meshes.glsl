// The meshes of a scene by their edges, methods/shadow_planes/silhouette.h: vertices at one place are one.
layout(std430, binding = AT_MESH_VERTICES) readonly buffer MeshVertices { double mesh_coordinate[]; };  // [m]
layout(std430, binding = AT_MESH_TRIANGLES) readonly buffer MeshTriangles { int mesh_corner[]; };       // three vertices each

ivec3 corners_of(int triangle) {
  return ivec3(mesh_corner[3 * triangle], mesh_corner[3 * triangle + 1], mesh_corner[3 * triangle + 2]);
}
dvec3 place_of_vertex(int i) { return dvec3(mesh_coordinate[3 * i], mesh_coordinate[3 * i + 1], mesh_coordinate[3 * i + 2]); }
