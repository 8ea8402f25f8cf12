// A table of integrals from the eye (methods/wavelet_fog/polar_table.h): what lies between two entries of a spoke, an invocation each,
// and the map's own value at the second.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#define VALUES_ACCESS readonly
#include "wavelet_fog/grids.glsl"
#include "wavelet_fog/fog.glsl"
#include "wavelet_fog/walk.glsl"
#include "common/unit_vector.glsl"
layout(std430, binding = AT_TABLE) writeonly buffer Table { double table[]; };
layout(std430, binding = AT_COUNTERS) buffer Counters { uint counters[]; };
uniform double eye_u, eye_v;  // over the map [cells]
uniform float table_middle_u, table_middle_v;  // direction in the middle of the fan, unit
uniform float table_spacing;  // [rad]
uniform float table_first;    // of spoke 0, from the middle [rad]
uniform double step_;         // [cells]
uniform int table_angles, table_steps, counts;
uniform int table_first_step;  // of entry 0, from the eye

float value_at(Grid g, dvec2 x) {
  dvec2 corner = floor(x);
  ivec2 cell = ivec2(corner), index = cell - lo_of(g);
  if (any(lessThan(index, ivec2(0))) || any(greaterThanEqual(index, size_of(g) + DEGREE))) return 0;
  return in_cell(cell_at(place_of(g, cell), g.stride), vec2(x - corner));
}

void main() {
  dvec2 eye = dvec2(eye_u, eye_v);
  int k = int(gl_GlobalInvocationID.x), angle = int(gl_GlobalInvocationID.y);
  if (k > table_steps || angle >= table_angles) return;
  dvec2 turned_ = unit_vector(double(table_first + float(angle) * table_spacing));
  dvec2 along = dvec2(table_middle_u * turned_.x - table_middle_v * turned_.y, table_middle_v * turned_.x + table_middle_u * turned_.y);
  Line line = Line(eye, along, 0, 0);
  Grid map = grids[0];
  int entry = 3 * (angle * (table_steps + 1) + k);
  dvec2 t = clip_to_support(map, line, dvec2(table_first_step + k - 1, table_first_step + k) * step_);
  vec2 sum = vec2(0);
  if (k > 0 && t.y > t.x) {
    sum.x = walk(map, line, t.x, float(t.y - t.x), Factor(1, 0, false), 1e37);
    if (counts != 0 && atomicAdd(counters[0], cells_read) > 0xffffffffu - cells_read) atomicAdd(counters[1], 1u);
#if PROFILE == PROFILE_LAYERS
    sum.y = walk(map, line, t.x, float(t.y - t.x), Factor(0, 1, false), 1e37);
#endif
  }
  table[entry] = sum.x;
  table[entry + 1] = sum.y;
  table[entry + 2] = value_at(map, eye + double(table_first_step + k) * step_ * along);
}
