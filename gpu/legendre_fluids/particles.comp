// Moves particles of one set over a step of the flow that carries them, one to an invocation (scene/flow/flow_particles.cpp).
// Places are in double precision, velocities in single.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/loops_cut.glsl"
#include "legendre_fluids/philox.glsl"
layout(std430, binding = AT_START) readonly buffer Start { float before[]; };  // coefficients before the step and after it, of fields.glsl
layout(std430, binding = AT_STATE) readonly buffer State { float after[]; };
layout(std430, binding = AT_PARTICLES) buffer Particles { dvec4 particles[]; };  // place [m], how often it has been drawn anew
uniform int first, count, leaving;
uniform float seed_low, seed_high;  // of the set, 16 bits each
uniform dvec3 fall, low, size;      // [m/s], of the box [m]
uniform double dt;                  // [s]
#if WIND
uniform vec3 winds[2];  // in the middle of the box, before the step and after it [half sizes per second]
uniform mat3 wind_slopes;
#endif
#define SLAB (N * NZ)
#define SIZE (N * SLAB)
const int wraps = 1, respawns = 2;          // ParticleSet::Leaving
const uint respawned = 1u << 16;            // FlowParticles: numbers of draws before are of places in a region

// The flow's velocity [m/s] at a place, `share` of the way between its two states; outside the box that of the nearest place.
dvec3 velocity(dvec3 place, float share) {
  vec3 at = vec3(0);
  for (int a = 0; a < D; ++a) at[a] = float(clamp(2 * (place[a] - low[a]) / size[a] - 1, -1.0LF, 1.0LF));
  float along[3 * N], walls[3 * N];  // L_i; phi_i, the integral of L_i from -1
  for (int a = 0; a < D; ++a) {
    float before_ = 0, p = 1;
    for (int i = 0; i < N; ++i) {
      float next = (float(2 * i + 1) * at[a] * p - float(i) * before_) / float(i + 1), norm = sqrt(float(i) + 0.5);
      along[a * N + i] = norm * p;
      walls[a * N + i] = (next - before_) / (2 * norm);
      before_ = p, p = next;
    }
  }
  vec3 u = vec3(0);
  for (int a = 0; a < D; ++a) {
    int from = a * SIZE;
    for (int i = 0; i < N; ++i) {
      float plane = 0;
      for (int j = 0; j < N; ++j) {
        float line = 0;
        for (int k = 0; k < NZ; ++k, ++from) {
          float c = share <= 0 ? before[from] : share >= 1 ? after[from] : mix(before[from], after[from], share);
          line += c * (D == 2 ? 1 : CONFINED != 0 && a == 2 ? walls[(D - 1) * N + k] : along[(D - 1) * N + k]);
        }
        plane += line * (CONFINED != 0 && a == 1 ? walls[N + j] : along[N + j]);
      }
      u[a] += plane * (CONFINED != 0 && a == 0 ? walls[i] : along[i]);
    }
  }
#if WIND
  u += mix(winds[0], winds[1], share) + wind_slopes * at;
#endif
  return 0.5LF * size * dvec3(u) + fall;
}

// x with another place along one axis. NVIDIA's compiler (driver 580) links no shader that writes a dvec3 by a variable index.
dvec3 with_axis(dvec3 x, int axis, double place) { return mix(x, dvec3(place), equal(ivec3(0, 1, 2), ivec3(axis))); }

void let_leave(int i, inout dvec3 x, inout double times) {
  for (int a = 0; a < D; ++a) {
    if (x[a] >= low[a] && x[a] <= low[a] + size[a]) continue;
    if (leaving == wraps || leaving == respawns) {
      double beyond = (x[a] - low[a]) / size[a];
      x = with_axis(x, a, low[a] + size[a] * (beyond - floor(beyond)));
    }
    if (leaving == respawns) {
      times += 1;
      uint seed = uint(seed_low) | uint(seed_high) << 16;
      dvec3 share = random_shares(seed, uint(i), uint(times) + respawned);
      x = with_axis(low + size * share, a, x[a]);
    }
    x = with_axis(x, a, clamp(x[a], low[a], low[a] + size[a]));
  }
}

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i >= count) return;
  dvec3 x = particles[first + i].xyz, slope = dvec3(0), sum = dvec3(0);
  double times = particles[first + i].w;
  for (int stage = 0; stage < 4; ++stage) {
    float share = stage == 0 ? 0 : stage == 3 ? 1 : 0.5;
    slope = velocity(x + share * dt * slope, share);
    sum += (stage == 1 || stage == 2 ? 2 : 1) * slope;
  }
  x += dt / 6 * sum;
  let_leave(i, x, times);
  if (loops_cut()) x = dvec3(uintBitsToFloat(0x7fc00000u));  // no place, rather than a wrong one
  particles[first + i] = dvec4(x, times);
}
