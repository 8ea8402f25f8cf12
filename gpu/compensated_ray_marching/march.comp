// Some slices of every camera ray: density, source radiance between nodes, composition (Zhou et al. 2008, Eq. 14, 15).
// SCATTERS: the smoke scatters something of the light.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/opacity.glsl"
#include "compensated_ray_marching/smoke_density.glsl"
layout(std430, binding = AT_RANGES) readonly buffer Ranges { vec4 ranges[]; };  // start, length of a slice [m], slices, slope
layout(std430, binding = AT_AIRLIGHT_LAYER) buffer Airlight { float airlight[]; };
layout(std430, binding = AT_COLUMN) buffer Column { float column[]; };  // so far [m]
uniform int first_slice, weight;  // as SliceWeight
uniform vec3 sigma_t;
#if VOLUME
#elif PAPER
layout(std430, binding = AT_CENTRE_SOURCES) readonly buffer CentreSources { vec4 sources[]; };  // by Gaussian
uniform float least_source_density;  // of Gaussians: below it no one knows the source
#elif SCATTERS
layout(std430, binding = AT_LOGARITHMS) readonly buffer Logarithms { vec4 logarithms[]; };  // of source radiance, by cell
uniform vec3 brightest;  // of the light, times the albedo
uniform vec3 corner;
uniform float cell_edge;
uniform vec3 cells_along;  // each axis

vec3 source_at(vec3 x) {
  ivec3 size = ivec3(cells_along);
  vec3 place = clamp((x - corner) / cell_edge - 0.5, vec3(-0.5), vec3(size) - 0.5);
  ivec3 low = min(ivec3(place), max(size - 2, ivec3(0)));
  vec3 share = place - vec3(low);
  ivec3 on = ivec3(size.x > 1 ? 1 : 0, size.y > 1 ? size.x : 0, size.z > 1 ? size.x * size.y : 0);
  int at = low.x + size.x * (low.y + size.y * low.z);
  vec4 v[8], most = vec4(-1e37);
  for (int c = 0; c < 8; ++c) {
    v[c] = logarithms[at + (c & 1) * on.x + (c >> 1 & 1) * on.y + (c >> 2) * on.z];
    most = max(most, v[c]);
  }
  vec4 low_ = mix(mix(v[0], v[1], share.x), mix(v[2], v[3], share.x), share.y);
  vec4 high = mix(mix(v[4], v[5], share.x), mix(v[6], v[7], share.x), share.y);
  return min(exp(min(mix(low_, high, share.z), most + 3).rgb), brightest);  // node_grid.cpp: steepest
}
#endif

#if VOLUME
layout(std430, binding = AT_VOLUME) readonly buffer Volume { vec4 volume[]; };  // of voxels: source times density, density

// Trilinear, as density_at.
vec4 voxel_of(ivec3 i) {
  ivec3 samples = ivec3(samples_along);
#if CLAMPED
  i = clamp(i, ivec3(0), samples - 1);
#else
  if (any(lessThan(i, ivec3(0))) || any(greaterThanEqual(i, samples))) return vec4(0);
#endif
  return volume[i.x + samples.x * (i.y + samples.y * i.z)];
}
vec4 volume_at(vec3 x) {
  vec3 s = sample_at(x);
  if (any(lessThan(s, vec3(-border))) || any(greaterThan(s, samples_along - 1 + border))) return vec4(0);
  vec3 low = floor(s), share = s - low, rest = 1 - share;
  ivec3 i = ivec3(low), samples = ivec3(samples_along);
  vec4 sum = vec4(0);
  if (all(greaterThanEqual(i, ivec3(0))) && all(lessThan(i + 1, samples))) {  // no voxel needs a test
    int at = i.x + samples.x * (i.y + samples.y * i.z), up = samples.x, back = samples.x * samples.y;
    vec4 near = vec4(rest.x * rest.y, share.x * rest.y, rest.x * share.y, share.x * share.y) * rest.z;
    vec4 far = vec4(rest.x * rest.y, share.x * rest.y, rest.x * share.y, share.x * share.y) * share.z;
    sum = near.x * volume[at] + near.y * volume[at + 1] + near.z * volume[at + up] + near.w * volume[at + up + 1] +
          far.x * volume[at + back] + far.y * volume[at + back + 1] + far.z * volume[at + back + up] + far.w * volume[at + back + up + 1];
  } else {
    for (int c = 0; c < 8; ++c) {
      ivec3 on = ivec3(c & 1, c >> 1 & 1, c >> 2);
      vec3 weight = mix(rest, share, vec3(on));
      sum += weight.x * weight.y * weight.z * voxel_of(i + on);
    }
  }
  return sum;
}
#endif

#if GAUSSIANS
#include "compensated_ray_marching/tile_gaussians.glsl"
#endif

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  bool within_film = at.x < width && at.y < height;
  int place = within_film ? at.y * width + at.x : 0;
  vec4 range = within_film ? ranges[place] : vec4(0);
  int count = int(range.z);
  bool active_ = first_slice < count;
  vec3 origin, direction;
  camera_ray(vec2(at) + 0.5, origin, direction);
  float density[SLICES];
  for (int k = 0; k < SLICES; ++k) density[k] = 0;
#if PAPER
  vec3 weighted[SLICES];
  for (int k = 0; k < SLICES; ++k) weighted[k] = vec3(0);
#endif
#if GAUSSIANS
  float from = range.x + (float(first_slice) + 0.5) * range.y, to = from + float(SLICES - 1) * range.y;
  if (!begin_tile(active_, origin, direction, vec2(from, to))) return;
  for (int turn = 0; turn * tile_lanes < gaussian_count; ++turn) {
    look_at(turn);
    if (!active_) continue;
    for (int w = 0; w < tile_words; ++w)
      for (uint left = tile_word(turn, w); left != 0u; left &= left - 1u) {
        int i = turn * tile_lanes + 32 * w + findLSB(left);
        float nearest, aside;
        vec2 part = within(gaussians[i], farthest, origin, direction, nearest, aside);
        if (!(part.x <= to && part.y >= from)) continue;
        float step = range.y / gaussians[i].width, start = (from - nearest) / gaussians[i].width;
        for (int k = 0; k < SLICES; ++k) {
          float along = start + float(k) * step, square = aside + along * along;
          float value = square < farthest ? gaussians[i].amplitude * exp(-square) : 0;
          density[k] += value;
#if PAPER
          weighted[k] += value * sources[i].rgb;
#endif
        }
      }
  }
#else
  if (active_)
    for (int k = 0; k < SLICES; ++k) {
      vec3 middle = origin + (range.x + (float(first_slice + k) + 0.5) * range.y) * direction;
#if VOLUME
      vec4 voxel = volume_at(middle);
      density[k] = voxel.a;
      weighted[k] = voxel.rgb;
#else
      density[k] = density_at(middle);
#endif
    }
#endif
  if (!active_) return;
  vec3 light = vec3(0);
  float passed = column[place];
  for (int k = 0; k < SLICES; ++k) {
    float here = density[k];
    if (first_slice + k >= count || !(here > 0)) continue;
#if !PAPER && SCATTERS
    vec3 middle = origin + (range.x + (float(first_slice + k) + 0.5) * range.y) * direction;
#endif
#if VOLUME
    vec3 source = weighted[k] / here;
#elif PAPER
    vec3 source = here >= least_source_density ? max(weighted[k] / here, vec3(0)) : vec3(0);
#elif SCATTERS
    vec3 source = source_at(middle);
#else
    vec3 source = vec3(0);
#endif
    vec3 depth = sigma_t * (here * range.y), seen;
    for (int c = 0; c < 3; ++c)
      seen[c] = weight == WEIGHT_EXACT ? opacity(min(depth[c], 200.0)) : weight == WEIGHT_PAPER ? depth[c] : depth[c] * range.w;
    light += exp(-min(sigma_t * passed, vec3(200))) * source * seen;
    passed += here * range.y;
  }
  column[place] = passed;
  for (int c = 0; c < 3; ++c) airlight[3 * place + c] += light[c];
}
