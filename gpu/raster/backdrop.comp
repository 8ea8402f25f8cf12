// Where a backdrop ends the rays of pixel centres, as scene/backdrop.cpp has it.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
#include "common/camera.glsl"
#include "common/far_away.glsl"

layout(std430, binding = 0) buffer Distances { float distances[]; };
layout(std430, binding = 1) buffer Seen { float seen[]; };
layout(std430, binding = 2) readonly buffer Depths { float depth_of[]; };  // infinite: no end
layout(std430, binding = 3) readonly buffer Radiances { float radiance_of[]; };
uniform int picture_width, picture_height;
uniform int fills;                 // 0: without an end there is nothing
uniform int first, has_distances;  // 0: `seen` is of those before; rays are infinite so far

// Quotient rounded down, of a divisor above 0.
int below(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= width || at.y >= height) return;
  int place = at.y * width + at.x;
  int column = below(picture_width * height + (2 * at.x + 1 - width) * picture_height, 2 * height);
  int row = below((2 * at.y + 1) * picture_height, 2 * height);
  int pixel = clamp(row, 0, picture_height - 1) * picture_width + clamp(column, 0, picture_width - 1);
  float depth = depth_of[pixel];
  bool endless = depth >= far_away;
  vec2 film = (vec2(at) + 0.5) / vec2(width, height);
  vec3 across = (2 * film.x - 1) * camera_right + (1 - 2 * film.y) * camera_up;
  float t = endless ? far_away : min(depth * (perspective != 0 ? length(camera_forward + across) : 1.0), far_away);
  float nearest = has_distances != 0 ? distances[place] : far_away;
  bool none = first != 0 || seen[3 * place] < 0;
  bool ends = endless ? fills != 0 && nearest >= far_away && none : t < nearest;
  if (ends || has_distances == 0) distances[place] = ends ? t : nearest;
  if (!ends && first == 0) return;
  for (int c = 0; c < 3; ++c) seen[3 * place + c] = ends ? radiance_of[3 * pixel + c] : -1;
}
