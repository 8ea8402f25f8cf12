// All rays near one: does a Gaussian come within reach of any? After fog.glsl.
struct Cone {
  vec3 origin, axis;
  float start, spread, cosine;  // rays start within `start` [m] of the axis and leave it by `spread` per metre
};
// Rounding is counted against the rays.
Cone cone_of(vec3 origin, vec3 axis, float start, float spread) {
  spread = spread * 1.0001 + 1e-6;
  return Cone(origin, axis, start, spread, sqrt(max(0, 1 - spread * spread)));
}

// Whether all rays of the cone, which are `least` metres long or longer, pass a Gaussian from before it to behind it.
bool passed_whole(Cone cone, Gaussian g, float least) {
  vec3 q = g.center - cone.origin;
  float m = dot(q, cone.axis), apart = tail_length / g.a + cone.start + length(q) * cone.spread;
  return m >= apart && m + apart <= least;
}

// Whether rays that end `far` metres from their start come within reach of a Gaussian.
bool touches(Cone cone, Gaussian g, float far) {
  vec3 q = g.center - cone.origin;
  float m = dot(q, cone.axis), p = length(q - m * cone.axis), radius = sqrt(g.radius_squared) * 1.0001 + cone.start;
  if (length(q) - radius > far) return false;
  // The sphere's distance from the axis less what rays have left it by is least where the line to its centre leans back by the
  // angle whose sine is `spread`.
  float least = m + p * cone.spread / cone.cosine > 0 ? p * cone.cosine - cone.spread * m : length(q);
  return cone.spread >= 1 || least <= radius;
}
