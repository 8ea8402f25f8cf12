// The ray of each block, and where it ends: block_ray of reference/half_resolution_march/passes.cpp.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/far_away.glsl"
#include "half_resolution_march/blocks.glsl"

// Where the rays of film pixels end, or those through the middles of blocks [m along the ray].
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };
uniform int has_distances;  // 0: nothing ends rays
uniform int of_blocks;      // 1: distances are those of blocks
const float same_depth = 1e-6;  // low_film.h

float depth_at(vec2 film, float t) {
  if (t >= far_away) return far_away;
  vec3 origin, direction;
  camera_ray(film, origin, direction);
  return t * dot(direction, camera_forward);
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= block_columns || at.y >= block_rows) return;
  int place = at.y * block_columns + at.x;
  if (place == 0) {
    longest_bits = 0u;
    history_used = 0u;
    history_rejected = 0u;
    history_clamped = 0u;
  }
  vec2 film = vec2(block_center(at.x, width), block_center(at.y, height));
  float t = far_away, depth = far_away;
  if (has_distances != 0 && of_blocks != 0) {
    t = distances[place];
    depth = depth_at(film, t);
  } else if (has_distances != 0) {
    ivec2 begin = at * divide, end = min(begin + divide, ivec2(width, height)), least = begin, most = begin;
    float near = depth_at(vec2(begin) + 0.5, distances[begin.y * width + begin.x]), far = near;
    for (int j = begin.y; j < end.y; ++j)
      for (int i = begin.x; i < end.x; ++i) {
        float here = depth_at(vec2(i, j) + 0.5, distances[j * width + i]);
        if (here < near * (1 - same_depth)) near = here, least = ivec2(i, j);
        if (here > far * (1 + same_depth)) far = here, most = ivec2(i, j);
      }
    depth = near;
    if (depth_difference(near, far) > same_depth * near) {
      bool nearest = ((at.x + at.y) & 1) == 0;
      ivec2 pixel = nearest ? least : most;
      film = vec2(pixel) + 0.5;
      depth = nearest ? near : far;
      t = distances[pixel.y * width + pixel.x];
    } else if (near < far_away) {
      vec3 origin, direction;
      camera_ray(film, origin, direction);
      t = near / dot(direction, camera_forward);
    }
  }
  blocks[place].film = film;
  blocks[place].depth = depth;
  blocks[place].t_end = t;
}
