#include "reference/deterministic/density_along_ray.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_line.h"
#include "scene/media/voxel_grid.h"

namespace airlight::deterministic {
namespace {

using scene::GaussianSum;
using scene::GridPointer;
using scene::Homogeneous;
using scene::Medium;
using scene::VoxelGrid;

class HomogeneousAlongRay final : public DensityAlongRay {
 public:
  HomogeneousAlongRay(Interval extent, double density) : DensityAlongRay(extent), density_(density) {}
  double density(double) const override { return density_; }
  double integral(double t) const override {
    return t > extent_.lo ? density_ * (std::min(t, extent_.hi) - extent_.lo) : 0;
  }
  void add_features(std::vector<Feature>& features) const override {
    features.push_back({extent_.lo, 0});
    features.push_back({extent_.hi, 0});
  }

 private:
  double density_;
};

// Zhou et al. 2007, Eq. 31, with the part that depends only on the ray done once.
class GaussiansAlongRay final : public DensityAlongRay {
 public:
  GaussiansAlongRay(Interval extent, const GaussianTable& table, const Ray& ray, double cull, double sigma)
      : DensityAlongRay(extent), constant_(table.constant) {
    std::vector<double> greatest(table.size());
    double overall = constant_;
    for (std::size_t i = 0; i < table.size(); ++i) {
      const Vec3 q = Vec3(table.x[i], table.y[i], table.z[i]) - ray.origin;
      const double along = q.dot(ray.direction);
      const double a = table.inverse_width[i];
      const double squared = a * a * (q - along * ray.direction).squaredNorm();
      const double reach = a * (std::clamp(along, extent.lo, extent.hi) - along);
      greatest[i] = table.amplitude[i] * std::exp(-squared - reach * reach);
      overall = std::max(overall, greatest[i]);
      Term term{along, a, squared, table.amplitude[i] * std::exp(-squared), extent};
      term.scaled = 0.5 * std::sqrt(pi) / a * term.peak;
      if (table.cutoff < infinity) {
        const double rest = table.cutoff * table.cutoff - squared;
        const double half = rest > 0 ? std::sqrt(rest) / a : 0;
        term.support = intersect(extent, {along - half, along + half});
        if (term.support.empty()) greatest[i] = 0;
      }
      terms_.push_back(term);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < terms_.size(); ++i) {
      if (!(greatest[i] > cull * overall) && !(greatest[i] > 0 && 2 * sigma * terms_[i].scaled > cull)) continue;
      Term& term = terms_[kept++] = terms_[i];
      term.start = term.a * (term.support.lo - term.center);
      term.start_value = term.start > 0 ? std::erfc(term.start) : std::erf(term.start);
    }
    terms_.resize(kept);
  }

  double density(double t) const override {
    double sum = constant_;
    for (const Term& term : terms_) {
      if (t < term.support.lo || t > term.support.hi) continue;
      const double u = term.a * (t - term.center);
      sum += term.peak * std::exp(-u * u);
    }
    return sum;
  }

  double integral(double t) const override {
    if (!(t > extent_.lo)) return 0;
    const double end = std::min(t, extent_.hi);
    double sum = constant_ > 0 ? constant_ * (end - extent_.lo) : 0;
    for (const Term& term : terms_) {
      if (!(end > term.support.lo)) continue;
      const double v = term.a * (std::min(end, term.support.hi) - term.center);
      sum += term.scaled * (term.start > 0 ? term.start_value - std::erfc(v) : std::erf(v) - term.start_value);
    }
    return sum;
  }

  void add_features(std::vector<Feature>& features) const override {
    features.push_back({extent_.lo, 0});
    features.push_back({extent_.hi, 0});
    for (const Term& term : terms_) {
      for (const double k : {-4.0, -2.4, -1.2, 0.0, 1.2, 2.4, 4.0})
        features.push_back({term.center + k / term.a, 1 / term.a});
      if (term.support.lo > extent_.lo) features.push_back({term.support.lo, 0});
      if (term.support.hi < extent_.hi) features.push_back({term.support.hi, 0});
    }
  }

 private:
  struct Term {
    double center;   // along the ray [m]
    double a;        // [1/m]
    double squared;  // squared distance of the ray, in widths
    double peak;     // amplitude, then density on the ray at `center`
    Interval support;
    double scaled = 0;  // peak sqrt(pi) / (2 a)
    double start = 0;   // lower end in widths from the centre, and its erf or erfc
    double start_value = 0;
  };
  std::vector<Term> terms_;
  double constant_;
};

// A trilinear density is a cubic inside a voxel: four samples give it, and its integral, to rounding.
class GridAlongRay final : public DensityAlongRay {
 public:
  GridAlongRay(Interval extent, const VoxelGrid& grid, const Ray& ray) : DensityAlongRay(extent) {
    const Point3 origin = scene::world_to_sample(grid, ray.origin);
    const Vec3 step = scene::world_to_sample(grid, ray.at(1)) - origin;
    std::vector<double> cuts{extent.lo, extent.hi};
    for (int axis = 0; axis < 3; ++axis) {
      if (step[axis] == 0) continue;
      for (int plane = -1; plane <= grid.size[axis]; ++plane) {
        const double t = (plane - origin[axis]) / step[axis];
        if (t > extent.lo && t < extent.hi) cuts.push_back(t);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    double sum = 0;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      Cell cell;
      cell.lo = cuts[i];
      cell.length = cuts[i + 1] - cuts[i];
      if (!(cell.length > 0)) continue;
      cell.before = sum;
      // Interpolation at the four Chebyshev points of [0, 1]: no sample on a face, where rounding picks the voxel.
      static const std::array<double, 4> node = {0.038060233744356624, 0.30865828381745508, 0.69134171618254492,
                                                 0.96193976625564337};
      std::array<double, 4> f;
      for (int k = 0; k < 4; ++k) f[k] = scene::density(grid, ray.at(cell.lo + node[k] * cell.length));
      // Newton's divided differences, then the monomials of s.
      std::array<double, 4> d = f;
      for (int order = 1; order < 4; ++order)
        for (int k = 3; k >= order; --k) d[k] = (d[k] - d[k - 1]) / (node[k] - node[k - order]);
      cell.c = {d[3], 0, 0, 0};
      for (int k = 2; k >= 0; --k) {
        for (int j = 3; j > 0; --j) cell.c[j] = cell.c[j - 1] - node[k] * cell.c[j];
        cell.c[0] = d[k] - node[k] * cell.c[0];
      }
      cell.empty = f[0] == 0 && f[1] == 0 && f[2] == 0 && f[3] == 0;
      cells_.push_back(cell);
      if (!cell.empty) sum += cell.integral(1);
    }
    total_ = sum;
  }

  double density(double t) const override {
    const Cell& cell = find(t);
    return cell.empty ? 0 : std::max(0.0, cell.value((t - cell.lo) / cell.length));
  }

  double integral(double t) const override {
    if (cells_.empty() || !(t > extent_.lo)) return 0;
    if (t >= extent_.hi) return total_;
    const Cell& cell = find(t);
    return cell.before + (cell.empty ? 0 : cell.integral((t - cell.lo) / cell.length));
  }

  void add_features(std::vector<Feature>& features) const override {
    for (const Cell& cell : cells_) features.push_back({cell.lo, 0});
    features.push_back({extent_.hi, 0});
  }

  bool fine() const override { return cells_.size() > 12; }

 private:
  struct Cell {
    double lo = 0, length = 0;
    double before = 0;                    // integral up to lo
    std::array<double, 4> c{0, 0, 0, 0};  // density at s = (t - lo) / length
    bool empty = true;
    double value(double s) const { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); }
    double integral(double s) const { return length * s * (c[0] + s * (c[1] / 2 + s * (c[2] / 3 + s * c[3] / 4))); }
  };
  const Cell& find(double t) const {
    const auto after = std::upper_bound(cells_.begin(), cells_.end(), t,
                                        [](double value, const Cell& cell) { return value < cell.lo; });
    return after == cells_.begin() ? cells_.front() : *(after - 1);
  }
  std::vector<Cell> cells_;
  double total_ = 0;
};

// A fogmap: exact integrals, kept at the places where a new piece begins.
class FogmapAlongRay final : public DensityAlongRay {
 public:
  FogmapAlongRay(Interval extent, const scene::Fogmap& fog, const Ray& ray)
      : DensityAlongRay(extent), fog_(fog), ray_(ray), cuts_(scene::smooth_between(fog, ray, extent)) {
    cuts_.insert(cuts_.begin(), extent.lo);
    before_.push_back(0);
    for (std::size_t i = 0; i + 1 < cuts_.size(); ++i)
      before_.push_back(before_[i] + scene::density_integral(fog_, ray_, {cuts_[i], cuts_[i + 1]}));
  }
  double density(double t) const override { return scene::density(fog_, ray_.at(t)); }
  double integral(double t) const override {
    if (!(t > extent_.lo)) return 0;
    t = std::min(t, extent_.hi);
    const std::size_t i = std::size_t(std::upper_bound(cuts_.begin(), cuts_.end(), t) - cuts_.begin()) - 1;
    return before_[i] + scene::density_integral(fog_, ray_, {cuts_[i], t});
  }
  void add_features(std::vector<Feature>& features) const override {
    for (const double cut : cuts_) features.push_back({cut, 0});
    features.push_back({extent_.hi, 0});
  }
  bool fine() const override { return cuts_.size() > 12; }

 private:
  const scene::Fogmap& fog_;
  Ray ray_;
  std::vector<double> cuts_, before_;  // where a piece begins, and the integral up to there
};

// A Legendre box: a polynomial, with a kink where it is clamped.
class LegendreAlongRay final : public DensityAlongRay {
 public:
  LegendreAlongRay(Interval extent, const scene::LegendreBox& field, const Ray& ray)
      : DensityAlongRay(extent), line_(field, ray, extent) {}
  double density(double t) const override { return line_.density(t); }
  double integral(double t) const override { return t > extent_.lo ? line_.integral(std::min(t, extent_.hi)) : 0; }
  void add_features(std::vector<Feature>& features) const override {
    features.push_back({extent_.lo, 0});
    features.push_back({extent_.hi, 0});
    for (const Interval& part : line_.positive()) {
      features.push_back({part.lo, 0});
      features.push_back({part.hi, 0});
    }
  }

 private:
  scene::LegendreLine line_;
};

// Gaussians of which some are negative: no sum of single integrals, since the density is clamped at 0. Slower.
class ClampedGaussiansAlongRay final : public DensityAlongRay {
 public:
  ClampedGaussiansAlongRay(Interval extent, const Medium& medium, const GaussianSum& sum, const Ray& ray)
      : DensityAlongRay(extent), medium_(medium), sum_(sum), ray_(ray) {}
  double density(double t) const override { return scene::density(sum_, ray_.at(t)); }
  double integral(double t) const override { return scene::density_integral(medium_, ray_, {0, t}); }
  void add_features(std::vector<Feature>& features) const override {
    features.push_back({extent_.lo, 0});
    features.push_back({extent_.hi, 0});
    for (const scene::Gaussian& g : sum_.gaussians) {
      const double center = (g.center - ray_.origin).dot(ray_.direction);
      for (const double k : {-2.4, -1.2, 0.0, 1.2, 2.4}) features.push_back({center + k * g.width, g.width});
    }
  }

 private:
  const Medium& medium_;
  const GaussianSum& sum_;
  Ray ray_;
};

}  // namespace

std::unique_ptr<DensityAlongRay> density_along_ray(const Medium& medium, const GaussianTable* table, const Ray& ray,
                                                   double t_end, double cull) {
  if (!(medium.sigma_t.maxCoeff() > 0)) return nullptr;
  // Beyond a sum of Gaussians' support its density counts as zero: a light there is in vacuum, and a ray through it
  // finite.
  const Interval inside = scene::extent(medium, ray, {0, t_end});
  if (inside.empty()) return nullptr;
  using Result = std::unique_ptr<DensityAlongRay>;
  return scene::match(
      medium.field,
      [&](const Homogeneous& uniform) -> Result {
        if (!(uniform.density > 0)) return nullptr;
        return std::make_unique<HomogeneousAlongRay>(inside, uniform.density);
      },
      [&](const GaussianSum& sum) -> Result {
        if (!table) return std::make_unique<ClampedGaussiansAlongRay>(inside, medium, sum, ray);
        if (table->size() == 0 && table->constant == 0) return nullptr;
        return std::make_unique<GaussiansAlongRay>(inside, *table, ray, cull, medium.sigma_t.maxCoeff());
      },
      [&](const GridPointer& grid) -> Result { return std::make_unique<GridAlongRay>(inside, *grid, ray); },
      [&](const scene::FogmapPointer& fog) -> Result { return std::make_unique<FogmapAlongRay>(inside, *fog, ray); },
      [&](const scene::LegendrePointer& box) -> Result {
        return std::make_unique<LegendreAlongRay>(inside, *box, ray);
      },
      [&](const scene::FittedPointer& fitted) -> Result {
        return std::make_unique<GridAlongRay>(inside, fitted->grid, ray);
      });
}

}  // namespace airlight::deterministic
