// Optical depths of what varies from points to lights, looked up in maps: reference/light_map/kernels.cpp. Needs MAP_PLANES, the
// optical depths of a texel (0, 1 or 3), and MAP_ENCODING.
#include "common/unit_vector.glsl"
const int encoding_slices = 0, encoding_avsm = 1, encoding_fourier = 2, encoding_beer = 3;

#if MAP_PLANES
// First a rule of map_rule floats for each light (light_maps.cpp), then its planes of texels, row by row with their border.
layout(std430, binding = AT_LIGHT_MAPS) readonly buffer LightMaps { float light_maps[]; };
uniform int map_lights, map_size;  // texels a side
uniform int map_floats;            // of a texel
uniform int map_entries;           // slices, nodes or coefficients
uniform int map_negative;          // may optical depths be negative? Where not, a series that falls below 0 is cut there
uniform vec3 map_share;            // of the channels in the only plane
const int map_rule = 17;
const float map_slack = 1e-3;  // reference/light_map/projection.h
const float least_transmittance = 1e-37;

// The texel left and above a point, as a place in a plane; shares of its neighbours; depth in [0, 1], 0 beside the map.
struct MapPlace {
  int texel;
  vec2 share;
  float depth;
};

// Rows of three factors and a shift. Orthographic: to texels and the share of the depth. Octahedral: to metres around the light.
vec3 in_map(int rule, vec3 x) {
  vec3 local;
  for (int i = 0; i < 3; ++i)
    local[i] = dot(vec3(light_maps[rule + 4 * i], light_maps[rule + 4 * i + 1], light_maps[rule + 4 * i + 2]), x);
  return local;
}

MapPlace map_place(int l, vec3 x) {
  int rule = map_rule * l;
  vec3 local = in_map(rule, x), shift = vec3(light_maps[rule + 3], light_maps[rule + 7], light_maps[rule + 11]);
  float kind = light_maps[rule + 12];  // 0 orthographic, 1 octahedral, 2 the whole sphere
  vec3 at = local + shift;             // texels across, depth
  if (kind > 0) {
    float near = light_maps[rule + 14], excess = light_maps[rule + 15], size = dot(abs(at), vec3(1)), radius = length(at);
    vec2 uv = at.xy / max(size, 1e-30);
    // radius - near, as (radius^2 - near^2) / (radius + near): the difference loses its digits where the light is far away.
    float beyond = excess < far_away
                       ? (dot(at.xy, at.xy) + local.z * (2 * shift.z + local.z) + excess) / (radius + near)
                       : radius - near;
    bool behind = at.z < 0;
    if (behind) uv = (1 - abs(uv.yx)) * vec2(uv.x < 0 ? -1 : 1, uv.y < 0 ? -1 : 1);
    at = vec3(uv * light_maps[rule + 13] + 0.5 * float(map_size), behind && kind < 2 ? 0 : beyond * light_maps[rule + 16]);
  }
  float size = float(map_size);
  bool inside = all(greaterThanEqual(at.xy, vec2(-map_slack))) && all(lessThanEqual(at.xy, vec2(size + map_slack)));
  // Half a texel is the border, so that texel k with the border is centred at k.
  vec2 texel = clamp(at.xy, vec2(0), vec2(size)) + 0.5;
  ivec2 corner = ivec2(texel);
  return MapPlace((corner.y * (map_size + 2) + corner.x) * map_floats, texel - vec2(corner),
                  inside ? clamp(at.z, 0.0, 1.0) : 0);
}

#if MAP_ENCODING == 1
float decode(int texel, float depth) {
  int before = 0, last = map_entries - 1;  // so many nodes are no deeper
  for (int step_ = 1 << findMSB(map_entries); step_ > 0; step_ /= 2) {
    int probe = before + step_ - 1;
    if (probe <= last && light_maps[texel + probe] <= depth) before = probe + 1;
  }
  int a = texel + max(before - 1, 0), b = texel + min(before, last);
  float near = light_maps[a], far = light_maps[b], share = clamp((depth - near) / max(far - near, 1e-30), 0.0, 1.0);
  float t = light_maps[a + map_entries], behind = light_maps[b + map_entries];
  return -log(max(t + share * (behind - t), least_transmittance));
}
#elif MAP_ENCODING == 3
float decode(int texel, float depth) {
  float so_far = light_maps[texel + 1] * max(depth - light_maps[texel], 0.0), total = light_maps[texel + 2];
  return abs(so_far) < abs(total) ? so_far : total;
}
#elif MAP_ENCODING == 0
float decode(int texel, float depth) {
  float place = depth * float(map_entries);
  int slice = min(int(place), map_entries - 1);
  float near = light_maps[texel + slice], far = light_maps[texel + slice + 1];
  return near + (place - float(slice)) * (far - near);
}
#endif

float blend(float share, float a, float b) { return a + share * (b - a); }

#if MAP_ENCODING == 2
// A series is linear in its coefficients: they are interpolated between texels, one after another.
float coefficient(int plane, MapPlace at, int c) {
  int texel = plane + at.texel + c, below = texel + (map_size + 2) * map_floats;
  return blend(at.share.y, blend(at.share.x, light_maps[texel], light_maps[texel + map_floats]),
               blend(at.share.x, light_maps[below], light_maps[below + map_floats]));
}
float depth_in_plane(int plane, MapPlace at) {
  const float turn = 6.283185307;
  // Cosine and sine of turns by d, 2d, ...: each from the one before.
  vec2 first = unit_vector(at.depth), wave = first;
  float sum = 0.5 * at.depth * coefficient(plane, at, 0);
  for (int k = 1; 2 * k < map_entries; ++k) {
    sum += (coefficient(plane, at, 2 * k - 1) * wave.y + coefficient(plane, at, 2 * k) * (1 - wave.x)) / (turn * float(k));
    wave = vec2(wave.x * first.x - wave.y * first.y, wave.y * first.x + wave.x * first.y);
  }
  return sum;
}
#else
float depth_in_plane(int plane, MapPlace at) {
  int texel = plane + at.texel, below = texel + (map_size + 2) * map_floats;
  return blend(at.share.y, blend(at.share.x, decode(texel, at.depth), decode(texel + map_floats, at.depth)),
               blend(at.share.x, decode(below, at.depth), decode(below + map_floats, at.depth)));
}
#endif
#endif

// From x to light l, per channel, without constants. Adds the iterations of loops to `work`.
vec3 mapped_depth(int l, vec3 x) {
#if MAP_PLANES
  MapPlace at = map_place(l, x);
  int plane = (map_size + 2) * (map_size + 2) * map_floats, first = map_rule * map_lights + l * MAP_PLANES * plane;
  vec3 depth = vec3(0);
  for (int c = 0; c < MAP_PLANES; ++c) {
    float sum = depth_in_plane(first + c * plane, at);
    depth[c] = map_negative != 0 ? sum : max(sum, 0.0);
#if MAP_ENCODING == 1
    work += 4u * uint(findMSB(map_entries) + 1);
#elif MAP_ENCODING == 2
    work += uint(map_entries / 2);
#endif
  }
  return MAP_PLANES == 1 ? map_share * depth.x : depth;
#else
  return vec3(0);
#endif
}
