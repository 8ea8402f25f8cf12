// Where a backdrop ends the rays of pixel centres, or of a grid over the film, as scene/backdrop.cpp has it.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/far_away.glsl"

layout(std430, binding = 0) buffer Distances { float distances[]; };
layout(std430, binding = 1) buffer Seen { float seen[]; };
layout(std430, binding = 2) readonly buffer Depths { float depth_of[]; };  // infinite: no end
layout(std430, binding = 3) readonly buffer Radiances { float radiance_of[]; };
layout(std430, binding = 4) buffer Primitives { int primitive_of[]; };  // -1: none
uniform int picture_width, picture_height;
uniform int fills;                 // 0: without an end there is nothing
uniform int first, has_distances;  // 0: `seen` is of those before; rays are infinite so far

uniform int columns, rows, first_ray;    // rays, and the place of the first
uniform double cell_width, cell_height;  // [pixels]
uniform int cut;                         // 1: cells end at the film's edge
uniform double cell_x, cell_y;           // where rays go through, from 0 to 1 of a cell
uniform int keeps_seen;                  // 0: distances alone
uniform int has_primitives;              // 1: those behind a backdrop become none

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= columns || at.y >= rows) return;
  int place = first_ray + at.y * columns + at.x;
  dvec2 cell = dvec2(cell_width, cell_height), begin = cell * dvec2(at);
  if (cut != 0) cell = min(cell, dvec2(width, height) - begin);
  dvec2 film_at = begin + dvec2(cell_x, cell_y) * cell;
  // Between two pixels, as centres of a film of half the size lie, the right and lower one, whatever the rounding.
  const double tie = 1e-6LF;
  double per_pixel = double(picture_height) / double(height);
  int column = int(floor(0.5LF * double(picture_width) + (film_at.x - 0.5LF * double(width)) * per_pixel + tie));
  int row = int(floor(film_at.y * per_pixel + tie));
  int pixel = clamp(row, 0, picture_height - 1) * picture_width + clamp(column, 0, picture_width - 1);
  float depth = depth_of[pixel];
  bool endless = depth >= far_away;
  vec2 film = vec2(film_at) / vec2(width, height);
  vec3 across = (2 * film.x - 1) * camera_right + (1 - 2 * film.y) * camera_up;
  float t = endless ? far_away : min(depth * (perspective != 0 ? length(camera_forward + across) : 1.0), far_away);
  float nearest = has_distances != 0 ? distances[place] : far_away;
  bool none = first != 0 || keeps_seen == 0 || seen[3 * place] < 0;
  bool ends = endless ? fills != 0 && nearest >= far_away && none : t < nearest;
  if (ends || has_distances == 0) distances[place] = ends ? t : nearest;
  if (ends && has_primitives != 0) primitive_of[place] = -1;
  if (keeps_seen == 0 || (!ends && first == 0)) return;
  for (int c = 0; c < 3; ++c) seen[3 * place + c] = ends ? radiance_of[3 * pixel + c] : -1;
}
