// Variant `paper`: Zhou et al. 2007, Eqs. 8 to 17, every pixel of a strip. One tile is one work group.
// SOME_LIGHTS, ONE_LIGHT: there are lights, there is one; GREY: all channels have one extinction; PHASE: the fog is not isotropic.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/angle.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/tile.glsl"
#include "fogshop/noise.glsl"
#include "fogshop/light.glsl"
#include "fogshop/light_lookup.glsl"

// Depths as in depths.comp: from every light to every centre, from the view point to every centre, from every light to
// the view point.
layout(std430, binding = AT_DEPTHS) readonly buffer Depths { float segment_depth[]; };

const int group_size = int(LOCAL_SIZE_X * LOCAL_SIZE_Y);
// The Gaussians of the tile in hand: centre [m] and a^2 over log 2; depth of half of it [-], squared radius [m^2], a [1/m], and
// the depth from the view point to the centre, with ONE_LIGHT also from that to the centre.
shared vec4 near_center[group_size], near_more[group_size];
shared ivec2 near_place[group_size];  // in the whole list; PASSED_WHOLE and LIGHTS_FAR
#define PASSED_WHOLE 1
#define LIGHTS_FAR 2
#if ONE_LIGHT
#define LIGHTS 1
#else
#define LIGHTS light_count
#endif

#if SOME_LIGHTS
// Where light passes the centre, at most a radius beside the line, so far from the light that the tail there changes nothing: it is
// shorter than the tail at x, at most a radius from the centre, by more than erf_between leaves out.
bool lights_far(Gaussian g) {
  bool far = ERF_COUNT == 0;
  for (int l = 0; l < LIGHTS; ++l) {
    vec3 offset = g.center - lights[l].position;
    far = far && g.a * g.a * (dot(offset, offset) - 2 * g.radius_squared) > tail_length * tail_length;
  }
  return far;
}
#endif

int load(int first, int count) {
  int local = int(gl_LocalInvocationIndex);
  barrier();
  if (first + local < count) {
    int entry = tile_list[list_of_group() + 1 + first + local];
    Gaussian g = gaussians[entry < 0 ? -1 - entry : entry];
    int place = int(g.place);
    ivec2 place_and_bits = ivec2(place, entry < 0 ? PASSED_WHOLE : 0);
    float depth = 0;
#if SOME_LIGHTS
    depth = segment_depth[LIGHTS * gaussian_count + place];
    if (lights_far(g)) place_and_bits.y |= LIGHTS_FAR;
#endif
#if ONE_LIGHT
    depth += segment_depth[place];
#endif
    near_center[local] = vec4(g.center, g.a * g.a * 1.44269504);
    near_more[local] = vec4(g.half_depth, g.radius_squared, g.a, depth);
    near_place[local] = place_and_bits;
  }
  barrier();
  return min(group_size, count - first);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, tile_row * int(LOCAL_SIZE_Y));
  bool visible = is_computed(pixel);  // the others still help to load
  vec3 origin, direction;
  camera_ray(film_position(pixel), origin, direction);
  float end = visible ? ray_length(pixel) : far_away;
  int count = near_count();
  if (count < 0) return;  // the whole tile

  vec3 airlight = vec3(0);
#if ONE_LIGHT
  vec3 from_light = origin - lights[0].position;
#endif
  float depth = constant > 0 ? constant * end : 0;
  for (int first = 0; first < count; first += group_size) {
    int loaded = load(first, count);
    for (int i = 0; i < loaded; ++i) {
      vec4 center = near_center[i], more = near_more[i];
      vec3 to_center = center.xyz - origin;
      float middle = dot(to_center, direction), outside = max(max(-middle, middle - end), 0), a = more.z;
      vec3 across = to_center - middle * direction;
      float aside = dot(across, across);
      if (aside + outside * outside <= more.y) {
        ivec2 place = near_place[i];
        float half_ = more.x * exp2(-center.w * aside), t = middle, before = half_, whole = 2 * half_;
        if ((place.y & PASSED_WHOLE) == 0) {
          // Eq. 10, clamped; up to the middle, where the error function is 0.
          float tail_of_start, share = erf_between(-a * middle, a * (end - middle), tail_of_start);
          t = clamp(middle, 0, end);
          whole = half_ * share;
          before = middle <= 0 ? 0 : half_ * min(share, 1 - tail_of_start);
        }
#if NOISE
        whole = bent_depth(gaussians[place.x], middle, origin, direction, end);
#endif
        depth += whole;
#if SOME_LIGHTS
        vec3 from_center = t * direction - to_center, scattered = vec3(0);
        float beside = dot(from_center, from_center), on_way = more.w + before;
        for (int l = 0; l < LIGHTS; ++l) {
#if ONE_LIGHT
          vec3 offset = t * direction + from_light;
#else
          vec3 offset = t * direction + (origin - lights[l].position);
#endif
          float square = dot(offset, offset), inverse = inversesqrt(max(square, 1e-36));
          // The light passes the centre `past` before x. Gaussians beyond their radius still count here.
          float past = dot(from_center, offset) * inverse, share;
          if ((place.y & LIGHTS_FAR) != 0) {
            share = erf_up_to(a * past);
          } else {
            share = erf_between(a * (past - square * inverse), a * past);
          }
          // Eqs. 11 to 13, exponents added before the exponential.
          float through = on_way + more.x * exp2(-center.w * max(beside - past * past, 0)) * share;
#if !ONE_LIGHT
          through += segment_depth[l * gaussian_count + place.x];
#endif
          float weight = 1 / (square + source_radius * source_radius);
#if PHASE
          weight *= phase_of(dot(offset, direction) * inverse);  // k(alpha) of Eq. 12
#endif
#if GREY
          scattered += weight * exp(-extinction_ratio.x * through) * lights[l].intensity;
#else
          scattered += weight * lights[l].intensity * decay(through);
#endif
        }
#if COLOURED
        scattered *= colour_of(place.x);
#endif
        airlight += whole * scattered;
#endif
      }
    }
  }
  airlight *= extinction_ratio / (4 * pi);
  if (light_count > 0 && constant > 0) {
    for (int l = 0; l < light_count; ++l)  // Eqs. 16 and 17
      airlight += lights[l].intensity * exp(-extinction_ratio * segment_depth[(LIGHTS + 1) * gaussian_count + l]) *
                  homogeneous_airlight(light_from_ray(lights[l], origin, direction), end);
  }
  if (visible) pixels[place_of(pixel)] = vec4(airlight * albedo, depth);
}
