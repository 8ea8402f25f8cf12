// Source radiance of the nodes with smoke towards the camera: LitGrid::towards.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/camera.glsl"
#include "common/phase.glsl"
#include "common/spherical_harmonics.glsl"
layout(std430, binding = AT_COLUMNS) readonly buffer Columns { float columns[]; };      // [direction][node, m]
layout(std430, binding = AT_POWERS) readonly buffer Powers { vec4 powers[]; };
layout(std430, binding = AT_TOWARDS_LIGHT) readonly buffer TowardsLight { vec4 towards_light[]; };
layout(std430, binding = AT_NODES) readonly buffer Nodes { int nodes[]; };
layout(std430, binding = AT_SINGLE) readonly buffer Single { float single_source[]; };  // [light][band][cell]
layout(std430, binding = AT_RESULT) readonly buffer Result { float result[]; };
layout(std430, binding = AT_RADIANCE) writeonly buffer Radiance { vec4 radiance[]; };   // by cell
layout(std430, binding = AT_GREATEST) buffer Greatest { uint greatest; };               // bits
uniform int node_count, directions, fixed_directions, cells, levels, phase_kind, has_again;
uniform float phase_g, band_moment[LEVELS + 1];  // of the phase function, and a 0
uniform int light_of[3];                     // of each channel
uniform vec3 sigma_t, albedo, corner;
uniform float cell_edge;
uniform vec3 cells_along;  // each axis

// Sum of (2l+1)/(4 pi) moment_l P_l(c) [1/sr]. An iteration takes two bands: 2048 directions with 32 bands each would exceed llvmpipe's
// limit on loops.
float phase_in_bands(float c) {
  float even = 1, odd = c, sum = 0;
  for (int l = 0; l < levels; l += 2) {
    sum += float(2 * l + 1) * band_moment[l] * even + float(2 * l + 3) * band_moment[l + 1] * odd;
    even = (float(2 * l + 3) * c * odd - float(l + 1) * even) / float(l + 2);
    odd = (float(2 * l + 5) * c * even - float(l + 2) * odd) / float(l + 3);
  }
  return sum * per_sphere;
}

float again_of(int light, int band, int cell) {
  int at = (light * BANDS + band) * cells + cell;
  return result[at] - single_source[at];
}
vec3 again_of(int band, int cell) {
  return vec3(again_of(light_of[0], band, cell), again_of(light_of[1], band, cell), again_of(light_of[2], band, cell));
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= node_count) return;
  int cell = nodes[i];
  ivec3 size = ivec3(cells_along);
  vec3 place = corner + cell_edge * (vec3(cell % size.x, cell / size.x % size.y, cell / (size.x * size.y)) + 0.5);
  vec3 way = camera_position - place;
  float far = length(way);
  vec3 outwards = perspective == 0 || !(far > 0) ? -camera_forward : way / far;
  vec3 sum = vec3(0);
  for (int k = 0; k < directions; ++k) {
    vec3 light = towards_light[k].xyz;
    float phase;
    if (k < fixed_directions) {
      phase = phase_in_bands(clamp(-dot(light, outwards), -1.0, 1.0));
    } else {
      vec3 a = light + outwards, b = light - outwards;  // 1 - c and 1 + c for c = -dot, each with its own digits
      phase = phase_value(phase_kind, phase_g, 0.5 * dot(a, a), 0.5 * dot(b, b));
    }
    sum += powers[k].rgb * exp(-min(sigma_t * columns[k * node_count + i], vec3(200))) * phase;
  }
  sum *= albedo;
  if (has_again != 0) {
    vec3 again = vec3(0);
    for (ShPair y = first_pair(outwards); y.m < sh_order; next_pair(y, outwards)) {
      int middle = y.l * (y.l + 1);
      again += y.plus * again_of(middle + y.m, cell) + y.minus * again_of(middle - y.m, cell);
    }
    sum += again;
  }
  sum = max(sum, vec3(0));
  radiance[cell] = vec4(sum, 0);
  atomicMax(greatest, floatBitsToUint(max(sum.r, max(sum.g, sum.b))));  // positive floats are in the order of their bits
}
