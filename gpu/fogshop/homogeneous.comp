// A constant medium alone, where both variants are Eq. 17.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/angle.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/light.glsl"
#include "fogshop/light_lookup.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (!is_computed(pixel)) return;
  vec3 origin, direction;
  camera_ray(film_position(pixel), origin, direction);
  float end = ray_length(pixel);
  vec3 airlight = vec3(0);
  for (int l = 0; l < light_count; ++l)
    airlight += lights[l].intensity * homogeneous_airlight(light_from_ray(lights[l], origin, direction), end);
  pixels[place_of(pixel)] = vec4(airlight * albedo, constant * end);
}
