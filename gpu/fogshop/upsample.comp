// Airlight and depth of the film from those of the low pixels: methods/fogshop/low_resolution.cpp. Marks the edges too.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;

layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };
layout(std430, binding = AT_PIXELS) writeonly buffer Pixels { vec4 pixels[]; };
layout(std430, binding = AT_EDGES) writeonly buffer Edges { int edge_of[]; };
layout(std430, binding = AT_LOW_PIXELS) readonly buffer LowPixels { vec4 low_pixels[]; };
layout(std430, binding = AT_LOW_DISTANCES) readonly buffer LowDistances { float low_distances[]; };
uniform int width, height, low_width, low_height, factor;
uniform int find_edges;  // 0: bilinear everywhere
uniform float open_distance;  // [m] of rays that nothing ends
#include "common/far_away.glsl"
const float edge_ratio = 1.1, black = 1e30;

float ended(float t) { return t < far_away ? t : open_distance; }

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= width || pixel.y >= height) return;
  int i = pixel.y * width + pixel.x;
  vec2 at = (vec2(pixel) + 0.5) / float(factor) - 0.5, f = at - floor(at);
  ivec2 lo = ivec2(floor(at)), last = ivec2(low_width, low_height) - 1;
  ivec2 a = clamp(lo, ivec2(0), last), b = clamp(lo + 1, ivec2(0), last);
  int place[4] = int[4](a.y * low_width + a.x, a.y * low_width + b.x, b.y * low_width + a.x, b.y * low_width + b.x);
  float weight[4] = float[4]((1 - f.x) * (1 - f.y), f.x * (1 - f.y), (1 - f.x) * f.y, f.x * f.y);

  if (find_edges != 0) {
    float here = ended(distances[i]), least = here, most = here;
    int reach = factor / 2;
    for (int y = max(0, pixel.y - reach); y <= min(height - 1, pixel.y + reach); ++y)
      for (int x = max(0, pixel.x - reach); x <= min(width - 1, pixel.x + reach); ++x) {
        float t = ended(distances[y * width + x]);
        least = min(least, t);
        most = max(most, t);
      }
    for (int k = 0; k < 4; ++k) {
      float t = ended(low_distances[place[k]]);
      least = min(least, t);
      most = max(most, t);
    }
    bool edge = most > edge_ratio * least;
    edge_of[i] = edge ? 1 : 0;
    if (edge) {
      int best = 0;
      for (int k = 1; k < 4; ++k) {
        float off = abs(ended(low_distances[place[k]]) - here), so_far = abs(ended(low_distances[place[best]]) - here);
        if (off < so_far || (off == so_far && weight[k] > weight[best])) best = k;
      }
      for (int k = 0; k < 4; ++k) weight[k] = k == best ? 1 : 0;
    }
  }
  vec4 sum = vec4(0);
  for (int k = 0; k < 4; ++k) {
    vec4 low = low_pixels[place[k]];
    sum += weight[k] * vec4(low.rgb, min(low.a, black));
  }
  pixels[i] = sum;
}
