// Optical depth of the Gaussians between a light and a point. The lists (fogshop/light_lists.comp) have those that rays of a cell of
// directions may meet, and rays a little beside. Where the points of a work group lie in such directions, the group tests a list together
// and keeps what it meets in shared memory. After fog.glsl and light.glsl.
#include "fogshop/cone.glsl"
#include "fogshop/light_cells.glsl"
// Where the list of each cell of each light begins, and the last one ends; then the lists.
layout(std430, binding = AT_LIGHT_LISTS) readonly buffer LightLists { int light_list[]; };
const int listing = int(LOCAL_SIZE_X * LOCAL_SIZE_Y), listing_words = (listing + 31) / 32;
// From the first on those that all ways of the group pass whole, from the last on the others: centre from the light [m] and a^2 over log 2;
// depth of half of it, or of all if it is passed whole [-], squared radius [m^2], a [1/m], and 1 if the light is far before it.
shared vec4 listed_center[listing], listed[listing];
shared uint passed_bits[2 * listing_words];  // of those passed whole, then of the others
shared int first_way;
shared vec3 way_axis;
shared uint ways_spread, ways_longest, ways_shortest;  // bits of floats that are not below 0

// How all wanted ways of the group lie, as a cone; false: there are none.
bool find_ways(vec3 from, bool wanted, vec3 direction, float length_, out Cone cone) {
  int local = int(gl_LocalInvocationIndex);
  barrier();
  if (local == 0) {
    first_way = listing;
    ways_spread = ways_longest = 0u;
    ways_shortest = floatBitsToUint(far_away);
  }
  barrier();
  if (wanted) atomicMin(first_way, local);
  barrier();
  if (local == first_way) way_axis = direction;
  barrier();
  if (wanted) {
    atomicMax(ways_spread, floatBitsToUint(length(direction - way_axis)));
    atomicMax(ways_longest, floatBitsToUint(length_));
    atomicMin(ways_shortest, floatBitsToUint(length_));
  }
  barrier();
  cone = cone_of(from, way_axis, 0, uintBitsToFloat(ways_spread));
  return first_way < listing;
}

int passed_before(int which, int local) {
  int sum = 0;
  for (int word = 0; word < listing_words; ++word) {
    int bits = clamp(local - 32 * word, 0, 32);
    sum += bitCount(bitfieldExtract(passed_bits[which * listing_words + word], 0, bits));
  }
  return sum;
}

// Keeps the Gaussians of a list, from `first` on, that the ways may meet, in their order: how many they pass whole, and how many others.
ivec2 list_met(Cone cone, int first, int end) {
  int local = int(gl_LocalInvocationIndex), which = -1;
  barrier();
  if (local < 2 * listing_words) passed_bits[local] = 0u;
  barrier();
  if (first + local < end) {
    Gaussian g = gaussians[light_list[first + local]];
    if (touches(cone, g, uintBitsToFloat(ways_longest) * 1.0001)) {
      which = passed_whole(cone, g, uintBitsToFloat(ways_shortest) * 0.9999) ? 0 : 1;
      atomicOr(passed_bits[which * listing_words + local / 32], 1u << (local % 32));
    }
  }
  barrier();
  if (which >= 0) {
    Gaussian g = gaussians[light_list[first + local]];
    vec3 center = g.center - cone.origin;
    float least = max(dot(center, cone.axis) - length(center) * cone.spread, 0), a2 = g.a * g.a;  // least: of its middle along a way
    bool light_far = ERF_COUNT == 0 && a2 * (least * least - g.radius_squared) > tail_length * tail_length;
    int place = passed_before(which, local);
    if (which == 1) place = listing - 1 - place;
    listed_center[place] = vec4(center, a2 * 1.44269504);
    listed[place] = vec4(which == 0 ? 2 * g.half_depth : g.half_depth, g.radius_squared, g.a, light_far ? 1 : 0);
  }
  barrier();
  return ivec2(passed_before(0, listing), passed_before(1, listing));
}

// Every invocation of the group must call it, whether it wants the depth or not.
float depth_from_light(int light, bool wanted, vec3 point) {
  vec3 from = lights[light].position, way = point - from;
  float length_ = length(way), sum = 0;
  wanted = wanted && cells != 0 && length_ > 0;
  vec3 direction = wanted ? way / length_ : vec3(0, 0, 1);
  Cone cone;
  bool some = find_ways(from, wanted, direction, length_, cone);
  if (some && cone.spread <= list_margin) {
    int cell = cell_of(light, cone.axis), begin = light_list[cell], end = light_list[cell + 1];
    for (int first = begin; first < end; first += listing) {
      ivec2 counts = list_met(cone, first, end);
      for (int i = 0; i < counts.x; ++i) {
        vec4 center = listed_center[i], g = listed[i];
        vec3 across = center.xyz - dot(center.xyz, direction) * direction;
        float beside = dot(across, across), depth = g.x * exp2(-center.w * beside);
        sum += beside <= g.y ? depth : 0;
      }
      for (int i = listing - counts.y; i < listing; ++i) {
        vec4 center = listed_center[i], g = listed[i];
        float middle = dot(center.xyz, direction), outside = max(max(-middle, middle - length_), 0), share;
        vec3 across = center.xyz - middle * direction;
        float beside = dot(across, across);
        if (g.w != 0) {
          share = erf_up_to(g.z * (length_ - middle));
        } else {
          share = erf_between(-g.z * middle, g.z * (length_ - middle));
        }
        float depth = g.x * exp2(-center.w * beside) * share;
        sum += beside + outside * outside <= g.y ? depth : 0;
      }
    }
  } else if (wanted) {
    int cell = cell_of(light, direction);
    for (int i = light_list[cell], end = light_list[cell + 1]; i < end; ++i)
      sum += depth_between(gaussians[light_list[i]], from, direction, length_);
  }
  return sum;
}
