// From the optical depths of a texel's steps to its floats: reference/light_map/encoding.cpp. An invocation does one texel of one
// plane, of `fourier` one coefficient of it.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "light_map/texel.glsl"

layout(std430, binding = AT_STEPS) readonly buffer Steps { float step_depth[]; };
layout(std430, binding = AT_TEXELS) writeonly buffer Texels { float texels[]; };
uniform int map_floats, map_entries;  // of a texel; slices, nodes or coefficients
uniform int first_float;              // of the map in the buffer
uniform int plane_floats;

int own, plane, texel;
float depth_of_step(int s) { return step_depth[(plane * steps + s) * texel_count + own]; }

#if MAP_ENCODING == 0
void encode() {
  float per_slice = float(steps) / float(map_entries), passed = 0;
  double depth = 0;
  int s = 0;
  for (int k = 0; k <= map_entries; ++k) {
    // The last slice ends with the last step, whatever rounding says.
    float place = k == map_entries ? float(steps) : float(k) * per_slice;
    for (; s < steps && float(s + 1) <= place; ++s) depth += double(depth_of_step(s));
    texels[texel + k] = float(s < steps ? depth + double((place - float(s)) * depth_of_step(s)) : depth);
  }
}
#elif MAP_ENCODING == 1
// Nodes so far (reference/light_map/nodes.h), kept between dispatches: their number, the end of the last step that is not empty;
// then of each its place in steps, transmittance, what it is less than at the node before, and twice the area that goes with it.
layout(std430, binding = AT_NODES) buffer Nodes { float nodes[]; };
uniform int first_step, end_step;  // of the dispatch
#define NODE(member, i) nodes[(2 + 4 * (i) + member) * stride + mine]
int stride, mine, count;

void measure(int i) {
  if (i < 1 || i > count - 2) return;
  // Differences of nearly equal transmittances would have no digits: the drops have them.
  NODE(3, i) = abs((NODE(0, i) - NODE(0, i - 1)) * NODE(2, i + 1) - (NODE(0, i + 1) - NODE(0, i)) * NODE(2, i));
}
void add(float place, float transmittance, float drop) {
  NODE(0, count) = place, NODE(1, count) = transmittance, NODE(2, count) = drop, NODE(3, count) = 1e37;
  ++count;
  measure(count - 2);
  if (count <= map_entries) return;
  int least = 1;
  for (int i = 2; i < count - 1; ++i)
    if (NODE(3, i) < NODE(3, least)) least = i;
  NODE(2, least + 1) += NODE(2, least);
  for (int i = least; i < count - 1; ++i)
    for (int member = 0; member < 4; ++member) NODE(member, i) = NODE(member, i + 1);
  --count;
  measure(least - 1);
  measure(least);
}

void encode() {
  stride = int(gl_NumWorkGroups.y) * texel_count, mine = plane * texel_count + own;
  float end = 0, depth = 0, lost = 0, transmittance = 1;
  count = 0;
  if (first_step > 0) {
    count = int(nodes[mine]), end = nodes[stride + mine];
    int last = 2 + 4 * (map_entries + 1);
    depth = nodes[last * stride + mine], lost = nodes[(last + 1) * stride + mine];
    if (count > 0) transmittance = NODE(1, count - 1);
  }
  for (int s = first_step; s < end_step; ++s) {
    float step_ = depth_of_step(s);
    if (step_ == 0) continue;
    if (count == 0 || end < float(s)) add(float(s), transmittance, 0);
    // Kahan's sum.
    precise float corrected = step_ - lost, sum = depth + corrected, back = sum - depth;
    lost = back - corrected;
    depth = sum;
    float drop = step_ > 0.125 || step_ < -0.125 ? 1 - exp(-step_)
                                                 : step_ * (1 - step_ / 2 * (1 - step_ / 3 * (1 - step_ / 4 * (1 - step_ / 5))));
    drop *= transmittance;
    transmittance = exp(-depth);
    end = float(s + 1);
    add(end, transmittance, drop);
  }
  if (end_step < steps) {
    nodes[mine] = float(count), nodes[stride + mine] = end;
    int last = 2 + 4 * (map_entries + 1);
    nodes[last * stride + mine] = depth, nodes[(last + 1) * stride + mine] = lost;
    return;
  }
  if (count == 0) add(float(steps), 1, 0);
  for (int k = 0; k < map_entries; ++k) {
    int node = min(k, count - 1);
    texels[texel + k] = NODE(0, node) / float(steps);
    texels[texel + map_entries + k] = NODE(1, node);
  }
}
#elif MAP_ENCODING == 2
layout(std430, binding = AT_WAVES) readonly buffer Waves { float waves[]; };  // of each step and coefficient
void encode() {
  int c = int(gl_GlobalInvocationID.z);
  double sum = 0;
  for (int s = 0; s < steps; ++s) sum += double(depth_of_step(s) * waves[s * map_entries + c]);
  texels[texel + c] = float(sum);
}
#else
const float empty_share = 0.01;  // reference/light_map/encoding.h
void encode() {
  double total = 0;
  float greatest = 0;
  for (int s = 0; s < steps; ++s) {
    float step_ = depth_of_step(s);
    total += double(step_);
    greatest = max(greatest, abs(step_));
  }
  int count = 0, front = steps;
  for (int s = 0; s < steps; ++s) {
    if (!(abs(depth_of_step(s)) > empty_share * greatest)) continue;
    front = min(front, s);
    ++count;
  }
  texels[texel] = float(front) / float(steps);
  texels[texel + 1] = count == 0 ? 0 : float(total) * float(steps) / float(count);
  texels[texel + 2] = float(total);
}
#endif

void main() {
  own = int(gl_GlobalInvocationID.x);
  plane = int(gl_GlobalInvocationID.y);
  if (own >= texel_count) return;
  texel = first_float + plane * plane_floats + (first_texel + own) * map_floats;
  encode();
}
