// Edges of shadows on rays under one light, one edge after the other: `visibility` of methods/legendre_fluids/light_rays.cpp. A ray that
// has done its share of loops goes on in the next dispatch.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
uint work = 0u;
#define COUNT_NODE ++work;
#include "raster/view.glsl"
#include "raster/shadow_tree.glsl"
#include "common/loops_cut.glsl"
#include "legendre_fluids/light_media.glsl"
#include "legendre_fluids/light_shade.glsl"
layout(std430, binding = AT_DISTANCES) readonly buffer Distances { float distances[]; };  // along the rays [m]
layout(std430, binding = AT_REACHED) readonly buffer Reached { double reached[]; };       // how far a ray is done [m]
uniform int has_distances, begins;
uniform int shadow_steps;                // shadow rays over the media on a ray
uniform int budget;                      // iterations of loops, about
const double edge_share = 1.0LF / 4096;  // of the way between two shadow rays: how well an edge is known

void search(dvec3 origin, dvec3 direction, double end, inout Shade shade) {
  dvec2 range = dvec2(nowhere, 0);
  for (int m = 0; m < MEDIA; ++m) {
    dvec2 part = chord(local_ray(m, origin, direction), end);
    if (part.x < part.y) range = dvec2(min(range.x, part.x), max(range.y, part.y));
  }
  if (!(range.x < range.y)) shade.next_ray = shadow_steps;
  double step_ = (range.y - range.x) / double(shadow_steps);
  while (work <= uint(budget)) {
    ++work;
    if (shade.next_ray >= shadow_steps) {
      shade.edge = nowhere;
      shade.flags &= ~shade_waits;
      return;
    }
    bool searches = (shade.flags & shade_searches) != 0, was_lit = (shade.flags & shade_lit) != 0;
    double at = searches ? 0.5LF * (shade.low + shade.high) : range.x + (double(shade.next_ray) + 0.5LF) * step_;
    work += uint(solid_count);
    bool lit = !tree_blocks(-1, origin + at * direction, to_light, nowhere);
    if (searches) {
      if (lit == was_lit)
        shade.low = at;
      else
        shade.high = at;
      if (shade.high - shade.low > edge_share * step_) continue;
      shade.edge = 0.5LF * (shade.low + shade.high);
      shade.flags &= ~(shade_waits | shade_searches);
      ++shade.next_ray;
      return;
    }
    if (shade.next_ray > 0 && lit != was_lit) {
      shade.low = at - step_;
      shade.high = at;
      shade.flags |= shade_searches;
    } else {
      if (lit) shade.flags |= shade_lit;
      ++shade.next_ray;
    }
  }
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view_width || pixel.y >= view_height) return;
  int place = pixel.y * view_width + pixel.x;
  Shade shade = Shade(nowhere, 0.0LF, 0.0LF, 0, shade_waits);
  if (begins == 0) {
    shade = shades[place];
    double last = reached[place];
    if (last >= nowhere) return;
    if ((shade.flags & shade_waits) == 0) {
      if (shade.edge >= nowhere || last < shade.edge) return;
      shade.flags = (shade.flags ^ shade_lit) | shade_waits;
    }
  }
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  search(origin, direction, has_distances != 0 ? double(distances[place]) : nowhere, shade);
  if (loops_cut()) shade.flags |= shade_broken;
  shades[place] = shade;
}
