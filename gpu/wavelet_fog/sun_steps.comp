// A map of columns towards a sun (methods/wavelet_fog/sun_map.h): what lies between two entries of a row, an invocation each, and the
// fogmap's own value at the first.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#define VALUES_ACCESS readonly
double segment_base = 0;
#define FALL_BASE segment_base
#define FALL_SCALE (1 / sun_climb[0])
#define SUN_MAP_ACCESS writeonly
#include "wavelet_fog/grids.glsl"
#include "wavelet_fog/fog.glsl"
#include "wavelet_fog/sun_map.glsl"
#include "wavelet_fog/walk.glsl"

float value_at(Grid g, dvec2 x) {
  dvec2 corner = floor(x);
  ivec2 cell = ivec2(corner), index = cell - lo_of(g);
  if (any(lessThan(index, ivec2(0))) || any(greaterThanEqual(index, size_of(g) + DEGREE))) return 0;
  return in_cell(cell_at(place_of(g, cell), g.stride), vec2(x - corner));
}

void main() {
  int c = int(gl_GlobalInvocationID.x), row = int(gl_GlobalInvocationID.y);
  if (c >= sun_columns[0] || row >= sun_rows[0]) return;
  double q = sun_lo_q[0] + row * sun_step, start = c * sun_step;
  dvec2 along = dvec2(sun_along_u[0], sun_along_v[0]);
  Line line = Line(sun_lo_p[0] * along + q * dvec2(-along.y, along.x), along, 0, 1);
  Grid map = grids[0];
  dvec2 t = clip_to_support(map, line, dvec2(start, start + sun_step));
  vec3 sum = vec3(0);
  if (c + 1 < sun_columns[0] && t.y > t.x) {
    float length_ = float(t.y - t.x);
    sum.x = walk(map, line, t.x, length_, Factor(1, 0, false), 1e37);
    if (PROFILE == PROFILE_LAYERS) sum.y = walk(map, line, t.x, length_, Factor(-start, 1, false), 1e37);
    segment_base = start;
    sum.z = sum.x;
    if (PROFILE == PROFILE_EXPONENTIAL && sun_climb[0] > 0) sum.z = walk(map, line, t.x, length_, Factor(1, 0, true), 1e37);
  }
  sun_map[sun_first[0] + row * sun_columns[0] + c] = vec4(sum, value_at(map, line.start + start * along));
}
