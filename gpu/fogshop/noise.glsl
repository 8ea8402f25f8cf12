// Section 5.5: depths of Gaussians along rays that noise bends, as methods/fogshop/noise.cpp. After fog.glsl.
#if NOISE
int permutation(int i) { return int(fog_table[PERMUTATION_FROM + i]); }
uniform float noise_scale, noise_frequency, noise_phase, noise_reach;
const int noise_period = 32;
const ivec3 gradient[12] =
    ivec3[12](ivec3(1, 1, 0), ivec3(-1, 1, 0), ivec3(1, -1, 0), ivec3(-1, -1, 0), ivec3(1, 0, 1), ivec3(-1, 0, 1),
              ivec3(1, 0, -1), ivec3(-1, 0, -1), ivec3(0, 1, 1), ivec3(0, -1, 1), ivec3(0, 1, -1), ivec3(0, -1, -1));

vec3 noise_at(vec3 x) {
  vec3 place = x * noise_frequency + noise_phase, whole = floor(place), f = place - whole;
  ivec3 cell = ivec3(whole - float(noise_period) * floor(whole / float(noise_period)));
  vec3 blend = f * f * f * (f * (6 * f - 15) + 10), sum = vec3(0);
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 far = ivec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    ivec3 at = (cell + far) % noise_period;
    vec3 offset = f - vec3(far), w = mix(1 - blend, blend, vec3(far));
    float weight = w.x * w.y * w.z;
    for (int channel = 0; channel < 3; ++channel) {
      int a = permutation(at.x + 2 * noise_period * channel);
      int hash = permutation((permutation((a + at.y) & 255) + at.z) & 255);
      sum[channel] += weight * dot(vec3(gradient[hash % 12]), offset);
    }
  }
  return clamp(sum, -1, 1);
}

vec3 bent_direction(Gaussian g, vec3 origin, vec3 direction, vec3 nearest) {
  float distance_ = length(g.center - origin), radius = sqrt(g.radius_squared) / noise_reach;
  float share = distance_ > radius ? radius / distance_ : 1;
  return normalize(direction + noise_scale * share * noise_at(nearest));
}

// y' = T_i(v, p) along the bent ray over the unchanged length.
float bent_depth(Gaussian g, float middle, vec3 origin, vec3 direction, float length_) {
  vec3 r = bent_direction(g, origin, direction, origin + clamp(middle, 0, length_) * direction);
  float m = dot(g.center - origin, r);
  return depth_beside(g, origin, r) * erf_between(place_at(-g.a * m), place_at(g.a * (length_ - m)));
}
#endif

// The depth of a Gaussian as a view ray meets it; with noise that of the bent ray, its place that of the straight one.
void add_view_depth(Gaussian g, vec3 origin, vec3 direction, float length_, inout Crossing c) {
#if NOISE
  direction = bent_direction(g, origin, direction, origin + clamp(c.middle, 0, length_) * direction);
#endif
  c.depth = depth_beside(g, origin, direction);
}
