// The smoke along a ray: a sum of Gaussians, each where it is above nothing, or a voxel grid,
// cut off by a region. Places relative to the middle of the smoke.
#include "compensated_ray_marching/smoke_region.glsl"
#if GAUSSIANS
struct Gaussian {
  vec3 center;     // [m]
  float width;     // [m]
  float amplitude; // [-]
  float unused[3];
};
layout(std430, binding = AT_DENSITY) readonly buffer Density { Gaussian gaussians[]; };
uniform int gaussian_count;
uniform float farthest;  // widths beyond which a Gaussian is nothing, squared

// The stretch of the ray [x, y] in which a Gaussian is above nothing; x > y: none. `widths2` squared.
vec2 within(Gaussian g, float widths2, vec3 origin, vec3 direction, out float nearest, out float aside) {
  vec3 offset = g.center - origin;
  nearest = dot(offset, direction);
  vec3 across = (offset - nearest * direction) / g.width;
  aside = dot(across, across);
  if (!(aside < widths2) || g.amplitude == 0) return vec2(1, -1);
  float reach = g.width * sqrt(widths2 - aside);
  return nearest + vec2(-reach, reach);
}
#else
layout(std430, binding = AT_DENSITY) readonly buffer Density { float voxels[]; };  // x fastest
uniform vec3 samples_along;  // each axis
uniform mat3 to_samples;     // of directions
uniform vec3 middle_sample;  // of the place that others are relative to
uniform float border;        // of the support around the samples [samples]

vec3 sample_at(vec3 x) { return to_samples * x + middle_sample; }
float voxel(ivec3 i) {
  ivec3 samples = ivec3(samples_along);
#if CLAMPED
  i = clamp(i, ivec3(0), samples - 1);
#else
  if (any(lessThan(i, ivec3(0))) || any(greaterThanEqual(i, samples))) return 0;
#endif
  return voxels[i.x + samples.x * (i.y + samples.y * i.z)];
}
float density_at(vec3 x) {
  vec3 s = sample_at(x);
  if (any(lessThan(s, vec3(-border))) || any(greaterThan(s, samples_along - 1 + border))) return 0;
  vec3 low = floor(s), share = s - low;
  ivec3 i = ivec3(low);
  vec4 near = vec4(voxel(i), voxel(i + ivec3(1, 0, 0)), voxel(i + ivec3(0, 1, 0)), voxel(i + ivec3(1, 1, 0)));
  vec4 beyond = vec4(voxel(i + ivec3(0, 0, 1)), voxel(i + ivec3(1, 0, 1)), voxel(i + ivec3(0, 1, 1)), voxel(i + ivec3(1, 1, 1)));
  vec4 plane = mix(near, beyond, share.z);
  return mix(mix(plane.x, plane.y, share.x), mix(plane.z, plane.w, share.x), share.y);
}
#endif
