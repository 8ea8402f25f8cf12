// Depths from a light out of its map, and the closed parts of the airlight (methods/fogshop/light_map_lookup.cpp,
// homogeneous_airlight.cpp).
layout(std430, binding = AT_LIGHT_MAPS) readonly buffer Maps { float map_depth[]; };

float map_texel(Light light, int i, int j, int k, float f) {
  int place = light.map_offset + (j * (map_directions + 2) + i) * (map_edges + 1) + k;
  return mix(map_depth[place], map_depth[place + 1], f);
}

float light_depth(Light light, vec3 x) {
  vec3 offset = x - light.position;
  vec3 p = vec3(dot(light.axis_x, offset), dot(light.axis_y, offset), dot(light.axis_z, offset));
  float distance_ = length(p);
  if (!(distance_ > light.map_near)) return 0;
  vec2 q;
  if (light.map_tangent > 0) {
    if (!(p.z > 0)) return 0;
    q = p.xy / (light.map_tangent * p.z);
    if (max(abs(q.x), abs(q.y)) > 1) return 0;
  } else {
    q = p.xy / max(abs(p.x) + abs(p.y) + abs(p.z), 1e-30);
    if (p.z < 0) q = (1 - abs(q.yx)) * vec2(q.x < 0 ? -1 : 1, q.y < 0 ? -1 : 1);
  }
  float span = light.map_far - light.map_near;
  float share = span > 0 ? clamp((distance_ - light.map_near) / span, 0, 1) : 0;
  float edge = float(map_edges) * (light.map_near > 0 ? share : sqrt(share));
  vec2 place = 0.5 * float(map_directions) * (q + 1) + 0.5;
  vec2 whole = clamp(floor(place), vec2(0), vec2(map_directions));
  vec2 f = place - whole;
  int i = int(whole.x), j = int(whole.y), k = min(int(edge), map_edges - 1);
  // Linear in the distance, not in its root: from edge k to k + 1 the square grows by 2 k + 1.
  float fe = light.map_near > 0 ? edge - float(k)
                                : (edge - float(k)) * (edge + float(k)) / float(2 * k + 1);
  return mix(mix(map_texel(light, i, j, k, fe), map_texel(light, i + 1, j, k, fe), f.x),
             mix(map_texel(light, i, j + 1, k, fe), map_texel(light, i + 1, j + 1, k, fe), f.x), f.y);
}

#if F_TABLE
#include "fogshop/f_table.glsl"
#else
// Gauss-Legendre, 8 points on [0, 1].
const float gauss_node[4] = float[4](0.0917173212478249, 0.262766204958165, 0.398333238706813, 0.480144928248768);
const float gauss_weight[4] = float[4](0.181341891689181, 0.156853322938944, 0.111190517226687, 0.0506142681451882);

// Integral over x in [xa, xa + length_], measured from the closest approach, of exp(-beta (t + d)) / (x^2 + soft^2),
// t = along + x, d^2 = x^2 + h^2; nodes at equal angles about `soft` > 0.
float equiangular(float xa, float length_, float soft, float along, float h, float beta) {
  float xb = xa + length_;
  float angle = angle_of(soft * length_, soft * soft + xa * xb), sum = 0;
  for (int k = 0; k < 8; ++k) {
    float s = k < 4 ? 0.5 - gauss_node[k] : 0.5 + gauss_node[k - 4];
    float tau = tangent(s * angle) / soft;
    float x = (xa + soft * soft * tau) / (1 - xa * tau);
    sum += gauss_weight[k < 4 ? k : k - 4] * exp(-beta * (along + x + length(vec2(x, h))));
  }
  return angle / soft * sum;
}

// L_a^h of Eq. 17 per W/sr over ray parameters [0, length_]: from the closest approach outwards in pieces that double,
// the exponent moving by less than 2 in each.
float homogeneous_airlight(LightFromRay light, float length_, float beta) {
  if (!(beta > 0) || !(length_ > 0)) return 0;
  float soft = max(length(vec2(light.h, source_radius)), 1e-9);
  float split = clamp(light.along, 0, length_), sum = 0;
  for (int side = 0; side < 2; ++side) {
    float x = side == 0 ? max(0, light.along - length_) : max(0, -light.along);
    float left = side == 0 ? split : length_ - split;
    float part = 0;
    for (int piece = 0; piece < 200 && left > 0; ++piece) {
      float step_ = min(left, max(soft, x) * 0.5);
      if (side == 1) step_ = min(step_, 1 / beta);
      float value = equiangular(side == 0 ? -x - step_ : x, step_, soft, light.along, light.h, beta);
      part += value;
      if (side == 1 && value <= 1e-8 * part) break;
      x += step_;
      left -= step_;
    }
    sum += part;
  }
  return beta / (4 * pi) * sum;
}
#endif
vec3 homogeneous_airlight(LightFromRay light, float length_) {
  vec3 result;
  result.x = homogeneous_airlight(light, length_, constant * extinction_ratio.x);
  result.y = extinction_ratio.y == extinction_ratio.x ? result.x : homogeneous_airlight(light, length_, constant * extinction_ratio.y);
  result.z = extinction_ratio.z == extinction_ratio.x ? result.x : homogeneous_airlight(light, length_, constant * extinction_ratio.z);
#if COLOURED
  result *= constant_colour;
#endif
  return result;
}
