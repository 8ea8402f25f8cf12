// From what a raster pass drew (hit.glsl) to primitives: one less, -1 where nothing was drawn. NVIDIA's driver (580) clears an image of
// integers to -1 as 2^31 - 1, so none is below 0 there.
layout(local_size_x = LOCAL_SIZE_X, local_size_y = LOCAL_SIZE_Y) in;
layout(std430, binding = 0) buffer Primitives { int primitives[]; };
uniform int columns, rows, first_ray;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x < columns && at.y < rows) primitives[first_ray + at.y * columns + at.x] -= 1;
}
