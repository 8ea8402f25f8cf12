#include "scene/convert/fit_placement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

#include "scene/math/random.h"

namespace airlight::scene {
namespace {

struct Filled {
  int at[3];
  float value;
};

struct Part {
  std::size_t begin, end;
  double mass, mean_place[3], spread[3], urgency;
};

Part part_of(const std::vector<Filled>& voxels, std::size_t begin, std::size_t end) {
  Part part{begin, end, 0, {0, 0, 0}, {0, 0, 0}, 0};
  double squares = 0, place2[3] = {0, 0, 0};
  for (std::size_t i = begin; i < end; ++i) {
    const double m = voxels[i].value;
    part.mass += m;
    squares += m * m;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = voxels[i].at[axis];
      part.mean_place[axis] += m * x;
      place2[axis] += m * x * x;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    part.mean_place[axis] /= part.mass;
    part.spread[axis] = std::max(0.0, place2[axis] / part.mass - part.mean_place[axis] * part.mean_place[axis]);
  }
  const double mean = part.mass / double(end - begin);
  part.urgency = end - begin > 1 ? squares - mean * part.mass + 0.5 * squares : 0;
  return part;
}

}  // namespace

std::vector<Gaussian> place_gaussians(const Eigen::Vector3i& size, const float* values, double scale, int n,
                                      const FitBounds& bounds) {
  std::vector<Filled> voxels;
  std::size_t at = 0;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x, ++at)
        if (values[at] > 0) voxels.push_back({{x, y, z}, float(values[at] * scale)});
  std::vector<Gaussian> gaussians;
  if (voxels.empty() || n <= 0) return gaussians;

  const auto less = [](const Part& a, const Part& b) {
    return a.urgency != b.urgency ? a.urgency < b.urgency : a.begin > b.begin;
  };
  std::priority_queue<Part, std::vector<Part>, decltype(less)> parts(less);
  parts.push(part_of(voxels, 0, voxels.size()));
  while (int(parts.size()) < n && parts.top().urgency > 0) {
    const Part part = parts.top();
    parts.pop();
    const int axis = int(std::max_element(part.spread, part.spread + 3) - part.spread);
    const auto first = voxels.begin() + std::ptrdiff_t(part.begin), last = voxels.begin() + std::ptrdiff_t(part.end);
    // Across the mean place, which halves the mass but for skewness; ties and one-sided parts at the middle of the list.
    auto middle = std::partition(first, last, [&](const Filled& v) { return v.at[axis] <= part.mean_place[axis]; });
    if (middle == first || middle == last) middle = first + (last - first) / 2;
    const std::size_t cut = std::size_t(middle - voxels.begin());
    parts.push(part_of(voxels, part.begin, cut));
    parts.push(part_of(voxels, cut, part.end));
  }
  for (; !parts.empty(); parts.pop()) {
    const Part& part = parts.top();
    const double count = double(part.end - part.begin);
    Gaussian g;
    for (int axis = 0; axis < 3; ++axis) g.center[axis] = part.mean_place[axis];
    g.width = 0.6 * std::cbrt(count);
    g.amplitude = 0.7 * part.mass / count;
    clamp_to(bounds, g);
    gaussians.push_back(g);
  }
  return gaussians;
}

Placed place_at(const FitObjective<float>& objective, const FitBounds& bounds, const Point3& x) {
  Placed best;
  for (int k = 0; k < 5; ++k) {
    Gaussian g{x, bounds.widths.lo * std::pow(bounds.widths.hi / bounds.widths.lo, k / 5.0), 0};
    const auto [with_error, with_itself] = objective.correlation(g);
    if (!(with_itself > 0)) continue;
    g.amplitude = -with_error / with_itself;
    clamp_to(bounds, g);
    const double gain = -2 * g.amplitude * with_error - g.amplitude * g.amplitude * with_itself;
    if (gain > best.gain) best = {g, gain};
  }
  return best;
}

std::vector<Point3> missing_places(const FitObjective<float>& objective, const FitBounds& bounds, std::size_t most) {
  std::vector<typename FitObjective<float>::Missing> cells =
      objective.missing(std::clamp(int(std::lround(2 * bounds.widths.lo)), 1, 8));
  most = std::min(most, cells.size());
  std::partial_sort(cells.begin(), cells.begin() + std::ptrdiff_t(most), cells.end(),
                    [](const auto& a, const auto& b) { return a.sum != b.sum ? a.sum < b.sum : a.cell < b.cell; });
  std::vector<Point3> places;
  for (std::size_t i = 0; i < most; ++i) places.push_back(cells[i].center);
  return places;
}

std::vector<Point3> random_places(const Eigen::Vector3i& size, const float* values, std::uint32_t seed,
                                  std::size_t most) {
  std::vector<std::size_t> filled;
  for (std::size_t i = 0; i < std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]); ++i)
    if (values[i] > 0) filled.push_back(i);
  std::vector<Point3> places;
  for (std::uint32_t k = 0; k < most && !filled.empty(); ++k) {
    const double share = uniform32(philox4x32_10({k, seed, 0, 0}, {2008, 1})[0]);
    const std::size_t i = filled[std::size_t(share * double(filled.size()))];
    const auto nx = std::size_t(size[0]), ny = std::size_t(size[1]);
    places.emplace_back(double(i % nx), double(i / nx % ny), double(i / nx / ny));
  }
  return places;
}

int teleport(FitObjective<float>& objective, const FitBounds& bounds, std::vector<Gaussian>& gaussians, int most,
             const std::vector<Point3>& given) {
  const std::vector<Gaussian> before = gaussians;
  const double value = objective.value(gaussians);
  std::vector<std::size_t> order(gaussians.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto loss = [&](std::size_t i) {
    return gaussians[i].amplitude * gaussians[i].amplitude * std::pow(gaussians[i].width, 3);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return loss(a) < loss(b); });
  std::size_t moved = 0;
  for (const Point3& place : given.empty() ? missing_places(objective, bounds, 2 * std::size_t(most)) : given) {
    if (moved == std::min(std::size_t(most), order.size())) break;
    Gaussian& g = gaussians[order[moved]];
    const auto [with_error, with_itself] = objective.correlation(g);
    const double lost = g.amplitude * (-2 * with_error + g.amplitude * with_itself);
    const Placed placed = place_at(objective, bounds, place);
    if (!(placed.gain > std::max(lost, 0.0))) continue;
    objective.add({g.center, g.width, -g.amplitude});
    objective.add(placed.gaussian);
    g = placed.gaussian;
    ++moved;
  }
  if (moved == 0 || objective.value(gaussians) < value) return int(moved);
  gaussians = before;
  return 0;
}

}  // namespace airlight::scene
