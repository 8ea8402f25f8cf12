#include "methods/shadow_planes/mapped_rule.h"

#include "methods/shadow_planes/rule_sum.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/types.h"

namespace airlight::shadow_planes {

template <class Real>
MappedRule<Real>::MappedRule(int nodes, int power, bool root_ends) : m(power) {
  const scene::GaussLegendre rule = scene::gauss_legendre(nodes);
  for (int i = 0; i < nodes; ++i) {
    const double u = 0.5 * (1 + rule.node[i]), w = 0.5 * rule.weight[i];
    node.push_back(Real(root_ends ? u * u * (3 - 2 * u) : u));
    weight.push_back(Real(root_ends ? 6 * u * (1 - u) * w : w));
  }
}
template struct MappedRule<float>;
template struct MappedRule<double>;

double lit_airlight(const MappedRule<double>& rule, const PhaseForm& phase, double extinction, double albedo,
                    double intensity, double T, double h, const LitPart<double>& part) {
  if (!(extinction > 0) || !(part.length > 0)) return 0;
  const double shape = isotropic_integral(rule, phase, extinction, T, h, part);
  return albedo * extinction * intensity / (4 * pi) * std::exp(-extinction * (part.x0 + std::hypot(part.x0 - T, h))) *
         shape;
}

}  // namespace airlight::shadow_planes
