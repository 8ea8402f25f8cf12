// Reflectances (scene/geometry/surface.h). Needs `tables`.
#include "common/angle.glsl"
#include "common/pi.glsl"

struct Material {
  vec4 diffuse;   // albedo of Lambert; w: 0 Lambert, 1 Phong, 2 a table
  vec4 specular;  // w: exponent
  ivec4 table;    // tabulated: its place, polar angles, azimuthal angles
  ivec4 places;   // in harmonics: its place, entries; lobe of Sun et al., -1: none
};
#ifndef MATERIALS_BINDING
#define MATERIALS_BINDING 2
#endif
layout(std430, binding = MATERIALS_BINDING) readonly buffer Materials { Material materials[]; };  // by surface

float angle_between(vec3 a, vec3 b) { return angle_of(length(cross(a, b)), dot(a, b)); }

vec3 rgb_at(int place) { return vec3(tables[place], tables[place + 1], tables[place + 2]); }

// Linear in both polar angles and in the azimuth between them; scene/geometry/brdf_table.h.
vec3 tabulated_brdf(ivec4 table, vec3 normal, vec3 to_light, vec3 to_view) {
  float c_in = dot(normal, to_light), c_out = dot(normal, to_view);
  float turn = angle_of(abs(dot(normal, cross(to_light, to_view))), dot(to_light, to_view) - c_in * c_out);
  vec3 angles = vec3(angle_between(normal, to_light), angle_between(normal, to_view), turn) / vec3(0.5 * pi, 0.5 * pi, pi);
  ivec3 size = table.yyz;
  vec3 place = clamp(angles, 0, 1) * vec3(size - 1);
  ivec3 entry = min(size - 2, ivec3(place));
  vec3 share = place - vec3(entry), sum = vec3(0);
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 up = ivec3(corner & 1, corner >> 1 & 1, corner >> 2), at = entry + up;
    vec3 weight = mix(1 - share, share, equal(up, ivec3(1)));
    sum += weight.x * weight.y * weight.z * rgb_at(table.x + 3 * (size.z * (size.x * at.x + at.y) + at.z));
  }
  return sum;
}

vec3 brdf(Material m, vec3 normal, vec3 to_light, vec3 to_view) {
  if (!(dot(normal, to_light) > 0) || !(dot(normal, to_view) > 0)) return vec3(0);
  if (m.diffuse.w == 0) return m.diffuse.rgb / pi;
  if (m.diffuse.w == 2) return tabulated_brdf(m.table, normal, to_light, to_view);
  vec3 mirrored = 2 * dot(normal, to_light) * normal - to_light;
  float cosine = max(0.0, dot(mirrored, to_view)), n = m.specular.w;
  float power = n == 0 ? 1.0 : (cosine > 0 ? pow(cosine, n) : 0.0);
  return m.diffuse.rgb / pi + m.specular.rgb * ((n + 2) / (2 * pi) * power);
}
