// Weighted means of neighbours along one axis of the grid; beyond it its outermost froxels go on. Volume::filter of
// reference/froxel_fog.
layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = AT_LIGHT) readonly buffer FroxelLight { vec4 froxel_light[]; };
layout(std430, binding = AT_MEDIA) readonly buffer FroxelMedia { vec4 froxel_media[]; };
layout(std430, binding = AT_FILTERED_LIGHT) writeonly buffer FilteredLight { vec4 filtered_light[]; };
layout(std430, binding = AT_FILTERED_MEDIA) writeonly buffer FilteredMedia { vec4 filtered_media[]; };
uniform int cells, stride, count;  // of a slice; from one froxel to the next along the axis, and how many there are
uniform int radius;
uniform vec3 weights;  // of the neighbours at distance 1, 2, 3; the middle takes the rest, so that constants are kept

void main() {
  if (int(gl_GlobalInvocationID.x) >= cells) return;
  int place = int(gl_GlobalInvocationID.y) * cells + int(gl_GlobalInvocationID.x);
  int i = place / stride % count, first = place - i * stride;
  vec3 light = froxel_light[place].rgb, media = froxel_media[place].rgb, middle_light = light, middle_media = media;
  for (int r = 1; r <= radius; ++r) {
    int a = first + max(i - r, 0) * stride, b = first + min(i + r, count - 1) * stride;
    light += weights[r - 1] * ((froxel_light[a].rgb - middle_light) + (froxel_light[b].rgb - middle_light));
    media += weights[r - 1] * ((froxel_media[a].rgb - middle_media) + (froxel_media[b].rgb - middle_media));
  }
  filtered_light[place] = vec4(light, 0);
  filtered_media[place] = vec4(media, 0);
}
