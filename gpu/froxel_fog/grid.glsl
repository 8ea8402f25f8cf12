// The grid of froxels and its slices: reference/froxel_fog/volume.h.
uniform int columns, rows, slices;
uniform float cell_width, cell_height;  // [pixels]
vec2 cell_size() { return vec2(cell_width, cell_height); }

// 0, 1: the range of the slices [m]; 2: 1, or 0 where it is empty; 3, 4: the range of the history; then ends of slices, from the
// range's beginning on, their middles, and what each frame of a batch looks at.
#ifndef SLICES_ACCESS
#define SLICES_ACCESS readonly
#endif
layout(std430, binding = AT_SLICES) SLICES_ACCESS buffer Slices { float slice_values[]; };
const int first_end = 5;
float end_of(int k) { return slice_values[first_end + k]; }
int middle_at(int k) { return first_end + slices + 1 + k; }
int sample_at(int frame, int k) { return first_end + 2 * slices + 1 + frame * slices + k; }

int froxel_at(int x, int y, int k) { return (k * rows + y) * columns + x; }
// View depth of a metre along a ray.
float depth_per_metre(vec3 direction) { return perspective != 0 ? dot(direction, camera_forward) : 1; }

// Two neighbours of a place between `count` points 0, 1, ..., and the share of the upper one. The upper one may not exist where its
// share is 0.
struct Between {
  int low;
  float share;
};
Between between(float place, int count) {
  float inside = clamp(place, 0.0, float(count - 1));
  int low = min(int(inside), max(count - 2, 0));
  return Between(low, inside - float(low));
}
