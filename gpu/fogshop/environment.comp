// Last loop of section 5.3 of Zhou et al. 2007: light of the environment scattered once (Eq. 28), added to every pixel
// whose ray nothing ends, or to all. T(v,p) is there already.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/spherical_harmonics.glsl"

layout(std430, binding = AT_PIXELS) buffer Pixels { vec4 pixels[]; };             // airlight, T(v,p)
layout(std430, binding = AT_ENVIRONMENT_LIGHT) readonly buffer Light { vec4 light[]; };      // sqrt(4 pi / (2l+1)) albedo L_lm
layout(std430, binding = AT_PSF_BANDS) readonly buffer Bands { float bands[]; };    // g_l, [depth][l]
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };
uniform int has_distances, everywhere;
#include "common/far_away.glsl"
uniform vec3 extinction_ratio;
uniform int band_depths;                         // 1: the same for every depth
uniform float log_least_depth, log_depth_range;  // of the table

float band(int l, float place) {
  if (band_depths == 1) return bands[l];
  int k = min(band_depths - 2, int(place));
  float low = bands[k * SH_ORDER + l];
  return low + (place - k) * (bands[(k + 1) * SH_ORDER + l] - low);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= width || pixel.y >= height) return;
  int index = pixel.y * width + pixel.x;
  if (everywhere == 0 && has_distances != 0 && distances[index] < far_away) return;  // something ends the ray
  vec3 origin, direction;
  camera_ray(vec2(pixel) + 0.5, origin, direction);
  // The tiny number keeps the logarithm finite; below the table's first depth the place is its first anyway.
  vec3 T = pixels[index].w * extinction_ratio, sum = vec3(0);
  vec3 place = clamp((log(max(T, 1e-30)) - log_least_depth) / log_depth_range, 0, 1) * (band_depths - 1);
  vec3 weight[SH_ORDER];
  for (int l = 0; l < sh_order; ++l) weight[l] = vec3(band(l, place.r), band(l, place.g), band(l, place.b));
  for (ShPair y = first_pair(direction); y.m < sh_order; next_pair(y, direction)) {
    int i = y.l * (y.l + 1);
    sum += weight[y.l] * (y.plus * light[i + y.m].rgb + y.minus * light[i - y.m].rgb);
  }
  pixels[index].rgb += max(sum * T * exp(-T), vec3(0));
}
