// Light and media become airlight and transmittance up to the far end of each froxel, an invocation a column: Volume::integrate of
// reference/froxel_fog.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/opacity.glsl"
#include "froxel_fog/grid.glsl"

layout(std430, binding = AT_LIGHT) readonly buffer FroxelLight { vec4 froxel_light[]; };
layout(std430, binding = AT_MEDIA) readonly buffer FroxelMedia { vec4 froxel_media[]; };
layout(std430, binding = AT_AIRLIGHT) writeonly buffer Airlight { vec4 airlight_up_to[]; };
layout(std430, binding = AT_TRANSMITTANCE) writeonly buffer Transmittance { vec4 transmittance_up_to[]; };

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= columns || at.y >= rows || slice_values[2] == 0) return;
  vec3 origin, direction;
  camera_ray(cell_size() * (vec2(at) + 0.5), origin, direction);
  float metres = 1 / depth_per_metre(direction);
  vec3 airlight = vec3(0), transmittance = vec3(1);
  for (int k = 0; k < slices; ++k) {
    int place = froxel_at(at.x, at.y, k);
    float length_ = (end_of(k + 1) - end_of(k)) * metres;
    vec3 light = froxel_light[place].rgb, extinction = froxel_media[place].rgb;
    for (int c = 0; c < 3; ++c) {
      float depth = extinction[c] > 0 ? extinction[c] * length_ : 0;
      airlight[c] += transmittance[c] * light[c] * (depth > 0 ? opacity(depth) / extinction[c] : length_);
      transmittance[c] *= exp(-depth);
    }
    airlight_up_to[place] = vec4(airlight, 0);
    transmittance_up_to[place] = vec4(transmittance, 0);
  }
}
