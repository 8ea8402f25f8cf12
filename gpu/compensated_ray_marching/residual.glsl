// Levels of a residual on the device: scene/convert/residual_bricks.h and perfect_hash.h, decoded; residual_store.h is the host's side.
//   int residual_level(ivec3 sample)     the level of a sample, 0 outside; bit for bit the processor's
//   float residual_between(vec3 sample)  trilinear between levels, 0 beyond one voxel outside [levels]; the same of all kinds
// A grid takes one read for a level, eight for what lies between; bricks take two and five; a hash two dependent ones and sixteen.
#if RESIDUAL_KIND == RESIDUAL_GRID
layout(std430, binding = AT_RESIDUAL_VALUES) readonly buffer ResidualValues { uint residual_values[]; };  // four levels a word
#elif RESIDUAL_KIND == RESIDUAL_BRICKS
layout(std430, binding = AT_RESIDUAL_INDEX) readonly buffer ResidualIndex { uint residual_index[]; };
layout(std430, binding = AT_RESIDUAL_VALUES) readonly buffer ResidualValues { uint residual_values[]; };  // four levels a word
#else
layout(std430, binding = AT_RESIDUAL_INDEX) readonly buffer ResidualOffsets { uint residual_offsets[]; };
layout(std430, binding = AT_RESIDUAL_VALUES) readonly buffer ResidualSlots { uint residual_slots[]; };
#if RESIDUAL_KIND != RESIDUAL_TAGGED
layout(std430, binding = AT_RESIDUAL_MEMBERS) readonly buffer ResidualMembers { uint residual_members[]; };
#endif
uniform int residual_m, residual_r;
uniform vec3 residual_domain_size, residual_tile;  // where the frame lies in it
#define residual_domain uvec3(residual_domain_size)
#endif
uniform vec3 residual_samples;  // of the frame
#define residual_size ivec3(residual_samples)

int residual_byte(uint word, int i) { return bitfieldExtract(int(word), 8 * i, 8); }

#if RESIDUAL_KIND == RESIDUAL_BRICKS

const int residual_side = 9;

int residual_in_brick(int i) { return residual_byte(residual_values[i >> 2], i & 3); }

// Where the corner of the cell lies among the levels; -1 in an empty brick. Cells are counted from the one before the first sample.
int residual_cell(ivec3 cell) {
  ivec3 bricks = (residual_size + 8) / 8, brick = cell / 8, within = cell - 8 * brick;
  uint number = residual_index[brick.x + bricks.x * (brick.y + bricks.y * brick.z)];
  if (number == 0u) return -1;
  return ((int(number - 1u) * residual_side + within.z) * residual_side + within.y) * residual_side + within.x;
}

int residual_level(ivec3 p) {
  if (any(lessThan(p, ivec3(0))) || any(greaterThanEqual(p, residual_size))) return 0;
  int at = residual_cell(p + 1);
  return at < 0 ? 0 : residual_in_brick(at);
}

float residual_between(vec3 p) {
  if (!all(greaterThanEqual(p, vec3(-1))) || !all(lessThan(p, vec3(residual_size)))) return 0;
  vec3 before = floor(p), f = p - before;
  int at = residual_cell(ivec3(before) + 1);
  if (at < 0) return 0;
  const int up = residual_side, back = residual_side * residual_side;
  vec4 low = vec4(residual_in_brick(at), residual_in_brick(at + up), residual_in_brick(at + back),
                  residual_in_brick(at + back + up));
  vec4 high = vec4(residual_in_brick(at + 1), residual_in_brick(at + up + 1), residual_in_brick(at + back + 1),
                   residual_in_brick(at + back + up + 1));
  vec4 along_x = low + f.x * (high - low);
  vec2 along_y = along_x.xz + f.y * (along_x.yw - along_x.xz);
  return along_y.x + f.z * (along_y.y - along_y.x);
}

#else

#if RESIDUAL_KIND == RESIDUAL_GRID
int residual_level(ivec3 p) {
  if (any(lessThan(p, ivec3(0))) || any(greaterThanEqual(p, residual_size))) return 0;
  int at = p.x + residual_size.x * (p.y + residual_size.y * p.z);
  return residual_byte(residual_values[at >> 2], at & 3);
}
#else
int residual_level(ivec3 p) {
  if (residual_m == 0 || any(lessThan(p, ivec3(0))) || any(greaterThanEqual(p, residual_size))) return 0;
  p += ivec3(residual_tile);
  uint place = uint(p.x) + residual_domain.x * (uint(p.y) + residual_domain.y * uint(p.z));
#if RESIDUAL_KIND == RESIDUAL_DOMAIN
  if ((residual_members[place >> 5] >> (place & 31u) & 1u) == 0u) return 0;
#endif
  ivec3 o = p % residual_r;
  uint offset = residual_offsets[o.x + residual_r * (o.y + residual_r * o.z)];
  ivec3 s = (p + ivec3(offset & 1023u, offset >> 10 & 1023u, offset >> 20)) % residual_m;
  int slot = s.x + residual_m * (s.y + residual_m * s.z);
#if RESIDUAL_KIND == RESIDUAL_TAGGED  // a word: the place above its level
  uint word = residual_slots[slot];
  return word >> 8 == place ? residual_byte(word, 0) : 0;
#elif RESIDUAL_KIND == RESIDUAL_TAGGED_WIDE
  if (residual_members[slot] != place) return 0;
  return residual_byte(residual_slots[slot >> 2], slot & 3);
#else
  return residual_byte(residual_slots[slot >> 2], slot & 3);
#endif
}
#endif

float residual_between(vec3 p) {
  if (!all(greaterThanEqual(p, vec3(-1))) || !all(lessThan(p, vec3(residual_size)))) return 0;
  vec3 low = floor(p), f = p - low;
  ivec3 c = ivec3(low);
  vec4 at_0 = vec4(residual_level(c), residual_level(c + ivec3(0, 1, 0)), residual_level(c + ivec3(0, 0, 1)),
                   residual_level(c + ivec3(0, 1, 1)));
  vec4 at_1 = vec4(residual_level(c + ivec3(1, 0, 0)), residual_level(c + ivec3(1, 1, 0)),
                   residual_level(c + ivec3(1, 0, 1)), residual_level(c + ivec3(1, 1, 1)));
  vec4 along_x = at_0 + f.x * (at_1 - at_0);
  vec2 along_y = along_x.xz + f.y * (along_x.yw - along_x.xz);
  return along_y.x + f.z * (along_y.y - along_y.x);
}

#endif
