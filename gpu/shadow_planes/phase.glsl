// Phase functions with mean 1: methods/shadow_planes/phase_form.h. v = (1+c)/2, w = (1-c)/2 of the cosine c.
const int phase_isotropic = PHASE_ISOTROPIC, phase_rayleigh = PHASE_RAYLEIGH, phase_hazy = PHASE_HAZY,
          phase_henyey_greenstein = PHASE_HENYEY_GREENSTEIN;  // else murky

struct Phase {
  int kind;
  float g, scale, width;  // width: where the function changes, in q
};

float phase_of_halves(Phase phase, float v, float w) {
  if (phase.kind == phase_isotropic) return 1;
  if (phase.kind == phase_rayleigh) return 0.75 * (1 + (v - w) * (v - w));
  if (phase.kind == phase_henyey_greenstein) {
    float g = phase.g, d = g > 0 ? (1 - g) * (1 - g) + 4 * g * w : (1 + g) * (1 + g) - 4 * g * v;
    return (1 - g) * (1 + g) / (d * sqrt(d));
  }
  float p = v * v;
  p *= p, p *= p;
  if (phase.kind == phase_hazy) return phase.scale * (1 + 9 * p);
  p *= p, p *= p;
  return phase.scale * (1 + 50 * p);
}
