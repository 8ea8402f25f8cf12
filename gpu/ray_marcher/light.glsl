// Lights that shine from one direction, and phase functions: reference/ray_marcher/kernels_light.cpp.
const int light_directional = 0, light_point = 1, light_spot = 2;

struct Light {
  vec3 position;  // of a point or spot light, relative to the middle [m]
  int kind;
  vec3 axis;  // unit: to a directional light, or where a spot shines
  float cos_inner;
  vec3 colour;  // irradiance [W/m^2] or intensity [W/sr]
  float cos_outer;
};

layout(std430, binding = AT_LIGHTS) readonly buffer Lights { Light lights[]; };

// A light as a ray meets it: at the ray parameter t, from where it is at `offset`, which is across the ray and h long [m].
struct Approach {
  float t;
  vec3 offset;
  float h;
};
Approach approach(Light light, vec3 origin, vec3 direction) {
  vec3 to_light = light.position - origin;
  Approach a;
  a.t = dot(to_light, direction);
  a.offset = to_light - a.t * direction;
  a.h = length(a.offset);
  return a;
}

// Falloff of a spot light towards its edge; 1 for other lights.
float falloff(Light light, vec3 to_light) {
  if (light.kind != light_spot) return 1;
  float cosine = -dot(to_light, light.axis), width_ = light.cos_inner - light.cos_outer;
  float u = width_ > 0 ? clamp((cosine - light.cos_outer) / width_, 0, 1) : (cosine > light.cos_outer ? 1 : 0);
  return u * u * (3 - 2 * u);
}

struct Incidence {
  vec3 to_light;   // unit
  float distance;  // [m], far_away for a directional light
  float strength;  // mean over the step of 1/distance^2 [1/m^2] (1 for directional), times a spot's falloff
};
// Upon a step of that length whose midpoint lies at x along the ray behind the light's approach: lengths near the light keep
// their digits.
Incidence incidence(Light light, Approach a, float x, vec3 direction, float length_) {
  if (light.kind == light_directional) return Incidence(light.axis, far_away, 1);
  Incidence result;
  vec3 offset = a.offset - x * direction;
  result.distance = max(length(offset), 1e-30);
  result.to_light = offset / result.distance;
  // The angle under which the light sees the step over h * length. A ray through the light itself stays finite.
  float h = max(a.h, 1e-12 * length_), area = h * length_, half_length = 0.5 * length_;
  result.strength = angle_of(area, h * h + (x - half_length) * (x + half_length)) / area;
  result.strength *= falloff(light, result.to_light);
  return result;
}

#include "common/phase.glsl"
