// Radiance of an environment light: KIND 0 is a constant, 1 a map, 2 spherical harmonics of SH_ORDER bands
// (scene/light/environment.h).
#include "common/angle.glsl"
#include "common/pi.glsl"
#if KIND == 2
#include "common/spherical_harmonics.glsl"
#endif

layout(std430, binding = 9) readonly buffer Values { float values[]; };  // texels or coefficients, rgb
uniform int map_width, map_height;
uniform vec3 scale;
uniform mat3 to_map;  // of directions

vec3 value_at(int i) { return vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]); }

vec3 shape_towards(vec3 w) {
#if KIND == 1
  // Bilinear between texel centres, around the world and up to the poles: scene/light/lat_long.h.
  float column = (0.5 + angle_of(w.x, -w.z) / (2 * pi)) * float(map_width) - 0.5;
  float row = angle_of(length(w.xz), w.y) / pi * float(map_height) - 0.5;
  float first = clamp(floor(column), -1.0, float(map_width - 1)), above = clamp(floor(row), -1.0, float(map_height - 1));
  int left = first < 0 ? map_width - 1 : int(first), right = left + 1 == map_width ? 0 : left + 1;
  int top = max(int(above), 0) * map_width, bottom = min(int(above) + 1, map_height - 1) * map_width;
  float x = column - first, y = clamp(row - above, 0.0, 1.0);
  return mix(mix(value_at(top + left), value_at(top + right), x), mix(value_at(bottom + left), value_at(bottom + right), x), y);
#elif KIND == 2
  vec3 sum = vec3(0);
  for (ShPair y = first_pair(w); y.m < sh_order; next_pair(y, w)) {
    int i = y.l * (y.l + 1);
    sum += y.plus * value_at(i + y.m) + y.minus * value_at(i - y.m);
  }
  return sum;
#else
  return vec3(1);
#endif
}

// From a direction [W/m^2/sr].
vec3 environment_radiance(vec3 w) { return scale * shape_towards(to_map * w); }
