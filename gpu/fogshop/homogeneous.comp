// A constant medium alone, where both variants are Eq. 17.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/angle.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/light.glsl"
#include "fogshop/light_lookup.glsl"

layout(std430, binding = 3) readonly buffer Distances { float distances[]; };
layout(std430, binding = 6) writeonly buffer Pixels { vec4 pixels[]; };
uniform int has_distances;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= width || pixel.y >= height) return;
  vec3 origin, direction;
  camera_ray(vec2(pixel) + 0.5, origin, direction);
  float end = has_distances != 0 ? distances[pixel.y * width + pixel.x] : far_away;
  vec3 airlight = vec3(0);
  for (int l = 0; l < light_count; ++l)
    airlight += lights[l].intensity * homogeneous_airlight(light_from_ray(lights[l], origin, direction), end);
  pixels[pixel.y * width + pixel.x] = vec4(airlight * albedo, constant * end);
}
