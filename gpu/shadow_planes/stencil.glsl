// The paper's picture: a stencil, and planes drawn back to front, Biri et al. 2006, sections 5.1 and 5.2;
// methods/shadow_planes/paper_stages.cpp. VERTICES: Gamma comes from vertices; PAPER_MEDIUM: of one medium in a region.
#if PAPER_MEDIUM
#include "shadow_planes/boundary.glsl"
#endif
#if VERTICES
#include "shadow_planes/plane_mesh.glsl"
layout(std430, binding = AT_VALUES) readonly buffer Values { vec4 values[]; };
uniform int first_boundary, first_plane;  // in values, after those of meshes
uniform int media_end;                    // all of them have an end

vec3 mix_values(ivec3 at, vec3 weight) {
  return weight.x * values[at.x].rgb + weight.y * values[at.y].rgb + weight.z * values[at.z].rgb;
}

#if CROSSINGS
// Where plane e is crossed, `s` times as far from the light as its edge.
vec3 gamma_on_plane(int e, float share, float s) {
  dvec3 a = dvec3(edges[e].a[0], edges[e].a[1], edges[e].a[2]), b = dvec3(edges[e].b[0], edges[e].b[1], edges[e].b[2]);
  ivec3 corners;
  vec3 weight;
  locate_on_plane(level_ratio(a, b), edge_split, share, s, corners, weight);
  return mix_values(first_plane + plane_row(e, edge_split) + corners, weight);
}
#endif

// Linear over a triangle of a mesh.
vec3 gamma_on_triangle(ivec4 corners, dvec3 point) {
  dvec3 a = mesh_vertex(corners.x), ab = mesh_vertex(corners.y) - a, ac = mesh_vertex(corners.z) - a, ap = point - a;
  dvec3 n = cross(ab, ac);
  double all = dot(n, n), v = dot(cross(ap, ac), n) / all, w = dot(cross(ab, ap), n) / all;
  return mix_values(corners.xyz, vec3(1 - v - w, v, w));
}
#endif

// The part of a ray that is drawn.
dvec2 drawn_part(Line line, double end) {
#if PAPER_MEDIUM
  return domain_of(line, end);
#elif VERTICES && BOUNDED
  // From where the ray enters the first medium to where it leaves the last: Gamma is constant elsewhere.
  if (media_end != 0) {
    dvec2 part = dvec2(1e37LF, 0);
    for (int k = 0; k < media_count; ++k) {
      dvec2 inside = clip_to_region(k, line.origin, line.direction, dvec2(0, end));
      if (inside.y > inside.x) part = dvec2(min(part.x, inside.x), max(part.y, inside.y));
    }
    return part;
  }
#endif
  return dvec2(0, end);
}

#if PAPER_MEDIUM
// In the order of planes, the triangle of the boundary through which a ray enters.
double key_of_entry(Line line, double place) {
  dvec3 corners[3];
  ivec3 numbers;
  vec3 weight;
  locate_on_boundary(line.origin + place * line.direction, corners, numbers, weight);
  return dot(normalize((corners[0] + corners[1] + corners[2]) / 3 - light), -normalize(light - line.origin));
}
#endif

#if VERTICES
// Where the ray leaves the air at `place`, or ends. False: no vertices are there.
bool gamma_at_end(Line line, double end, double place, int primitive, out vec3 gamma) {
  gamma = vec3(0);
#if PAPER_MEDIUM
  if (place < end) {
    dvec3 corners[3];
    ivec3 numbers;
    vec3 weight;
    locate_on_boundary(line.origin + place * line.direction, corners, numbers, weight);
    gamma = mix_values(first_boundary + numbers, weight);
    return true;
  }
#endif
  if (primitive < 0 || primitive >= triangle_count) return false;
  gamma = gamma_on_triangle(triangles[primitive], line.origin + end * line.direction);
  return true;
}
#endif

#if CROSSINGS
// Effect of the next plane on the light in front of it: 1 adds, -1 subtracts. `entry`: planes that are sorted in front of it are not
// drawn, and the stencil becomes 255 there. Returns false from there on.
bool meet_plane(Line line, double end, dvec2 part, double entry, int e, inout int stencil, out float share, out int name,
                out double place, out double on_edge, out double times) {
  share = 0;
  name = hit_name[slot_of(e)];
  place = on_edge = times = 0;
  if (hit_key[slot_of(e)] >= entry) return false;
  place = place_of(ray_in_general_position(line), end, name, on_edge, times);
  if (place >= part.y) return true;
#if PAPER_MEDIUM
  if (name >= 0 && edges[name >> 1].left_out != 0) return true;
#endif
  int change = change_of(name);
  if (change > 0 && stencil == change) share = 1;
  if (change < 0 && stencil == 0) share = -1;
  stencil = max(0, stencil - change);
#if VERTICES && BOUNDED
  if (media_end != 0 && place <= part.x) share = 0;
#endif
  return true;
}
#endif

// Stage 3, the end of the ray (e = -1), and stage 5, planes. False: no other will be drawn.
bool draw(Line line, double end, dvec2 part, double entry, int primitive, bool first, inout State state,
          inout int parts) {
  for (int e = first ? -1 : 0; e < hit_count; ++e) {
    float share = state.m == 0 ? 1 : 0;
    double place = part.y;
    int name = -1;
#if CROSSINGS
    double on_edge = 0, times = 0;
    if (e >= 0 && !meet_plane(line, end, part, entry, e, state.m, share, name, place, on_edge, times)) return false;
#endif
    if (share == 0) continue;
    ++parts;
    bool by_pixel = true;
    vec3 gamma = vec3(0);
#if VERTICES
    if (e < 0) by_pixel = !gamma_at_end(line, end, place, primitive, gamma);
#if CROSSINGS
    if (name >= 0) {
      gamma = gamma_on_plane(name >> 1, float(on_edge), float(min(times, 1e37LF)));
      by_pixel = false;
    }
#endif
#endif
    if (by_pixel) gamma = intensity * lit_airlight(line, 0, place);
    state.sum.rgb += share * gamma;
    if (frame_buffer != 0) state.sum.rgb = clamp(floor(state.sum.rgb * 255 + 0.5) / 255, vec3(0), vec3(1));
  }
  return true;
}

// `state.unfinished` on return: there are more crossings. `m_end`: m where the ray ends.
vec3 airlight_of(Line line, double end, int primitive, int m_origin, inout State state, out int m_end, out Work work) {
  dvec2 part = drawn_part(line, end);
  double entry = 1e300LF;
  work = Work(0, 0, 0);
  m_end = m_origin;
  bool more = false, drawn = part.y > part.x && meets_air(line, end);
#if PAPER_MEDIUM
  if (drawn && part.x > 0) entry = key_of_entry(line, part.x);
#endif
  for (int gathering = 0; drawn || primitive >= 0; ++gathering) {
    bool first = resume == 0 && gathering == 0;
#if CROSSINGS
    stencil_end = part.y;
    more = gather(line, end, state.last_key, state.last_origin) && drawn;
    m_end = m_origin + crossing_sum;
    work.crossings = crossing_count;
    if (first) state.m = m_origin + stencil_sum;
#endif
#if SHADOWS == 0
    state.m = 0;
#endif
    if (drawn && !draw(line, end, part, entry, primitive, first, state, work.parts)) more = false;
    work.gatherings += int(more);
    if (!more || gathering + 1 >= most_gatherings) break;
  }
  state.unfinished = int(more);
  return state.sum.rgb;
}
