// m where camera rays begin: how many surfaces the segments from the light to there cross; methods/shadow_planes/surface_count.cpp.
// BY_PIXEL 0: at the camera, the tree shared out among the invocations of one group. 1: where the rays of a parallel view begin,
// one invocation a pixel.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/loops_cut.glsl"
#include "raster/solids.glsl"
#include "raster/tree.glsl"
#include "raster/view.glsl"
#include "shadow_planes/counters.glsl"
#include "shadow_planes/edge_meshes.glsl"
#include "shadow_planes/facing.glsl"
#define FINDS_LIGHT_STATE 1
#include "shadow_planes/light_state.glsl"
#include "shadow_planes/ray.glsl"
#include "shadow_planes/spheres.glsl"
#include "shadow_planes/watertight.glsl"

// By the scene's triangle the one among those of edge_meshes; -1: it is there before, or has no area.
layout(std430, binding = AT_MESH_NUMBERS) readonly buffer MeshNumbers { int mesh_number[]; };
#if BY_PIXEL
#include "shadow_planes/state.glsl"
#else
shared int sum_of_group;
#endif

// Is the triangle through b and c, seen from the light, on the negative side of the edge from a to b? Computed the same way for
// both triangles of the edge.
bool is_below(dvec3 y, dvec3 a, int number_of_a, dvec3 b, int number_of_b) {
  return number_of_a < number_of_b ? precise_dot(y, precise_cross(a, b)) < 0 : !(precise_dot(y, precise_cross(b, a)) < 0);
}

// For a triangle whose plane contains the light: rays from the light may or may not meet it. Edges and sides follow the
// conventions of the silhouette.
bool is_behind(ivec3 numbers, dvec3 a, dvec3 b, dvec3 c, dvec3 y) {
  if (!faces_light(a, b, c)) {  // turned to face the light: the shadow is on the negative side of each edge
    dvec3 other = b;
    b = c;
    c = other;
    numbers.yz = numbers.zy;
  }
  return is_below(y, a, numbers.x, b, numbers.y) && is_below(y, b, numbers.y, c, numbers.z) &&
         is_below(y, c, numbers.z, a, numbers.x) && precise_dot(y - a, precise_cross(b - a, c - a)) < 0;
}

// The point lies at y, `end` metres from the light.
bool is_crossed(int triangle, Shear shear, dvec3 y, double end) {
  int number = mesh_number[triangle];
  if (number < 0) return false;
  ivec3 corners = corners_of(number);
  dvec3 a = place_of_vertex(corners.x) - light, b = place_of_vertex(corners.y) - light, c = place_of_vertex(corners.z) - light;
  dvec3 normal = precise_cross(b - a, c - a);
  if (abs(precise_dot(normal, a)) <= 1e-9LF * length(normal) * (length(a) + length(b) + length(c)))
    return is_behind(corners, a, b, c, y);
  double t = meet_corners(shear, a, b, c);
  return t > 0 && t < end;
}

// Number of crossed triangles below the nodes from `node` on, before `last`, in the order of memory.
int crossed_triangles(dvec3 y, double end, int node, int last) {
  int sum = 0;
  dvec3 direction = y / end;
  TreeRay ray = tree_ray_of(vec3(light - tree_middle), vec3(direction));
  ray.octant = 0;
  Shear shear = shear_of(direction);
  float until = float(end) * (1 + 1e-6);
  while (node < last) {
    int leaf = next_leaf(ray, node, last, until);
    for (int bits = may_be_met(ray, leaf); bits != 0; bits &= bits - 1)
      if (is_crossed(triangle_at((leaf >> 3) + findLSB(bits)), shear, y, end)) ++sum;
  }
  return sum;
}

int crossed_solids(dvec3 y) {
  int sum = 0;
  for (int i = 0; i < solid_count; ++i) {
    Solid s = solids[i];
    dvec3 from_light = dvec3(s.point[0], s.point[1], s.point[2]) - light, normal = dvec3(s.normal[0], s.normal[1], s.normal[2]);
    if (s.kind == 1 && hides(from_light, s.radius, y)) sum += 2;
    if (s.kind != 0) continue;
    double here = -dot(normal, from_light), there = dot(normal, light + y - dvec3(s.point[0], s.point[1], s.point[2]));
    sum += int((here > 0 && there < 0) || (here < 0 && there > 0));
  }
  return sum;
}

void main() {
#if BY_PIXEL
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  dvec3 y = in_general_position(origin) - light;
  double end = length(y);
  states[pixel.y * view_width + pixel.x].m_origin = end > 0 ? crossed_triangles(y, end, 0, tree_end) + crossed_solids(y) : 0;
#else
  int invocation = int(gl_LocalInvocationIndex), share = NODE_ENTRIES * ((tree_end / NODE_ENTRIES + LOCAL_SIZE_X - 1) / LOCAL_SIZE_X);
  dvec3 y = in_general_position(view_position) - light;
  double end = length(y);
  if (invocation == 0) sum_of_group = end > 0 ? crossed_solids(y) : 0;
  barrier();
  int first = invocation * share;
  if (end > 0) atomicAdd(sum_of_group, crossed_triangles(y, end, first, min(first + share, tree_end)));
  barrier();
  if (invocation == 0) count_at_camera = sum_of_group;
#endif
  if (loops_cut()) atomicOr(loops_were_cut, 1);
}
