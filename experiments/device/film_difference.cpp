#include "experiments/device/film_difference.h"

#include <algorithm>
#include <cmath>

namespace airlight::experiments {

double difference_quantile(const scene::Film& a, const scene::Film& b, const std::string& layer, double share) {
  const std::vector<float>&x = a.layer(layer), &y = b.layer(layer);
  const double most = *std::max_element(x.begin(), x.end());
  std::vector<double> errors;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) return infinity;
    errors.push_back(std::abs(double(y[i]) - x[i]) / (std::abs(x[i]) + 0.01 * most + 1e-300));
  }
  std::sort(errors.begin(), errors.end());
  return errors[std::size_t(share * double(errors.size() - 1))];
}

}  // namespace airlight::experiments
