// Optical depth of the Gaussians between a light and a point, from those alone that rays of its direction may meet
// (fogshop/light_lists.comp). After fog.glsl and light.glsl.
#include "fogshop/light_cells.glsl"
// Where the list of each cell of each light begins, and the last one ends; then the lists.
layout(std430, binding = AT_LIGHT_LISTS) readonly buffer LightLists { int light_list[]; };

float depth_from_light(int light, vec3 point) {
  vec3 from = lights[light].position, way = point - from;
  float length_ = length(way), sum = 0;
  if (cells == 0 || !(length_ > 0)) return 0;
  vec3 direction = way / length_;
  int cell = cell_of(light, direction);
  for (int i = light_list[cell], end = light_list[cell + 1]; i < end; ++i)
    sum += depth_between(gaussians[light_list[i]], from, direction, length_);
  return sum;
}
