// The paper's Gamma at vertices: the airlight of a ray from the camera to each if all of it is lit (Biri et al. 2006, sections
// 5.1.3, 5.1.5, 5.2); methods/shadow_planes/vertex_airlight.cpp. OF: 0 meshes, 1 a medium's boundary, 2 shadow planes, of which an
// invocation does one vertex of the row y.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/loops_cut.glsl"
#include "raster/primitive.glsl"
#include "shadow_planes/counters.glsl"
#include "shadow_planes/ray.glsl"
#include "shadow_planes/airlight.glsl"
#if OF == 1
#include "shadow_planes/boundary.glsl"
#endif
#if OF == 2
#include "shadow_planes/edge.glsl"
#include "shadow_planes/light_state.glsl"
#include "shadow_planes/plane_mesh.glsl"
layout(std430, binding = AT_EDGES) readonly buffer Edges { Edge edges[]; };
uniform int pieces, most_edges;
#else
uniform int vertex_count;
#endif

layout(std430, binding = AT_VALUES) writeonly buffer Values { vec4 values[]; };
uniform int first_value;
uniform dvec3 camera;       // [m]
uniform double ball_radius; // [m], of the light
uniform vec3 intensity;     // [W/sr]

// From the camera to vertex i.
dvec3 way_to(int i, out bool at_infinity) {
  at_infinity = false;
#if OF == 0
  return mesh_vertex(i) - camera;
#elif OF == 1
  dvec3 centre, half_size;
  boundary_frame(centre, half_size);
  int side = boundary_cells + 1, face = i / (side * side), rest = i % (side * side);
  return centre + boundary_vertex(half_size, face, rest % side, rest / side) - camera;
#else
  int row = int(gl_GlobalInvocationID.y), levels = plane_levels + 2, level = row % levels;
  Edge edge = edges[gl_GlobalInvocationID.x];
  dvec3 a = dvec3(edge.a[0], edge.a[1], edge.a[2]), b = dvec3(edge.b[0], edge.b[1], edge.b[2]);
  dvec3 p = a + (b - a) * (double(row / levels) / pieces);
  at_infinity = level == plane_levels + 1;
  return at_infinity ? p : light + exp(float(level) * level_ratio(a, b)) * p - camera;
#endif
}

void main() {
#if OF == 2
  int e = int(gl_GlobalInvocationID.x), i = plane_row(e, pieces) + int(gl_GlobalInvocationID.y);
  if (e >= edge_count) return;
  if (e >= most_edges) {
    values_missing = 1;
    return;
  }
#else
  int i = int(gl_GlobalInvocationID.x);
  if (i >= vertex_count) return;
#endif
  bool at_infinity;
  dvec3 way = way_to(i, at_infinity);
  double length_ = length(way), end = at_infinity ? 1e37LF : length_;
  vec3 value = vec3(0);
  if (length_ > 0) {
    Line line = Line(camera, way / length_);
    Ray ray = ray_on(line);
    // The ray ends on the light's ball, or close to the light, like the rays of an image.
    double radius = max(ball_radius, 1e-6LF * length(ray.to_light));
    if (ray.h < radius) {
      double half_chord = sqrt((radius - ray.h) * (radius + ray.h));
      if (ray.T + half_chord > 0) end = min(end, ray.T - half_chord);
    }
    if (end > 0) value = intensity * lit_airlight(line, 0, end);
  }
  if (loops_cut()) atomicOr(loops_were_cut, 1);
  values[first_value + i] = vec4(value, 0);
}
