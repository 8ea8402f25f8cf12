// The publication's diffusion equation at the centres of Gaussians: the oracle's matrices, what its rows must add up to, its solver.
#include "methods/compensated_ray_marching/diffusion_system.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "scene/base/error.h"
#include "tests/oracle_vectors.h"

namespace diffusion_system_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::compensated_ray_marching;

namespace {

// Smoke without order: a chain of Gaussians that overlap.
std::vector<scene::Gaussian> chain(int n) {
  std::vector<scene::Gaussian> gaussians;
  for (int i = 0; i < n; ++i)
    gaussians.push_back({Point3(0.5 + 0.3 * std::sin(1.3 * i), 0.5 + 0.3 * std::cos(0.7 * i), double(i) / n),
                         0.05 + 0.02 * std::sin(2.1 * i), 0.5 + 0.4 * std::cos(0.9 * i)});
  return gaussians;
}

}  // namespace

TEST_CASE("diffusion at the centres: the oracle's matrices", "[compensated_ray_marching]") {
  for (const json& v : vectors_of("compensated_ray_marching", "collocation_matrix")) {
    const json& in = v.at("input");
    std::vector<scene::Gaussian> gaussians;
    for (const json& b : in.at("rbf_x_y_z_r_w")) gaussians.push_back({vec(b), number(b[3]), number(b[4])});
    std::vector<LinearSource> sources;
    for (const json& f : in.at("Jss_sh_order2")) {
      const std::array<double, 4> harmonics{number(f[0]), number(f[1]), number(f[2]), number(f[3])};
      sources.push_back(linear_source(harmonics.data()));
    }
    for (const auto& [name, form] :
         {std::pair("corrected", DiffusionForm::corrected), std::pair("as_printed", DiffusionForm::as_printed)}) {
      const DiffusionSystem system = diffusion_system(gaussians, sources, number(in.at("sigma_t")),
                                                      number(in.at("albedo")), number(in.at("g")), form);
      const json& expected = v.at("expected").at(name);
      CAPTURE(v.at("id").get<std::string>(), name);
      for (Eigen::Index h = 0; h < system.right.size(); ++h) {
        CHECK(system.right[h] == Approx(number(expected.at("b")[std::size_t(h)])).epsilon(1e-10).margin(1e-12));
        for (Eigen::Index l = 0; l < system.right.size(); ++l)
          CHECK(system.matrix(h, l) ==
                Approx(number(expected.at("A")[std::size_t(h)][std::size_t(l)])).epsilon(1e-10).margin(1e-12));
      }
    }
  }
}

// The box is closed: of an even radiance nothing flows, and what is absorbed must be made.
TEST_CASE("diffusion at the centres: rows add up to the absorption", "[compensated_ray_marching]") {
  const std::vector<scene::Gaussian> gaussians = chain(40);
  const scene::GaussianSum sum{gaussians, 0, infinity};
  const double albedo = 0.9, sigma_t = 12.6;
  const std::vector<LinearSource> sources(gaussians.size(), {0.3, Vec3::Zero()});
  const DiffusionSystem system = diffusion_system(gaussians, sources, sigma_t, albedo, 0.3, DiffusionForm::corrected);
  for (Eigen::Index h = 0; h < system.right.size(); ++h)
    CHECK(system.matrix.row(h).sum() ==
          Approx(-(1 - albedo) * sigma_t * density(sum, gaussians[std::size_t(h)].center)).epsilon(1e-9));
  // So an even source has an even answer, that of smoke without end.
  const Eigen::VectorXd exact = system.matrix.partialPivLu().solve(system.right);
  CHECK((exact.array() - 0.3 / (1 - albedo)).abs().maxCoeff() < 1e-8);
  for (const json& v : vectors_of("compensated_ray_marching", "diffusion_uniform_source"))
    CHECK(number(v.at("input").at("single_scatter_mean_source")) / (1 - number(v.at("input").at("albedo"))) ==
          Approx(number(v.at("expected"))));
}

TEST_CASE("diffusion at the centres: conjugate gradients and LSQR", "[compensated_ray_marching]") {
  const std::vector<scene::Gaussian> gaussians = chain(60);
  std::vector<LinearSource> sources;
  for (int i = 0; i < 60; ++i) sources.push_back({1 + 0.5 * std::sin(0.4 * i), Vec3(0.1, 0.2 * std::cos(i), 0.3)});
  const DiffusionSystem system = diffusion_system(gaussians, sources, 12.6, 0.9, 0, DiffusionForm::corrected);
  const Eigen::VectorXd exact = system.matrix.partialPivLu().solve(system.right), zero = Eigen::VectorXd::Zero(60);
  for (const LeastSquaresSolver solver : {LeastSquaresSolver::cg, LeastSquaresSolver::cg_scaled,
                                          LeastSquaresSolver::lsqr, LeastSquaresSolver::lsqr_scaled}) {
    const LeastSquares found = solve_least_squares(system, zero, 10000, 1e-12, solver);
    CAPTURE(int(solver), found.iterations, found.residual);
    CHECK(found.residual <= 1e-12);
    CHECK((found.x - exact).norm() < 1e-5 * exact.norm());
    const LeastSquares warm = solve_least_squares(system, exact, 100, 1e-6, solver);
    CHECK(warm.iterations <= 1);
  }
  // CG and LSQR take equal steps up to rounding, which is small after four steps. The residual that LSQR
  // estimates is the true residual.
  for (const auto& [cg, lsqr] : {std::pair(LeastSquaresSolver::cg, LeastSquaresSolver::lsqr),
                                 std::pair(LeastSquaresSolver::cg_scaled, LeastSquaresSolver::lsqr_scaled)}) {
    const LeastSquares a = solve_least_squares(system, zero, 4, 0, cg),
                       b = solve_least_squares(system, zero, 4, 0, lsqr);
    CHECK(b.iterations == 4);
    CHECK((a.x - b.x).norm() < 1e-9 * a.x.norm());
    CHECK(a.residual == Approx(b.residual).epsilon(1e-6));
  }
  const LeastSquares some = solve_least_squares(system, zero, 30, 0, LeastSquaresSolver::lsqr);
  const Eigen::VectorXd slope = system.matrix.transpose() * (system.right - system.matrix * some.x);
  CHECK(some.residual == Approx(slope.norm() / (system.matrix.transpose() * system.right).norm()).epsilon(1e-6));
  // Rows of length 1 take fewer iterations.
  CHECK(solve_least_squares(system, zero, 10000, 1e-8, LeastSquaresSolver::lsqr_scaled).iterations <
        0.8 * solve_least_squares(system, zero, 10000, 1e-8, LeastSquaresSolver::lsqr).iterations);
  // Forty from nothing are far from the answer: the publication's count holds for warm starts.
  const LeastSquares cold = solve_least_squares(system, zero, 40, 0, LeastSquaresSolver::cg);
  CHECK(cold.iterations == 40);
  CHECK((cold.x - exact).norm() > 0.05 * exact.norm());
}

TEST_CASE("diffusion at the centres: extremes", "[compensated_ray_marching]") {
  const std::vector<LinearSource> one(1, {0.3, Vec3::Zero()}), two(2, {0.3, Vec3::Zero()});
  SECTION("one Gaussian") {
    const DiffusionSystem s = diffusion_system({{Point3::Zero(), 0.1, 0.7}}, one, 5, 0.8, 0, DiffusionForm::corrected);
    CHECK(s.matrix(0, 0) == Approx(-0.2 * 5 * 0.7));
    CHECK(solve_least_squares(s, Eigen::VectorXd::Zero(1), 10, 1e-12, LeastSquaresSolver::lsqr_scaled).x[0] ==
          Approx(0.3 / 0.2));
  }
  SECTION("two at one place: the shortest answer") {
    const scene::Gaussian g{Point3::Zero(), 0.1, 0.7};
    for (const LeastSquaresSolver solver : {LeastSquaresSolver::cg, LeastSquaresSolver::lsqr}) {
      const LeastSquares found = solve_least_squares(diffusion_system({g, g}, two, 5, 0.8, 0, DiffusionForm::corrected),
                                                     Eigen::VectorXd::Zero(2), 50, 1e-12, solver);
      CHECK(found.x[0] == Approx(1.5));
      CHECK(found.x[1] == Approx(1.5));
    }
  }
  SECTION("no light") {
    const std::vector<LinearSource> dark(1);
    for (const LeastSquaresSolver solver : {LeastSquaresSolver::cg, LeastSquaresSolver::lsqr}) {
      const LeastSquares found =
          solve_least_squares(diffusion_system({{Point3::Zero(), 0.1, 0.7}}, dark, 5, 0.8, 0, DiffusionForm::corrected),
                              Eigen::VectorXd::Zero(1), 50, 1e-12, solver);
      CHECK(found.x[0] == 0);
      CHECK(found.iterations == 0);
    }
  }
  SECTION("no albedo") {
    const std::vector<scene::Gaussian> g{{Point3::Zero(), 0.1, 0.7}};
    CHECK_THROWS_AS(diffusion_system(g, one, 5, 0, 0, DiffusionForm::as_printed), Error);
    CHECK(diffusion_system(g, one, 5, 0, 0, DiffusionForm::corrected).matrix.allFinite());
  }
  SECTION("albedo 1: singular, and no NaN") {
    const LeastSquares found =
        solve_least_squares(diffusion_system(chain(10), std::vector<LinearSource>(10, {0.3, Vec3::Zero()}), 5, 1, 0,
                                             DiffusionForm::corrected),
                            Eigen::VectorXd::Zero(10), 200, 1e-10, LeastSquaresSolver::lsqr_scaled);
    CHECK(found.x.allFinite());
  }
}

}  // namespace diffusion_system_test
