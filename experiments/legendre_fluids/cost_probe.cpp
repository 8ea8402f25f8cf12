#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <ctime>

#include "experiments/legendre_fluids/fluid_probes.h"
#include "experiments/stable_fluids/stages.h"
#include "methods/legendre_fluids/confined_fluid.h"
#include "methods/legendre_fluids/paper_operators.h"
#include "scene/math/dense.h"

namespace airlight::experiments {
namespace {

using Eigen::MatrixXd;
using legendre_fluids::Array;
using legendre_fluids::ConfinedFluid;
using legendre_fluids::ConfinedSpace;
using scene::TensorShape;

const std::vector<int> sizes = {4, 6, 8, 10, 12, 16, 20, 24, 32};

// Processor time of this thread [s].
double processor_time() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

Array noise(int size, unsigned seed) {
  Array a(size);
  for (int i = 0; i < size; ++i) a[i] = 2 * uniform32(philox4x32_10({std::uint32_t(i), seed, 0, 0}, {3, 0})[0]) - 1;
  return a;
}

// The matrix M_G of equation 10 times F, from the triple products that are not 0.
class SparseProduct {
 public:
  // Share of zeros among all products of three polynomials along an axis; in three dimensions, among
  // products of three triples.
  double share_of_zeros() const { return 1 - double(entries_.size()) / std::pow(double(n_), 3); }
  double share_of_zeros_3d() const { return 1 - std::pow(1 - share_of_zeros(), 3); }

  explicit SparseProduct(int n) : n_(n) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k)
          if (const double t = scene::legendre_triple(i, j, k); t != 0) entries_.push_back({i, j, k, t});
  }
  Array operator()(const Array& f, const Array& g) const {
    MatrixXd m = MatrixXd::Zero(f.size(), f.size());
    for (const Entry& x : entries_)
      for (const Entry& y : entries_)
        for (const Entry& z : entries_)
          m(at(x.i, y.i, z.i), at(x.j, y.j, z.j)) += x.t * y.t * z.t * g[at(x.k, y.k, z.k)];
    return m * f;
  }

 private:
  struct Entry {
    int i, j, k;
    double t;
  };
  int at(int x, int y, int z) const { return (x * n_ + y) * n_ + z; }
  int n_;
  std::vector<Entry> entries_;
};

MatrixXd dense(int size, const std::function<Array(const Array&)>& apply) {
  MatrixXd m(size, size);
  for (int i = 0; i < size; ++i) m.col(i) = apply(Array::Unit(size, i));
  return m;
}

// The part to time, with everything prepared that is needed once.
std::function<void()> part_of(const std::string& part, int n) {
  const auto space = std::make_shared<ConfinedSpace>(3, n);
  const Array u = n > 1 ? space->project(noise(space->size(), 1)) : Array();
  if (part == "step") {
    auto fluid = std::make_shared<ConfinedFluid>(3, n, Vec3::Ones(), legendre_fluids::Material{},
                                                 legendre_fluids::ConfinedOptions{});
    fluid->velocity = u / u.norm();
    const double dt = 1 / (n * (1 + fluid->greatest_speed()));
    return [=] { fluid->advance(dt); };
  }
  if (part == "projection") {
    const Array v = noise(space->size(), 2);
    return [=] { space->project(v); };
  }
  const Array f = noise(space->scalars(), 3), g = noise(space->scalars(), 4);
  const TensorShape s = space->shape();
  if (part == "product") return [=] { scene::legendre_product(f, s, g, s, s); };
  if (part == "sparse_product") {
    const auto product = std::make_shared<SparseProduct>(n);
    return [=] { (*product)(f, g); };
  }
  if (part == "dense_poisson") {
    const auto laplacian = std::make_shared<legendre_fluids::PaperLaplacian>(3, n, Vec3::Ones());
    const auto m = std::make_shared<MatrixXd>(
        dense(space->scalars(), [&](const Array& c) -> Array { return c - 1e-3 * (*laplacian)(c); }));
    return [=] { scene::SquareFactors(*m).solve(f); };
  }
  legendre_fluids::PaperAdvection advection(3, n, legendre_fluids::Truncation::chebyshev);
  advection.set_velocity({f, g, f});
  const auto m =
      std::make_shared<MatrixXd>(dense(space->scalars(), [&](const Array& c) -> Array { return advection(c); }));
  return [=] { Eigen::EigenSolver<MatrixXd> solver(*m); };
}

// Slope of log y over log x, by least squares.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(y[i]);
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  const double n = double(x.size());
  return n > 1 ? (n * sxy - sx * sy) / (n * sxx - sx * sx) : std::nan("");
}

}  // namespace

std::string LegendreCost::about() const {
  return "time of a part of Legendre fluids in 3D over n, and its exponent; one thread";
}

std::vector<scene::SettingSpec> LegendreCost::settings() const {
  return {scene::choice_setting(
              "part", "step", {"step", "projection", "product", "sparse_product", "dense_poisson", "eigen"},
              "Runge-Kutta step, projection and product with structure; M_G from triple products; LU; equation 14"),
          scene::integer_setting("least", "4", 4, 32, "coefficients along an axis"),
          scene::integer_setting("greatest", "16", 4, 32, "coefficients along an axis"),
          scene::integer_setting("runs", "31", 1, 10000, "of each"),
          scene::real_setting("budget", "0.3", 0, 1e6, "seconds after which no further run of a size begins")};
}

std::vector<std::string> LegendreCost::figures() const {
  std::vector<std::string> names = {"exponent", "exponent_of_coefficients", "zeros_64", "zeros_3d_64"};
  for (const int n : sizes) names.push_back(fmt::format("ms_{}", n));
  return names;
}

Findings LegendreCost::run(const ProbeInput&, const scene::Settings& s, const scene::Execution&) const {
  Findings found;
  std::vector<double> all_n, times;
  for (const int n : sizes) {
    if (n < s.integer("least") || n > s.integer("greatest")) continue;
    const auto part = part_of(s.text("part"), n);
    part();  // memory that is kept
    std::vector<double> ms;
    repeat(int(s.integer("runs")), s.real("budget"), [&] {
      // Parts that are too short for the clock are repeated.
      int rounds = 0;
      const double start = processor_time();
      double spent = 0;
      for (; spent < 2e-4; spent = processor_time() - start) part(), ++rounds;
      ms.push_back(1e3 * spent / rounds);
    });
    found.figures.push_back(measured(fmt::format("ms_{}", n), ms));
    all_n.push_back(n), times.push_back(found.figures.back().value);
  }
  const double exponent = slope(all_n, times);
  found.figures.push_back(exactly("exponent", exponent));
  found.figures.push_back(exactly("exponent_of_coefficients", exponent / 3));
  if (s.text("part") == "sparse_product") {
    found.figures.push_back(exactly("zeros_64", SparseProduct(64).share_of_zeros()));
    found.figures.push_back(exactly("zeros_3d_64", SparseProduct(4).share_of_zeros_3d()));
  }
  found.columns = {{"n", all_n}, {"ms", times}};
  return found;
}

}  // namespace airlight::experiments
