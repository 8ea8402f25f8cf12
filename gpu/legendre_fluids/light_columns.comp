// Columns of each medium towards the light from the Gauss points of each ray's stretch, a point to an invocation.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "raster/view.glsl"
#include "common/loops_cut.glsl"
#include "legendre_fluids/light_media.glsl"
layout(std430, binding = AT_REACHED) readonly buffer Reached { double reached[]; };
layout(std430, binding = AT_STRETCHES) readonly buffer Stretches { dvec2 stretches[]; };  // of light_cut.comp
layout(std430, binding = AT_WAYS) writeonly buffer Ways { float ways[]; };                // [ray][medium][point] [m]

void main() {
  int point = int(gl_GlobalInvocationID.x) % (MEDIA * SERIES);
  ivec2 pixel = ivec2(int(gl_GlobalInvocationID.x) / (MEDIA * SERIES), int(gl_GlobalInvocationID.y));
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int m = point / SERIES, q = point % SERIES, place = pixel.y * view_width + pixel.x;
  double last = reached[place], next = stretches[place].x;
  if (next >= nowhere || next < 0) return;
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  dvec3 local = (origin + 0.5LF * (last + next) * direction - box_middle[m]) * per_half[m];
  vec3 rate = vec3(to_light * per_half[m]), slope = vec3(0.5LF * (next - last) * direction * per_half[m]);
  Way way = way_from(local, rate);
  float column = column_from(m, vec3(local) + rule[RULE_NODES + q / 4][q % 4] * slope, rate, way);
  ways[place * MEDIA * SERIES + point] = loops_cut() ? uintBitsToFloat(0x7fc00000u) : column;
}
