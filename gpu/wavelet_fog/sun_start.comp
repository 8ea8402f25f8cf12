// Rays under a sun before anything is known of them.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#define VALUES_ACCESS readonly
#include "raster/view.glsl"
#include "wavelet_fog/grids.glsl"
#include "wavelet_fog/fog.glsl"
#include "wavelet_fog/walk.glsl"
#include "wavelet_fog/sun_course.glsl"
#include "wavelet_fog/sun_ray.glsl"
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // along the rays [m]
uniform int has_distances, has_surfaces;
const float opaque = 40;

float density_at(double t) {
  Grid g = grids[fog.map];
  ivec2 cell = cell_of(t);
  vec2 local = vec2(from_bits(start_in[medium]) + t * from_bits(along_in[medium]) - dvec2(cell));
  return in_cell(cell_at(place_of(g, cell), g.stride), local) * factor_at(course_origin.y + t * course_direction.y);
}

// An upright ray may not leave the fog: it ends where that is opaque (finite_extent of methods/wavelet_fog/sun_scattering.cpp).
double end_in_fog(dvec3 origin, dvec3 direction) {
  double end = 0;
  set_course(origin, direction, 1e37LF);
  for (int i = 0; i < media; ++i) {
    take_medium(i);
    dvec2 way = from_bits(way_in[medium]);
    if (way.y > way.x && way.y > 1e36LF) {
      double last = way.x;
      for (int k = 0; k < breaks() && direction.y != 0; ++k) last = max(last, (knot_height(k) - origin.y) / direction.y);
      float thinnest = 1e37;
      for (int c = 0; c < 3; ++c)
        if (fog.sigma_t[c] > 0) thinnest = min(thinnest, fog.sigma_t[c]);
      float density = density_at(last + 1);
      way.y = density > 0 ? last + double(opaque / (thinnest * density)) : last;
    }
    if (way.y > way.x) end = max(end, way.y);
  }
  return end;
}

void main() {
  ivec2 pixel;
  int place = ray_in_hand(pixel);
  if (place < 0) return;
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  SunState ray;
  ray.end = end_in_fog(origin, direction);
  if (has_distances != 0) ray.end = min(ray.end, double(distances[pixel.y * view_width + pixel.x]));
  ray.known = has_surfaces != 0 ? 0.0LF : 1e37LF;
  ray.from = ray.cell = ray.before = ray.low = ray.high = ray.way = 0;
  for (int c = 0; c < 3; ++c) ray.light[c] = ray.depth[c] = 0;
  ray.shadow_ray = -1;
  ray.flags = lit_here;
  ray.halvings = ray.index = ray.edges = ray.read = ray.shadow_rays = ray.unused = 0;
  sun_rays[place].state = ray;
}
