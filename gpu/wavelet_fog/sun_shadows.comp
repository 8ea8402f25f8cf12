// Where rays through the fog pass from light to shadow: `visibility` of methods/wavelet_fog/sun_scattering.cpp. A ray stops when it has
// found as many edges as it keeps, or has done its share of loops, and goes on in the next dispatch.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
uint work = 0u;
#define COUNT_LOOP ++work;
#define COUNT_NODE ++work;
#include "raster/view.glsl"
#include "raster/shadow_tree.glsl"
#include "wavelet_fog/grids.glsl"
#include "wavelet_fog/fog.glsl"
#include "wavelet_fog/heights.glsl"
#include "wavelet_fog/empty_cells.glsl"
#include "wavelet_fog/sun_course.glsl"
#include "wavelet_fog/sun_ray.glsl"
#include "common/loops_cut.glsl"
uniform double sun_x, sun_y, sun_z;   // towards the sun, unit
uniform int shadow_steps, per_cell;   // shadow rays over the fog on a ray at least, and in each cell
uniform int budget;                   // iterations of loops, about
const double edge_share = 1.0LF / 4096;  // of the way between two shadow rays: how well an edge is known

bool is_lit(double t) {
  work += uint(solid_count);
  return !tree_blocks(-1, course_origin + t * course_direction, dvec3(sun_x, sun_y, sun_z), 1e37LF);
}

// The lengths of all cells in which there is something; false: to be gone on with.
bool measured(inout SunState ray) {
  while (ray.cell < ray.end) {
    if (work > uint(budget)) return false;
    ++work;
    double next = min(next_cut(ray.cell), ray.end);
    if (something_at(0.5LF * (ray.cell + next))) ray.way += next - ray.cell;
    ray.cell = next;
  }
  ray.cell = 0;
  ray.shadow_ray = 0;
  return true;
}

void search(int place, inout SunState ray) {
  double cell_end = ray.cell;
  int count = 0;
  while (ray.edges < EDGES && work <= uint(budget)) {
    ++work;
    if (count == 0) {
      if (!(ray.cell < ray.end)) {
        ray.known = 1e37LF;
        return;
      }
      cell_end = min(next_cut(ray.cell), ray.end);
      if (something_at(0.5LF * (ray.cell + cell_end)))
        count = max(per_cell, int(ceil(double(shadow_steps) * (cell_end - ray.cell) / ray.way)));
    }
    if (count > 0) {
      bool searches = (ray.flags & searching) != 0, was_lit = (ray.flags & lit_before) != 0;
      double next_ray = ray.cell + (double(ray.shadow_ray) + 0.5LF) / double(count) * (cell_end - ray.cell);
      bool lit = is_lit(searches ? 0.5LF * (ray.low + ray.high) : next_ray);
      ++ray.shadow_rays;
      if (searches) {
        if (lit == was_lit)
          ray.low = 0.5LF * (ray.low + ray.high);
        else
          ray.high = 0.5LF * (ray.low + ray.high);
      } else if ((ray.flags & started) == 0) {
        ray.flags = started | (lit ? lit_here | lit_before : 0);
      } else if (lit != was_lit) {
        ray.flags |= searching;
        ray.low = ray.before;
        ray.high = next_ray;
      }
      if ((ray.flags & searching) != 0) {
        if (ray.high - ray.low > edge_share * (next_ray - ray.before)) continue;
        sun_rays[place].edge[ray.edges++] = 0.5LF * (ray.low + ray.high);
        ray.flags = (ray.flags ^ lit_before) & ~searching;
      }
      ray.before = ray.known = next_ray;
      ++ray.shadow_ray;
    }
    if (ray.shadow_ray >= count) {
      ray.shadow_ray = 0;
      ray.cell = cell_end;
      count = 0;
    }
  }
}

void main() {
  ivec2 pixel;
  int place = ray_in_hand(pixel);
  if (place < 0 || sun_rays[place].state.known > 1e36LF || sun_rays[place].state.from > 1e36LF) return;
  SunState ray = sun_rays[place].state;
  for (int i = ray.read; i < ray.edges; ++i) sun_rays[place].edge[i - ray.read] = sun_rays[place].edge[i];
  ray.edges -= ray.read;
  ray.read = 0;
  dvec3 origin, direction;
  view_ray(dvec2(pixel) + 0.5LF, origin, direction);
  set_course(origin, direction, ray.end);
  if (ray.shadow_ray >= 0 || measured(ray)) search(place, ray);
  if (loops_cut()) ray.flags |= cut_short;
  sun_rays[place].state = ray;
}
