// Light of the environment at the nodes of the grid (methods/fogshop/sky_volume.cpp), a node per invocation. Each dispatch
// adds some of the beams. SURFACES: they are in the way of some.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y, local_size_z = LOCAL_SIZE_Z) in;
#include "fogshop/fog.glsl"
#include "fogshop/sky_volume.glsl"

struct Beam {
  vec3 direction;  // towards the light
  float unused;
  vec3 weight;  // radiance times solid angle over 4 pi [W/m^2/sr]
  float unused_too;
};
layout(std430, binding = AT_BEAMS) readonly buffer Beams { Beam beams[]; };
uniform int first_beam, last_beam;
#if SURFACES
layout(std430, binding = AT_OPEN_BEAMS) readonly buffer OpenBeams { uint open_beams[]; };  // OpenBeams::bits
uniform int beam_words;  // of a node
#endif

// Optical depth of all Gaussians from a point to infinity.
float depth_beyond(vec3 from, vec3 direction) {
  const Place nowhere = Place(1e4, 0);
  float sum = 0;
  for (int i = 0; i < gaussian_count; ++i) {
    Gaussian g = gaussians[i];
    if (square_beside(g, from, direction) > g.radius_squared) continue;  // most, before any exponential
    Crossing c = cross_line(g, from, direction, far_away);
    if (c.met) sum += c.depth * erf_between(c.start, nowhere);
  }
  return sum;
}

void main() {
  ivec3 node = ivec3(gl_GlobalInvocationID);
  if (any(greaterThan(node, ivec3(grid_last)))) return;
  vec3 x = grid_corner + grid_cell * vec3(node), sum = vec3(0);
  for (int b = first_beam; b < last_beam; ++b) {
#if SURFACES
    if ((open_beams[node_place(node) / 3 * beam_words + b / 32] >> (b % 32) & 1u) == 0u) continue;
#endif
    sum += beams[b].weight * transmittance_of(depth_beyond(x, beams[b].direction));
  }
  int place = node_place(node);
  for (int c = 0; c < 3; ++c) node_light[place + c] += sum[c];
}
