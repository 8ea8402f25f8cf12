// Variant `paper`: Zhou et al. 2007, Eqs. 8 to 17, every pixel of a strip. One tile is one work group.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/angle.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/near.glsl"
#include "fogshop/noise.glsl"
#include "fogshop/light.glsl"
#include "fogshop/light_lookup.glsl"

// Depths as in depths.comp: from every light to every centre, from the view point to every centre, from every light to
// the view point.
layout(std430, binding = AT_DEPTHS) readonly buffer Depths { float segment_depth[]; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, tile_row * int(LOCAL_SIZE_Y));
  bool visible = is_computed(pixel);  // the others still help to load
  vec3 origin, direction;
  camera_ray(film_position(pixel), origin, direction);
  float end = visible ? ray_length(pixel) : far_away;
  int count = near_count();
  if (count < 0) return;  // the whole tile
  int to_view = light_count * gaussian_count, to_lights = to_view + gaussian_count;

  vec3 airlight = vec3(0);
  float depth = constant > 0 ? constant * end : 0;
  for (int first = 0; first < count; first += group_size) {
    int loaded = load_near(first, count);
    for (int i = 0; i < loaded; ++i) {
      Gaussian g = near_block[i];
      Crossing c = cross_geometry(g, origin, direction, end);
      if (c.met) {
        c.depth = depth_beside(g, origin, direction);
        // Eq. 10, clamped; up to the middle, where the error function is 0.
        c.start = Place(-g.a * c.middle, 0);
        float whole = c.depth * erf_between(c.start, g.a * (end - c.middle)), t = clamp(c.middle, 0, end);
        float before = c.middle <= 0 ? 0 : c.middle >= end ? whole : c.depth * (1 - c.start.tail);
#if NOISE
        whole = bent_depth(g, c, origin, direction, end);
#endif
        depth += whole;
        if (light_count > 0) {
          vec3 x = origin + t * direction, from_center = t * direction - (g.center - origin), scattered = vec3(0);
          int place = int(g.place);
          float beside = dot(from_center, from_center), towards_view = segment_depth[to_view + place] + before;
          for (int l = 0; l < light_count; ++l) {
            vec3 offset = x - lights[l].position;
            float square = dot(offset, offset), inverse = inversesqrt(max(square, 1e-36)), distance_ = square * inverse;
            // The light passes the centre `past` before x. Gaussians beyond their radius still count here.
            float past = dot(from_center, offset) * inverse;
            float of_light = g.half_depth * exp(-g.a * g.a * max(beside - past * past, 0)) *
                             erf_between(g.a * (past - distance_), g.a * past);
            // Eqs. 11 to 13, exponents added before the exponential.
            vec3 term = decay(segment_depth[l * gaussian_count + place] + of_light + towards_view);
            float weight = 1 / (square + source_radius * source_radius);
            if (phase_g != 0) {
              weight *= phase_of(dot(offset, direction) * inverse);  // k(alpha) of Eq. 12
            }
            scattered += weight * lights[l].intensity * term;
          }
#if COLOURED
          scattered *= colour_of(place);
#endif
          airlight += whole * scattered;
        }
      }
    }
  }
  airlight *= extinction_ratio / (4 * pi);
  if (light_count > 0 && constant > 0) {
    for (int l = 0; l < light_count; ++l)  // Eqs. 16 and 17
      airlight += lights[l].intensity * exp(-extinction_ratio * segment_depth[to_lights + l]) *
                  homogeneous_airlight(light_from_ray(lights[l], origin, direction), end);
  }
  if (visible) pixels[place_of(pixel)] = vec4(airlight * albedo, depth);
}
