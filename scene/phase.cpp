#include "scene/phase.h"

#include <algorithm>
#include <cmath>

#include "scene/base/kinds.h"
#include "scene/math/types.h"

namespace airlight::scene {
namespace {

constexpr double per_sphere = 1 / (4 * pi);

double sample_hg(double g, double u) {
  const double x = 2 * u - 1;
  // The rational form has no 0/0 at g = 0; near |g| = 1 it loses digits and the classic inverse does not.
  if (std::abs(g) < 0.5) {
    const double d = 1 + g * x;
    return (2 * x + g * (x * x + 3) + 2 * g * g * x + g * g * g * (x * x - 1)) / (2 * d * d);
  }
  const double s = (1 - g * g) / (1 + g * x);
  return (1 + g * g - s * s) / (2 * g);
}

double sample_rayleigh(double u) {
  const double z = 4 * u - 2;
  const double a = std::cbrt(std::abs(z) + std::sqrt(z * z + 1));
  return std::copysign(a - 1 / a, z);
}

// With probability `uniform` an isotropic cosine, else the density of ((1+c)/2)^(n-1).
double sample_lobe(double uniform, double n, double u) {
  if (u < uniform) return 2 * (u / uniform) - 1;
  return 2 * std::pow((u - uniform) / (1 - uniform), 1 / n) - 1;
}

double power8(double x) {
  x *= x;
  x *= x;
  return x * x;
}

}  // namespace

double phase_value(const PhaseFunction& phase, double c) {
  return match(
      phase, [](Isotropic) { return per_sphere; }, [c](Rayleigh) { return per_sphere * 0.75 * (1 + c * c); },
      [c](HenyeyGreenstein p) {
        const double g = p.g;
        const double d = (1 - g) * (1 - g) + 2 * g * (1 - c);  // 1 + g^2 - 2 g c, without cancelling
        return per_sphere * (1 - g) * (1 + g) / (d * std::sqrt(d));
      },
      [c](Hazy) { return per_sphere * 0.5 * (1 + 9 * power8(0.5 * (1 + c))); },
      [c](Murky) {
        const double p8 = power8(0.5 * (1 + c));
        const double p32 = (p8 * p8) * (p8 * p8);
        return per_sphere * (33.0 / 83.0) * (1 + 50 * p32);
      });
}

double sample_phase_cosine(const PhaseFunction& phase, double u) {
  const double c = match(
      phase, [u](Isotropic) { return 2 * u - 1; }, [u](Rayleigh) { return sample_rayleigh(u); },
      [u](HenyeyGreenstein p) { return sample_hg(p.g, u); }, [u](Hazy) { return sample_lobe(0.5, 9, u); },
      [u](Murky) { return sample_lobe(33.0 / 83.0, 33, u); });
  return std::clamp(c, -1.0, 1.0);
}

double mean_cosine(const PhaseFunction& phase) {
  return match(
      phase, [](Isotropic) { return 0.0; }, [](Rayleigh) { return 0.0; }, [](HenyeyGreenstein p) { return p.g; },
      // A lobe of density n/2 ((1+c)/2)^(n-1) has the mean cosine (n-1)/(n+1).
      [](Hazy) { return 0.5 * 8.0 / 10.0; }, [](Murky) { return 50.0 / 83.0 * 32.0 / 34.0; });
}

std::string phase_name(const PhaseFunction& phase) {
  return match(
      phase, [](Isotropic) { return "isotropic"; }, [](Rayleigh) { return "rayleigh"; },
      [](HenyeyGreenstein) { return "hg"; }, [](Hazy) { return "hazy"; }, [](Murky) { return "murky"; });
}

}  // namespace airlight::scene
