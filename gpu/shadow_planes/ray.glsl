// A ray as a light is seen from it: methods/shadow_planes/light_from_ray.h, and where it meets cones. In double precision.
uniform dvec3 light;  // [m]

// The part of a ray that lives across loops: the rest is cheap to compute again and would take 20 registers.
struct Line {
  dvec3 origin, direction;  // the latter unit
};

struct Ray {
  dvec3 origin, direction;
  dvec3 to_light;  // from the origin [m]
  double T, h;     // methods/shadow_planes/light_from_ray.h
  dvec3 n;
};
Ray ray_on(Line line) {
  Ray ray;
  ray.origin = line.origin;
  ray.direction = line.direction;
  ray.to_light = light - ray.origin;
  ray.T = dot(ray.to_light, ray.direction);
  dvec3 foot = ray.T * ray.direction - ray.to_light;
  ray.h = length(foot);
  dvec3 other = abs(ray.direction.x) < 0.5LF ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  ray.n = ray.h > 0 ? foot / ray.h : normalize(cross(ray.direction, other));
  return ray;
}

// Beside the origin of a ray: methods/shadow_planes/general_position.h.
dvec3 in_general_position(dvec3 origin) {
  precise double aside = 2e-13LF * length(light - origin) + 4e-15LF * (length(origin) + length(light));
  precise dvec3 result = origin + aside * dvec3(0.5377LF, 0.3171LF, 0.7812LF);
  return result;
}
Ray ray_in_general_position(Line line) { return ray_on(Line(in_general_position(line.origin), line.direction)); }

// Roots of a t^2 + 2 b t + c; -1 for those that are not real.
dvec2 roots_of(double a, double b, double c) {
  double discriminant = b * b - a * c;
  if (discriminant < 0) return dvec2(-1);
  double root = b < 0 ? -b + sqrt(discriminant) : -b - sqrt(discriminant);
  return dvec2(a != 0 ? root / a : -1.0LF, root != 0 ? c / root : -1.0LF);
}

// Places where the tangent cone from the light to a sphere, c from the light, is crossed by a ray y + t w, negative if not.
dvec2 cross_tangent_cone(dvec3 c, double radius, dvec3 y, dvec3 w) {
  double outside = dot(c, c) - radius * radius;
  return roots_of(dot(w, c) * dot(w, c) - outside, dot(y, c) * dot(w, c) - outside * dot(y, w),
                  dot(y, c) * dot(y, c) - outside * dot(y, y));
}
