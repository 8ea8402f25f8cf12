// The meshes of a scene, one after the other.
layout(std430, binding = 10) readonly buffer Vertices { double vertex_coordinate[]; };  // [m]
layout(std430, binding = 11) readonly buffer Triangles { ivec4 triangles[]; };          // three vertices, surface

dvec3 mesh_vertex(int i) {
  return dvec3(vertex_coordinate[3 * i], vertex_coordinate[3 * i + 1], vertex_coordinate[3 * i + 2]);
}
