// Phase functions per steradian: scene/phase.h, kinds by their place in the variant.
const int phase_isotropic = 0, phase_rayleigh = 1, phase_henyey_greenstein = 2, phase_hazy = 3, phase_murky = 4;
const float per_sphere = 0.07957747154594767;

// `minus`, `plus`: 1 -+ the cosine of the scattering angle, each with its own digits.
float phase_value(int kind, float g, float minus, float plus) {
  if (kind == phase_rayleigh) {
    float c = 0.5 * (plus - minus);
    return 0.75 * per_sphere * (c * c + 1);
  }
  if (kind == phase_henyey_greenstein) {
    float size = abs(g), d = 2 * size * (g < 0 ? plus : minus) + (1 - size) * (1 - size);
    return per_sphere * (1 - size) * (1 + size) / (d * sqrt(d));
  }
  if (kind == phase_isotropic) return per_sphere;
  float p = 0.5 * plus;
  p *= p, p *= p, p *= p;
  if (kind == phase_hazy) return 0.5 * per_sphere * (9 * p + 1);
  p *= p, p *= p;
  return 33.0 / 83.0 * per_sphere * (50 * p + 1);
}
