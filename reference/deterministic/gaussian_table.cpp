#include "reference/deterministic/gaussian_table.h"

#include <cmath>

namespace airlight::deterministic {

std::optional<GaussianTable> make_gaussian_table(const scene::GaussianSum& sum) {
  GaussianTable table;
  table.constant = sum.constant;
  table.cutoff = sum.cutoff;
  for (const scene::Gaussian& g : sum.gaussians) {
    if (g.amplitude < 0) return std::nullopt;
    if (g.amplitude == 0) continue;
    const double scaled = 0.5 * std::sqrt(pi) * g.width * g.amplitude;
    table.x.push_back(g.center[0]);
    table.y.push_back(g.center[1]);
    table.z.push_back(g.center[2]);
    table.inverse_width.push_back(1 / g.width);
    table.amplitude.push_back(g.amplitude);
    table.scaled_amplitude.push_back(scaled);
    table.log_scaled.push_back(std::log(scaled));
  }
  return table;
}

}  // namespace airlight::deterministic
