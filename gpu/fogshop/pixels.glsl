// Pixels that a dispatch computes: those of the film, one in the middle of each block of film_step x film_step, or the edges alone
// (methods/fogshop/low_resolution.h). Depths of the results are those of T(v, p), at extinction ratio 1.
#include "common/far_away.glsl"
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // of the pixels that are computed
layout(std430, binding = AT_PIXELS) buffer Pixels { vec4 pixels[]; };                  // airlight, depth
layout(std430, binding = AT_EDGES) readonly buffer Edges { int edge_of[]; };
uniform int grid_width, grid_height, film_step, has_distances, only_edges;
uniform float open_distance;  // [m] of rays that nothing ends

int place_of(ivec2 pixel) { return pixel.y * grid_width + pixel.x; }
bool is_computed(ivec2 pixel) {
  return pixel.x < grid_width && pixel.y < grid_height && (only_edges == 0 || edge_of[place_of(pixel)] != 0);
}
vec2 film_position(ivec2 pixel) { return float(film_step) * (vec2(pixel) + 0.5); }
float ray_length(ivec2 pixel) {
  float t = has_distances != 0 ? distances[place_of(pixel)] : far_away;
  return t < far_away ? t : open_distance;
}
