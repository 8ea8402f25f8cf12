// A medium's map and its empty cells into the buffers that hold those of several media (sun_scattering.h).
layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = AT_VALUES) readonly buffer Values { float values[]; };
layout(std430, binding = AT_EMPTINESS) readonly buffer Emptiness { uint emptiness[]; };
layout(std430, binding = AT_PACKED_VALUES) writeonly buffer PackedValues { float packed_values[]; };
layout(std430, binding = AT_PACKED_EMPTINESS) writeonly buffer PackedEmptiness { uint packed_emptiness[]; };
uniform int value_count, word_count, first_value, first_word;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i < value_count) packed_values[first_value + i] = values[i];
  if (i < word_count) packed_emptiness[first_word + i] = emptiness[i];
}
