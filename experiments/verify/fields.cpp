// Densities, line integrals, bounds and phase functions.
#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/verify/readers.h"
#include "experiments/verify/vector_scene.h"
#include "scene/math/legendre_range.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_line.h"
#include "scene/media/spline_map.h"
#include "scene/media/voxel_grid.h"

namespace airlight::experiments::verification {
namespace {

// Samples ((7i + 13j + 31k + seed) mod 11) / 10. The grid holds the integers, which single precision keeps exactly; the
// tenth goes into the extinction.
std::shared_ptr<const scene::VoxelGrid> modular_grid(int n, int seed) {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = Eigen::Vector3i::Constant(n);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) grid->values.push_back(float((7 * i + 13 * j + 31 * k + seed) % 11));
  return grid;
}

// Coefficients ((5i + 17j + seed) mod 13) / 12 over unit cells, times exp(-kappa max(0, y)).
std::shared_ptr<const scene::Fogmap> modular_fogmap(int n, int seed, int degree, double kappa) {
  std::vector<double> coefficients;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) coefficients.push_back((5 * i + 17 * j + seed) % 13 / 12.0);
  auto fog = std::make_shared<scene::Fogmap>();
  fog->map = scene::SplineMap(degree, {{0, 0}, {n, n}}, coefficients);
  if (kappa > 0) fog->profile = scene::ExponentialFall{0, 1 / kappa};
  return fog;
}

// Coefficients (((7i + 13j + 31k + seed) mod 11) - 5) / (10 (1 + i + j + k)), the first one as given.
struct ModularSeries {
  scene::TensorShape shape;
  Eigen::VectorXd coefficients;
};
ModularSeries modular_series(const Value& in) {
  const int n = in["n"].integer_in(1, scene::LegendreBox::most), seed = in["seed"].integer_in(0, 1000000);
  ModularSeries series{{n, n, n}, Eigen::VectorXd(n * n * n)};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        series.coefficients[(i * n + j) * n + k] =
            ((7 * i + 13 * j + 31 * k + seed) % 11 - 5) / (10.0 * (1 + i + j + k));
  series.coefficients[0] = in["F000"].number();
  return series;
}
const Box series_box{Point3::Constant(-1), Point3::Constant(1)};

struct Segment {
  Ray ray;
  double length;
};
Segment segment_between(const Point3& p, const Point3& q) {
  const double length = (q - p).norm();
  return {{p, length > 0 ? Vec3((q - p) / length) : Vec3(Vec3::UnitZ())}, length};
}

}  // namespace

Check read_line_integral(const Value& v) {
  const Value in = v["in"];
  const scene::Gaussian g{in["b"].vector(), 1 / in["a"].number(), in["c"].number()};
  const Ray ray = ray_from(in["o"], in["dir"]);
  const double d = in["d"].number_or_infinite(), expected = v["value"].number();
  return {"", [=](VerifyProfile) {
            scene::GaussianSum sum;
            sum.gaussians = {g};
            // The specification of the vectors: 1e-12 relative, 1e-300 absolute.
            return Outcome{{relative("one Gaussian", expected, scene::line_integral(g, ray, d), 1e-12),
                            relative("sum of one", expected, scene::density_integral(sum, ray, {0, d}), 1e-12)}};
          }};
}

Check read_depth(const Value& v) {
  const Value in = v["in"];
  const auto medium =
      gaussian_fog(gaussians_from_objects(in["gaussians"]), in["beta0"].number(), 1, scene::Isotropic{});
  const Segment s = segment_between(in["p"].vector(), in["q"].vector());
  const double expected = v["value"].number();
  return {"", [=](VerifyProfile) {
            return Outcome{{relative("", expected, scene::optical_depth({medium}, s.ray, {0, s.length})[0], 1e-12)}};
          }};
}

// The integral of the polynomial is that of its clamped self less that of its clamped opposite.
Check series_depth(const Value& v, const Ray& ray, double length) {
  const Value expected = v["expected"];
  const ModularSeries series = modular_series(v["input"]);
  const double raw = expected["tau_raw"].number(), clamped = expected["tau_clamped"].number();
  const int changes = expected["sign_changes"].integer();
  const double accuracy = v["accuracy"]["abs"].number();
  return {"", [=](VerifyProfile) {
            const scene::LegendreBox field(series_box, series.shape, series.coefficients);
            const scene::LegendreBox opposite(series_box, series.shape, -series.coefficients);
            const double above = scene::density_integral(field, ray, {0, length});
            const Interval t = scene::extent(field, ray, {0, length});
            int found = 0;
            if (!t.empty()) {
              const scene::LegendreLine line(field, ray, t);
              for (const Interval& part : line.positive()) found += (part.lo > t.lo) + (part.hi < t.hi);
            }
            return Outcome{{absolute("tau clamped", clamped, above, accuracy),
                            absolute("tau", raw, above - scene::density_integral(opposite, ray, {0, length}), accuracy),
                            absolute("sign changes", changes, found, 0)}};
          }};
}

Check read_optical_depth(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const Segment s = segment_between(in["p"].vector(), in["q"].vector());
  if (in.has("F000")) return series_depth(v, s.ray, s.length);
  const int n = in["n"].integer_in(1, 256), seed = in["seed"].integer_in(0, 1000000);
  scene::Medium medium = fog(scene::Unbounded{}, 0.1, 1, scene::Isotropic{});
  if (in.has("degree")) {
    medium.sigma_t = Rgb::Ones();
    medium.field = modular_fogmap(n, seed, in["degree"].integer_in(0, 3), in["kappa"].number());
  } else {
    medium.field = modular_grid(n, seed);
  }
  const double tau = expected["tau"].number(), accuracy = v["accuracy"]["abs"].number();
  return {"", [=](VerifyProfile) {
            return Outcome{{absolute("tau", tau, scene::optical_depth({medium}, s.ray, {0, s.length})[0], accuracy)}};
          }};
}

// A cell of a fogmap of the optical depths, by default of 8 by 8 coefficients and seed 0. Bounds tighter than the hull of the coefficients
// are as rigorous.
Check cell_bounds(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const std::vector<double> cell = in["cell"].numbers(), hull = expected["hull"].numbers(),
                            sampled = expected["sampled"].numbers();
  if (cell.size() != 2 || hull.size() != 2 || sampled.size() != 2) v.complain("cell, hull and sampled of two numbers");
  const int degree = in["degree"].integer_in(0, 3), n = in.has("n") ? in["n"].integer_in(1, 256) : 8,
            seed = in.has("seed") ? in["seed"].integer_in(0, 1000000) : 0;
  const double accuracy = v["accuracy"]["abs"].number();
  return {
      "", [=](VerifyProfile) {
        constexpr double inside = 1e-12;  // no neighbour touches
        const double lo[2] = {cell[0] + inside, cell[1] + inside}, hi[2] = {cell[0] + 1 - inside, cell[1] + 1 - inside};
        const Interval bounds = modular_fogmap(n, seed, degree, 0)->map.bounds(lo, hi);
        return Outcome{{truth("within the hull", bounds.lo >= hull[0] - accuracy && bounds.hi <= hull[1] + accuracy),
                        truth("contains samples", bounds.lo <= sampled[0] && bounds.hi >= sampled[1])}};
      }};
}

// Half of the last of the 12 digits that these vectors give, where that is more than the accuracy they state.
double printed(double value, double accuracy) {
  return value == 0 ? accuracy : std::max(accuracy, 0.5 * std::pow(10.0, std::floor(std::log10(std::abs(value))) - 11));
}

// The hull of the Bernstein coefficients, and that samples and the bounds of the medium lie within.
Check series_bounds(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const ModularSeries series = modular_series(in);
  const Box part{in["lo"].vector(), in["hi"].vector()};
  const double least = expected["bernstein_min"].number(), greatest = expected["bernstein_max"].number();
  const double sampled[2] = {expected["sampled_min_25^3"].number(), expected["sampled_max_25^3"].number()};
  const double accuracy = v["accuracy"]["abs"].number();
  return {"", [=](VerifyProfile) {
            std::array<Eigen::MatrixXd, 3> restriction;
            for (int a = 0; a < 3; ++a)
              restriction[std::size_t(a)] =
                  scene::legendre_restriction(series.shape[std::size_t(a)], part.lo[a], part.hi[a]);
            const Interval hull = scene::legendre_range(
                scene::along_axes(restriction[0], restriction[1], restriction[2], series.coefficients, series.shape),
                series.shape);
            const Interval bounds =
                scene::density_bounds(scene::LegendreBox(series_box, series.shape, series.coefficients), part);
            return Outcome{{absolute("least", least, hull.lo, printed(least, accuracy)),
                            absolute("greatest", greatest, hull.hi, printed(greatest, accuracy)),
                            truth("contains samples",
                                  bounds.lo <= std::max(0.0, sampled[0]) + 1e-9 && bounds.hi >= sampled[1] - 1e-9)}};
          }};
}

Check read_field_bounds(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  if (in.has("F000")) return series_bounds(v);
  if (in.has("cell")) return cell_bounds(v);
  const auto medium = gaussian_fog(gaussians_from_rows(in["gaussians"]), in["b0"].number(), 1, scene::Isotropic{});
  const Box box{in["lo"].vector(), in["hi"].vector()};
  const double lower = expected["lower"].number(), upper = expected["upper"].number();
  const std::vector<double> sampled = expected["sampled"].numbers();
  if (sampled.size() != 2) expected["sampled"].complain("two numbers");
  const double accuracy = v["accuracy"]["abs"].number();
  return {
      "", [=](VerifyProfile) {
        const Interval bounds = scene::density_bounds(medium, box);
        return Outcome{{absolute("lower", lower, bounds.lo, accuracy), absolute("upper", upper, bounds.hi, accuracy),
                        truth("contains samples", bounds.lo <= sampled[0] && bounds.hi >= sampled[1])}};
      }};
}

Check read_phase_function(const Value& v) {
  struct Row {
    std::string name;
    scene::PhaseFunction phase;
    double k, g, forward, side, back, norm;
  };
  std::vector<Row> rows;
  const Value expected = v["expected"];
  for (const std::string& name : expected.fields()) {
    if (name == "note") continue;
    const Value e = expected[name];
    scene::PhaseFunction phase = scene::Hazy{};
    if (name == "murky")
      phase = scene::Murky{};
    else if (name != "hazy")
      e.complain("hazy and murky");
    rows.push_back({name, phase, e["K"].number(), e["g"].number(), e["p_fwd"].number(), e["p_side"].number(),
                    e["p_back"].number(), e["paper_norm"].number()});
  }
  const double accuracy = v["accuracy"]["rel"].number();
  return {"", [=](VerifyProfile) {
            Outcome out;
            for (const Row& r : rows) {
              // The lobe vanishes at c = -1, which leaves K / (4 pi); the printed form is the normalised one over K.
              const double k = 4 * pi * scene::phase_value(r.phase, -1);
              const auto add = [&](const char* what, double e, double got) {
                out.add(relative(r.name + " " + what, e, got, accuracy));
              };
              add("K", r.k, k);
              add("g", r.g, scene::mean_cosine(r.phase));
              add("p(1)", r.forward, scene::phase_value(r.phase, 1));
              add("p(0)", r.side, scene::phase_value(r.phase, 0));
              add("p(-1)", r.back, scene::phase_value(r.phase, -1));
              add("mean of printed form", r.norm, 1 / k);
            }
            return out;
          }};
}

}  // namespace airlight::experiments::verification
