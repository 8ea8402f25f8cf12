// The volume pass, a voxel an invocation: methods/compensated_ray_marching/smoke_volume.h. Zhou et al. 2008, Eq. 15. A work group has a
// block of voxels; it looks at the Gaussians that reach into the ball around it.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y, local_size_z = LOCAL_SIZE_Z) in;
struct Gaussian {
  vec3 center;     // [samples]
  float width;     // [samples]
  float amplitude; // [-]
  float unused[3];
};
layout(std430, binding = AT_DENSITY) readonly buffer Density { Gaussian gaussians[]; };         // those with a source come first
layout(std430, binding = AT_CENTRE_SOURCES) readonly buffer CentreSources { vec4 sources[]; };  // by Gaussian
layout(std430, binding = AT_VOLUME) writeonly buffer Volume { vec4 volume[]; };                 // source times density, density
uniform int gaussian_count, source_count;
uniform float farthest;  // widths beyond which a Gaussian is nothing, squared
uniform vec3 samples_along;
uniform float residual_step, least_source_density;  // below it no one knows the source
#if RESIDUAL
#include "compensated_ray_marching/residual.glsl"
#endif

const int lanes = LOCAL_SIZE_X * LOCAL_SIZE_Y * LOCAL_SIZE_Z, words = 32;
shared uint met[words];  // of 32 words of Gaussians, a bit each

void main() {
  ivec3 size = ivec3(samples_along), at = ivec3(gl_GlobalInvocationID);
  int lane = int(gl_LocalInvocationIndex);
  vec3 block = vec3(LOCAL_SIZE_X, LOCAL_SIZE_Y, LOCAL_SIZE_Z), middle = vec3(gl_WorkGroupID) * block + 0.5 * (block - 1);
  float density = 0, weight = 0, radius = 0.5001 * length(block - 1);
  vec3 sum = vec3(0);
  for (int first = 0; first < gaussian_count; first += 32 * words) {
    barrier();
    if (lane < words) met[lane] = 0u;
    barrier();
    for (int k = lane; k < 32 * words && first + k < gaussian_count; k += lanes)
      if (length(gaussians[first + k].center - middle) < radius + 1.0001 * gaussians[first + k].width * sqrt(farthest))
        atomicOr(met[k / 32], 1u << (k % 32));
    barrier();
    for (int w = 0; w < words; ++w)
      for (uint left = met[w]; left != 0u; left &= left - 1u) {
        int i = first + 32 * w + findLSB(left);
        vec3 away = (vec3(at) - gaussians[i].center) / gaussians[i].width;
        float square = dot(away, away);
        if (square > farthest) continue;
        float value = gaussians[i].amplitude * exp(-square);
        density += value;
        if (i >= source_count) continue;
        weight += value;
        sum += value * sources[i].rgb;
      }
  }
  if (any(greaterThanEqual(at, size))) return;
  bool known = density >= least_source_density;
#if RESIDUAL
  density += residual_step * float(residual_level(at + 1));  // levels have one sample more on every side
#endif
  density = known ? max(density, 0.0) : 0;
  vec3 source = weight >= least_source_density ? max(sum / weight, vec3(0)) : vec3(0);
  volume[at.x + size.x * (at.y + size.y * at.z)] = vec4(density * source, density);
}
