// Phase functions p(c): the density over solid angle of the direction after a scattering [1/sr].
//
// c = dot(propagation direction before, propagation direction after); c = 1 is straight on. Every one integrates to 1
// over the sphere. Hazy and murky are the normalised forms: Biri et al. 2006 print them without the factors 1/2 and
// 33/83, with sphere means of 2 and 83/33.
#pragma once
#include <string>
#include <variant>

namespace airlight::scene {

struct Isotropic {};
struct Rayleigh {};  // 3/(16 pi) (1 + c^2)
struct HenyeyGreenstein {
  double g = 0;  // mean cosine, -1 < g < 1, > 0 forward
};
struct Hazy {};   // (1 + 9 ((1+c)/2)^8) / (8 pi)
struct Murky {};  // 33/83 (1 + 50 ((1+c)/2)^32) / (4 pi)

using PhaseFunction = std::variant<Isotropic, Rayleigh, HenyeyGreenstein, Hazy, Murky>;

// p(c) [1/sr], for c in [-1, 1].
double phase_value(const PhaseFunction&, double c);

// The cosine with density 2 pi p(c) for a uniform u in [0, 1]; always within [-1, 1].
double sample_phase_cosine(const PhaseFunction&, double u);

// Mean of c over the distribution.
double mean_cosine(const PhaseFunction&);

// "isotropic", "rayleigh", "hg", "hazy", "murky".
std::string phase_name(const PhaseFunction&);

}  // namespace airlight::scene
