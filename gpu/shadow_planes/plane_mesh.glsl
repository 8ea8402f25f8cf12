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

// The triangle in which a plane is crossed, `s` times as far from the light as its edge, which may be infinite, at `share` of the
// edge: its corners counted from the edge's first vertex, and the point's weights.
void locate_on_plane(float ratio, int pieces, float share, float s, out ivec3 corners, out vec3 weight) {
  float along = share * float(pieces);
  int piece = clamp(int(along), 0, pieces - 1);
  float u = along - float(piece);
  s = clamp(s, 1.0, 1e37);
  int level = int(min(log(s) / ratio, float(plane_levels)));  // no infinity becomes an integer
  int a0 = piece * (plane_levels + 2) + level, b0 = a0 + plane_levels + 2;
  float s0 = exp(float(level) * ratio), nearer = s0 / s, at_a = 1 - u, at_b = u;
  if (level < plane_levels) {
    float s1 = exp(float(level + 1) * ratio);
    nearer = clamp((s1 - s) / (s1 - s0), 0.0, 1.0);
    at_a = s * (1 - u) / s0;
    at_b = s * u / s1;
  }
  corners = at_a <= nearer ? ivec3(a0, b0, b0 + 1) : ivec3(a0, a0 + 1, b0 + 1);
  weight = at_a <= nearer ? vec3(at_a, nearer - at_a, 1 - nearer) : vec3(nearer, 1 - nearer - at_b, at_b);
}
