// The light in hand: scene/light/light.h.
uniform int lamp_kind;        // 0 directional, 1 point, 2 spot
uniform dvec3 lamp_position;  // of a point or spot light [m]
uniform dvec3 lamp_axis;      // to a directional light, or where a spot shines
uniform double lamp_cos_inner, lamp_cos_outer;
uniform vec3 lamp_colour;     // irradiance [W/m^2] or intensity [W/sr]

// Direction and distance from a point, far_away of a directional light; what arrives on a plane that faces it [W/m^2].
vec3 lamp_from(dvec3 point, out dvec3 to_light, out double distance_) {
  to_light = lamp_axis;
  distance_ = 1e37LF;
  if (lamp_kind == 0) return lamp_colour;
  dvec3 offset = lamp_position - point;
  distance_ = length(offset);
  if (!(distance_ > 0)) return vec3(0);
  to_light = offset / distance_;
  double inverse = 1 / distance_;
  float share = 1;
  if (lamp_kind == 2) {
    double cosine = -dot(to_light, lamp_axis), width_ = lamp_cos_inner - lamp_cos_outer;
    double u = width_ > 0 ? clamp((cosine - lamp_cos_outer) / width_, 0.0LF, 1.0LF) : cosine >= lamp_cos_inner ? 1.0LF : 0.0LF;
    share = float(u * u * (3 - 2 * u));
  }
  return lamp_colour * share * float(inverse * inverse);
}
