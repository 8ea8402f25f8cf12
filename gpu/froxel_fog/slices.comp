// The range of the slices, their ends and middles, and the view depths that each frame of a batch looks at.
layout(local_size_x = LOCAL_SIZE_X) in;
#include "common/camera.glsl"
#define SLICES_ACCESS
#include "froxel_fog/grid.glsl"
#include "froxel_fog/slices.glsl"

layout(std430, binding = AT_FITTED) readonly buffer Fitted { uint fitted[2]; };
layout(std430, binding = AT_FRAMES) readonly buffer Frames { vec4 frames[]; };  // jitter, weight of the history
layout(std430, binding = AT_HISTORY_SLICES) readonly buffer HistorySlices { float history_values[]; };
uniform float near, far;  // [m]; far = 0: fitted
uniform int first_frame, frame_count, has_history;

// slice_range of reference/froxel_fog/fit.h; empty unless x < y.
vec2 slice_range() {
  if (far > 0) return vec2(near, far);
  if (fitted[1] == 0u) return vec2(0);
  return vec2(near > 0 ? near : uintBitsToFloat(~fitted[0]), uintBitsToFloat(fitted[1]));
}

void main() {
  int k = int(gl_GlobalInvocationID.x);
  vec2 range = slice_range();
  bool any_ = range.x < range.y;
  if (k > slices) return;
  if (k == 0) {
    slice_values[0] = range.x, slice_values[1] = range.y, slice_values[2] = any_ ? 1 : 0;
    bool before = has_history != 0 && history_values[2] != 0;
    slice_values[3] = before ? history_values[0] : 1;
    slice_values[4] = before ? history_values[1] : 0;
  }
  slice_values[first_end + k] = any_ ? decode_depth(float(k) / float(slices), range) : 0;
  if (k == slices) return;
  slice_values[middle_at(k)] = any_ ? decode_depth((float(k) + 0.5) / float(slices), range) : 0;
  for (int frame = 0; frame < frame_count; ++frame)
    slice_values[sample_at(frame, k)] =
        any_ ? decode_depth((float(k) + frames[first_frame + frame].z) / float(slices), range) : 0;
}
