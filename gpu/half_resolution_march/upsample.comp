// From blocks to film pixels: upsampled of reference/half_resolution_march/filter.cpp. Leaves pixels as the ray marcher's composition
// reads them; the first pixel of a block has what the block's march counted.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/far_away.glsl"
#include "half_resolution_march/blocks.glsl"
#include "ray_marcher/pixel.glsl"

layout(std430, binding = AT_LOW) readonly buffer Low { LowPixel low[]; };
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };
uniform int has_distances;      // 0: nothing ends rays
uniform int rows, first_row;    // of the band
uniform int nearest_depth;
uniform float upsample_edges;   // filter.h
const float same_depth = 1e-6;  // low_film.h
const float same_weight = 1e-6;  // filter.cpp

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= width || at.y >= rows) return;
  int pixel = at.y * width + at.x;
  at.y += first_row;
  float depth = far_away;
  if (has_distances != 0) {
    vec3 origin, direction;
    camera_ray(vec2(at) + 0.5, origin, direction);
    float t = distances[at.y * width + at.x];
    if (t < far_away) depth = t * dot(direction, camera_forward);
  }
  Neighbours across = neighbours_at(float(at.x) + 0.5, width, block_columns),
             down = neighbours_at(float(at.y) + 0.5, height, block_rows);
  float sum = 0, least = far_away, most_weight = -1, slack = depth >= far_away ? 0 : same_depth * depth;
  vec3 airlight = vec3(0), transmittance = vec3(0);
  int nearest = 0;
  for (int k = 0; k < 4; ++k) {
    bool right = (k & 1) != 0, below = k > 1;
    int place = (below ? down.second : down.first) * block_columns + (right ? across.second : across.first);
    float weight = (right ? across.share : 1 - across.share) * (below ? down.share : 1 - down.share);
    airlight += weight * low[place].airlight;
    transmittance += weight * low[place].transmittance;
    float apart = depth_difference(depth, low[place].depth);
    sum += min(apart, 0.2 * far_away);
    if (k > 0 && (apart > least + slack || (apart >= least - slack && weight <= most_weight * (1 + same_weight)))) continue;
    nearest = place;
    least = apart;
    most_weight = weight;
  }
  if (nearest_depth != 0 && sum > upsample_edges * edge_length()) {
    airlight = low[nearest].airlight;
    transmittance = low[nearest].transmittance;
  }
  Pixel result = Pixel(airlight, 0u, transmittance, 0u, 0u, 0u, 0, 0, 0, 0, 0, 0);
  if (at % divide == ivec2(0)) {
    Block block = blocks[(at.y / divide) * block_columns + at.x / divide];
    result.steps = block.points;
    result.shadow_rays = block.look_ups;
    result.occlusion_rays = block.occlusion_rays;
  }
  pixels[pixel] = result;
}
