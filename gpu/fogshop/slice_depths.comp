// Optical depths of the slices, exact; eight slices of a ray to an invocation, those that a Gaussian does not reach left out. EVEN: the
// slices of the environment's airlight, of equal length over the reach of the Gaussians; else those of variant S, the fourth pass.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "fogshop/fog.glsl"
#include "fogshop/pixels.glsl"
#include "fogshop/near.glsl"
#include "fogshop/ray_values.glsl"
#include "fogshop/noise.glsl"

#define EACH_OF_EIGHT(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7)
const int slices_each = 8;  // as gpu/fogshop/airlight_pass.cpp

void main() {
  ivec2 pixel = pixel_of_strip();
  int count = near_count();
  if (count < 0) return;
  int ray = ray_of_strip(), first_slice = slices_each * int(gl_WorkGroupID.z);
  bool wanted = pixel.x < grid_width;
  float lo = wanted ? ray_value[value_at(EVEN != 0 ? reach_from : slices_from, ray)] : 0;
  float hi = wanted ? ray_value[value_at(EVEN != 0 ? reach_to : slices_to, ray)] : 0;
  wanted = lo < hi;
  if (!any_of_group(wanted)) return;
  vec3 origin, direction;
  camera_ray(film_position(pixel), origin, direction);
  float end = wanted ? ray_length(pixel) : 0, fog_between = EVEN != 0 ? 0 : constant;

  float edge[9], depth[8], before = 0;
#if COLOURED
  vec3 scattered[8];
#endif
  for (int k = 0; k <= 8; ++k) {  // beyond the last they are empty
    int i = min(first_slice + k, slice_count);
    edge[k] = EVEN != 0 ? (i < slice_count ? lo + (hi - lo) / float(slice_count) * float(i) : hi)
                        : (wanted ? ray_value[value_at(edges + i, ray)] : 0);
  }
#if COLOURED
#define BEGIN_COLOUR(k) scattered[k] = constant_colour * depth[k];
#define ADD_COLOUR(k) scattered[k] += colour * part;
#else
#define BEGIN_COLOUR(k)
#define ADD_COLOUR(k)
#endif
#define BEGIN(k) depth[k] = fog_between * (edge[k + 1] - edge[k]); BEGIN_COLOUR(k)
  EACH_OF_EIGHT(BEGIN)
  for (int first = 0; first < count; first += group_size) {
    int loaded = load_near(first, count);
    for (int i = 0; i < loaded; ++i) {
      Gaussian g = near_block[i];
      Crossing c = cross_geometry(g, origin, direction, end);
      // Where its error function is at its limits in single precision there is nothing to add.
      float reach = max(4.2 / c.a, sqrt(g.radius_squared));
      if (!wanted || !c.met || edge[8] <= c.middle - reach || (first_slice > 0 && edge[0] >= c.middle + reach)) continue;
      add_view_depth(g, origin, direction, end, c);
      Place begin = place_at(c, edge[0]), next;
      if (first_slice == 0) before += c.depth * erf_between(place_at(-c.a * c.middle), begin);
      float part;
#if COLOURED
      vec3 colour = colour_of(int(g.place));
#endif
#define ADD_DEPTH(k)                            \
  next = place_at(c, edge[k + 1]);              \
  part = c.depth * erf_between(begin, next);    \
  depth[k] += part;                             \
  ADD_COLOUR(k)                                 \
  begin = next;
      EACH_OF_EIGHT(ADD_DEPTH)
    }
  }
  if (!wanted) return;
  if (first_slice == 0) ray_value[value_at(slices, ray)] = fog_between * lo + before;
#if COLOURED && !EVEN
#define WRITE_COLOUR(k) \
  for (int c = 0; c < 3; ++c) ray_value[value_at(scattering + 3 * (first_slice + k) + c, ray)] = scattered[k][c];
#else
#define WRITE_COLOUR(k)
#endif
#define WRITE(k)                                                               \
  if (first_slice + k < slice_count) {                                              \
    ray_value[value_at(slices + 1 + first_slice + k, ray)] = depth[k];         \
    WRITE_COLOUR(k)                                                            \
  }
  EACH_OF_EIGHT(WRITE)
}
