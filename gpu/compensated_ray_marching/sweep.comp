// One plane of every direction's sweep, each along the axis that it crosses fastest: DiscreteOrdinates::sweep. Parabolic sources in the
// optical depth between planes; beyond the box nothing absorbs, no light comes in, and the source goes on.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "compensated_ray_marching/smoke_state.glsl"
#include "compensated_ray_marching/scatterer.glsl"
struct Way {
  int axis, forward;
  float step;         // to the plane before [m]
  float down, along;  // where the ray comes from there: rows, and along them [cells]
  float unused[3];
};
layout(std430, binding = AT_DENSITIES) readonly buffer Densities { float densities[]; };  // of the cells
layout(std430, binding = AT_EMITTED) readonly buffer Emitted { float emitted[]; };        // [direction][light of the solve][cell]
layout(std430, binding = AT_LIGHT) buffer Light { float light[]; };                       // radiance, [direction][light of the solve][cell]
layout(std430, binding = AT_WAYS) readonly buffer Ways { Way ways[]; };
layout(std430, binding = AT_OPEN) readonly buffer Open { uint open[]; };                  // [32 directions][cell]: open_ways
uniform int has_objects;
uniform vec3 cells_along;  // each axis
uniform int plane;  // from where the ray comes in

// Four nodes around a place of a plane, and their weights; `within` is 0 where a node lies beyond the plane's rows.
struct Meeting {
  ivec4 at;
  vec4 weight, within;
};
Meeting meeting(ivec2 place, vec2 offset, int start, ivec2 stride, ivec2 extent) {
  ivec2 low = place + ivec2(offset.x < 0 ? -1 : 0, offset.y < 0 ? -1 : 0);
  vec2 share = offset - vec2(low - place);
  Meeting m;
  m.weight = vec4((1 - share.x) * (1 - share.y), (1 - share.x) * share.y, share.x * (1 - share.y), share.x * share.y);
  for (int i = 0; i < 4; ++i) {
    ivec2 node = low + ivec2(i / 2, i % 2), known = clamp(node, ivec2(0), extent - 1);
    m.at[i] = start + known.x * stride.x + known.y * stride.y;
    m.within[i] = node == known ? 1 : 0;
  }
  return m;
}
float density_at(Meeting m) {
  return dot(m.weight * m.within, vec4(densities[m.at.x], densities[m.at.y], densities[m.at.z], densities[m.at.w]));
}
float emitted_at(Meeting m, int from) {
  return dot(m.weight, vec4(emitted[from + m.at.x], emitted[from + m.at.y], emitted[from + m.at.z], emitted[from + m.at.w]));
}

// Integrals of x^k exp(-x t) t over x in [0, 1], k = 0, 1, 2: a series where differences would cancel.
vec3 source_integrals(float t, float passed) {
  if (t >= 1) return vec3(1 - passed, (1 - (1 + t) * passed) / t, (2 - (2 + t * (2 + t)) * passed) / (t * t));
  vec3 sum = vec3(0);
  float term = t;
  for (int j = 0; j < 10; ++j) {
    sum += term / vec3(j + 1, j + 2, j + 3);
    term *= -t / float(j + 1);
  }
  return sum;
}

void main() {
  ivec3 size = ivec3(cells_along);
  int which = int(gl_GlobalInvocationID.z), l = which % lights;
  ivec2 place = ivec2(gl_GlobalInvocationID.yx);  // row, along it
  if (done != 0) return;
  Way way = ways[which / lights];
  ivec3 of_axis = ivec3(1, size.x, size.x * size.y);
  int rows_axis = way.axis == 2 ? 1 : 2, along_axis = way.axis == 0 ? 1 : 0, planes = size[way.axis];
  ivec2 extent = ivec2(size[rows_axis], size[along_axis]), stride = ivec2(of_axis[rows_axis], of_axis[along_axis]);
  if (plane >= planes || place.x >= extent.x || place.y >= extent.y) return;
  bool first = plane == 0, last = plane + 1 == planes;
  int cells = size.x * size.y * size.z, from = which * cells;
  int start = (way.forward != 0 ? plane : planes - 1 - plane) * of_axis[way.axis];
  int on = way.forward != 0 ? of_axis[way.axis] : -of_axis[way.axis];
  int at = start + place.x * stride.x + place.y * stride.y;
  vec2 offset = vec2(way.down, way.along);
  float sigma = sigma_t[channel[l]], here = emitted[from + at], extinct = densities[at], up = here, down = here, before = 0;
  float depth = extinct, beyond = extinct;
  if (!last) {
    Meeting m = meeting(place, -offset, start + on, stride, extent);
    beyond += density_at(m);
    down = emitted_at(m, from);
  }
  if (first) {  // at the face, half a step away
    up = max(1.5 * here - 0.5 * down, min(here, 0.0));
  } else {
    Meeting m = meeting(place, offset, start - on, stride, extent);
    depth += density_at(m);
    up = emitted_at(m, from);
    bool passes = has_objects == 0 || (open[(which / lights / 32) * cells + at] >> (which / lights % 32) & 1u) != 0;
    vec4 there = vec4(light[from + m.at.x], light[from + m.at.y], light[from + m.at.z], light[from + m.at.w]);
    if (passes) before = dot(m.weight * m.within, there);
  }
  depth *= 0.5 * way.step * sigma;
  beyond = max(beyond * 0.5 * way.step * sigma, 1e-6 * depth + 1e-30);
  float passed = exp(-min(depth, 200.0));
  vec3 i = source_integrals(depth, passed);
  // A parabola through the three sources, as a Bezier curve whose middle point stays between its ends.
  float middle = here + 0.5 * (beyond * (up - here) + depth * (depth / beyond) * (here - down)) / (depth + beyond);
  middle = clamp(middle, min(up, here), max(up, here));
  light[from + at] = before * passed + here * (i.x - 2 * i.y + i.z) + up * i.z + middle * (2 * (i.y - i.z));
}
