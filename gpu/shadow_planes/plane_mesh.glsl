// Shadow planes as meshes away from the light: methods/shadow_planes/plane_mesh.cpp. Every edge has a row of vertices for each
// end of its pieces: plane_levels + 1, and one at infinity.
uniform int plane_levels;
uniform float plane_far;  // [m] from the light

// Logarithm of the ratio between levels.
float level_ratio(dvec3 a, dvec3 b) {
  float near = max(0.5 * float(length(a + b)), 1e-6 * plane_far);
  return log(max(2.0, plane_far / near)) / float(plane_levels);
}

int plane_row(int edge, int pieces) { return edge * (pieces + 1) * (plane_levels + 2); }
