// The paper's picture: a stencil, and planes drawn back to front, Biri et al. 2006, sections 5.1 and 5.2;
// methods/shadow_planes/paper_stages.cpp. VERTICES: Gamma comes from vertices; PAPER_MEDIUM: of one medium in a region.
#if PAPER_MEDIUM
#include "shadow_planes/boundary.glsl"
layout(std430, binding = 15) readonly buffer LeftOut { int left_out[]; };
#endif
#if VERTICES
#include "shadow_planes/plane_mesh.glsl"
layout(std430, binding = 13) readonly buffer Values { vec4 values[]; };
uniform int first_boundary, first_plane;  // in values, after those of meshes
uniform int media_end;                    // all of them have an end

vec3 mix_values(ivec3 at, vec3 weight) {
  return weight.x * values[at.x].rgb + weight.y * values[at.y].rgb + weight.z * values[at.z].rgb;
}

// Where plane e is crossed, `s` times as far from the light as its edge: methods/shadow_planes/plane_mesh.cpp.
vec3 gamma_on_plane(int e, float share, float s) {
  dvec3 a = dvec3(edges[e].a[0], edges[e].a[1], edges[e].a[2]), b = dvec3(edges[e].b[0], edges[e].b[1], edges[e].b[2]);
  float ratio = level_ratio(a, b), along = share * float(edge_split);
  int piece = min(int(along), edge_split - 1);
  float u = along - float(piece);
  s = max(s, 1);
  int level = min(int(log(s) / ratio), plane_levels);
  int a0 = first_plane + plane_row(e, edge_split) + piece * (plane_levels + 2) + level, b0 = a0 + plane_levels + 2;
  float s0 = exp(float(level) * ratio), nearer, at_a, at_b;
  if (level < plane_levels) {
    float s1 = exp(float(level + 1) * ratio);
    nearer = clamp((s1 - s) / (s1 - s0), 0, 1);
    at_a = s * (1 - u) / s0;
    at_b = s * u / s1;
  } else {
    nearer = s0 / s;
    at_a = 1 - u;
    at_b = u;
  }
  return at_a <= nearer ? mix_values(ivec3(a0, b0, b0 + 1), vec3(at_a, nearer - at_a, 1 - nearer))
                        : mix_values(ivec3(a0, a0 + 1, b0 + 1), vec3(nearer, 1 - nearer - at_b, at_b));
}

// Linear over a triangle of a mesh.
vec3 gamma_on_triangle(ivec4 corners, dvec3 point) {
  dvec3 a = mesh_vertex(corners.x), ab = mesh_vertex(corners.y) - a, ac = mesh_vertex(corners.z) - a, ap = point - a;
  dvec3 n = cross(ab, ac);
  double all = dot(n, n), v = dot(cross(ap, ac), n) / all, w = dot(cross(ab, ap), n) / all;
  return mix_values(corners.xyz, vec3(1 - v - w, v, w));
}
#endif

// `state.unfinished` on return: there are more crossings. `m_end`: m where the ray ends.
vec3 airlight_of(Ray ray, double end, int primitive, int m_origin, inout State state, out int m_end, out int parts) {
  dvec2 domain = dvec2(0, end);
  double entry = 1e300LF;  // nothing that is sorted in front of it is drawn: there the stencil becomes 255
#if PAPER_MEDIUM
  domain = domain_of(ray, end);
  if (domain.y > domain.x && domain.x > 0) {
    dvec3 corners[3];
    ivec3 numbers;
    vec3 weight;
    locate_on_boundary(ray.origin + domain.x * ray.direction, corners, numbers, weight);
    entry = dot(normalize((corners[0] + corners[1] + corners[2]) / 3 - light), -normalize(ray.to_light));
  }
#endif
#if VERTICES && BOUNDED
  // From where the ray enters the first medium to where it leaves the last: Gamma is constant elsewhere.
  if (media_end != 0) {
    domain = dvec2(1e37LF, 0);
    for (int k = 0; k < media_count; ++k) {
      dvec2 inside = clip_to_region(k, ray.origin, ray.direction, dvec2(0, end));
      if (inside.y > inside.x) domain = dvec2(min(domain.x, inside.x), max(domain.y, inside.y));
    }
  }
#endif
  stencil_end = domain.y;
  parts = 0;
  m_end = m_origin;
  int stencil = state.m;
  bool more = false;
  hit_count = 0;
#if CROSSINGS
  more = gather(ray, end, state.last_key, state.last_origin);
  m_end = m_origin + crossing_sum;
  if (resume == 0) stencil = m_origin + stencil_sum;
#endif
#if SHADOWS == 0
  stencil = hit_count = 0;
  more = false;
#endif
  state.unfinished = 0;
  if (!(domain.y > domain.x)) return state.sum.rgb;
  for (int e = resume == 0 ? -1 : 0; e < hit_count; ++e) {
    float share = 0;
    double place = domain.y;
    int edge = -1;
    if (e < 0) {  // stage 3: where the ray leaves the air or ends
      if (stencil == 0) share = 1;
    } else {  // stage 5: each plane adds or takes away all light in front of it
      if (hit_key[e] >= entry) {
        more = false;
        break;
      }
      place = hit_place[e];
      edge = hit_edge[e];
      if (place >= domain.y) continue;
#if PAPER_MEDIUM
      if (edge >= 0 && left_out[edge] != 0) continue;
#endif
      if (hit_change[e] > 0 && stencil == hit_change[e]) share = 1;
      if (hit_change[e] < 0 && stencil == 0) share = -1;
      stencil = max(0, stencil - hit_change[e]);
    }
    if (share == 0) continue;
#if VERTICES && BOUNDED
    if (media_end != 0 && e >= 0 && place <= domain.x) continue;
#endif
    ++parts;
    bool by_pixel = true;
    vec3 gamma;
#if VERTICES
    if (edge >= 0) {
      gamma = gamma_on_plane(edge, float(hit_share[e]), float(hit_times[e]));
      by_pixel = false;
    }
    if (e < 0) {
#if PAPER_MEDIUM
      if (domain.y < end) {
        dvec3 corners[3];
        ivec3 numbers;
        vec3 weight;
        locate_on_boundary(ray.origin + domain.y * ray.direction, corners, numbers, weight);
        gamma = mix_values(first_boundary + numbers, weight);
        by_pixel = false;
      }
#endif
      if (by_pixel && primitive >= 0 && primitive < triangle_count) {
        gamma = gamma_on_triangle(triangles[primitive], ray.origin + end * ray.direction);
        by_pixel = false;
      }
    }
#endif
    if (by_pixel) gamma = intensity * lit_airlight(ray, 0, place);
    state.sum.rgb += share * gamma;
    if (frame_buffer != 0) state.sum.rgb = clamp(floor(state.sum.rgb * 255 + 0.5) / 255, vec3(0), vec3(1));
  }
  state.m = stencil;
  state.unfinished = int(more);
  return state.sum.rgb;
}
