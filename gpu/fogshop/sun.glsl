// Light that the medium scatters onto Lambert and Phong surfaces after Sun et al. 2005, without harmonics
// (methods/fogshop/sun_reflection.h). Needs `tables`.
const int sun_depths = 64, sun_angles = 257;
uniform int sun_at;  // Lambert's table, [depth][angle]

float depth_angle(int at, float T, float angle) {
  const float least = 1e-3, greatest = 30;
  float x = clamp(log(max(T, 1e-30) / least) / log(greatest / least), 0.0, 1.0) * float(sun_depths - 1);
  int k = min(sun_depths - 2, int(x));
  float y = clamp(angle / pi, 0.0, 1.0) * float(sun_angles - 1);
  int a = min(sun_angles - 2, int(y)), row = at + k * sun_angles + a;
  float t = y - float(a);
  return mix(mix(tables[row], tables[row + 1], t), mix(tables[row + sun_angles], tables[row + sun_angles + 1], t), x - float(k));
}

// Per unit of I/d^2 and albedo.
vec3 reflect_sun(Material m, vec3 normal, vec3 to_view, vec3 to_light, vec3 T) {
  if (!(dot(normal, to_view) > 0)) return vec3(0);
  float above = angle_between(normal, to_light);
  vec3 mirror = 2 * dot(normal, to_view) * normal - to_view, result = vec3(0);
  vec3 aside = to_light - dot(mirror, to_light) * mirror;
  float beside = angle_between(mirror, to_light), length_ = length(aside);
  vec3 plain = m.diffuse.rgb;
  if (m.diffuse.w == 1 && m.places.z < 0 && m.specular.w == 0) plain += m.specular.rgb;  // a lobe of exponent 0 is Lambert's
  for (int c = 0; c < 3; ++c) {
    result[c] = plain[c] * depth_angle(sun_at, T[c], above) / pi;
    if (m.places.z >= 0) {
      float sum = depth_angle(m.places.z, T[c], beside) * dot(normal, mirror);
      if (length_ > 1e-6)
        sum += depth_angle(m.places.z + sun_depths * sun_angles, T[c], beside) * dot(normal, aside) / length_;
      result[c] += m.specular[c] * (m.specular.w + 2) / (2 * pi) * max(0.0, sum);
    }
  }
  return result * max(T, vec3(0)) * exp(-T);
}
