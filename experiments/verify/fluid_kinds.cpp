// Parts of a step of a flow by themselves: advection, diffusion, a Poisson equation, confinement.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/verify/fluid_tables.h"
#include "reference/stable_fluids/diffusion.h"
#include "reference/stable_fluids/forces.h"

namespace airlight::experiments::verification {
namespace {

using namespace stable_fluids;
using scene::FlowProblem;

// A velocity at every sample, ghosts too.
template <class Real, class Function>
Velocity<Real> velocity_of(const Lattice& l, const Function& u) {
  Velocity<Real> velocity;
  for (int a = 0; a < 2; ++a) {
    Field<Real>& f = velocity[a] = Field<Real>(l, a);
    for (int j = -ghosts; j < f.n[1] + ghosts; ++j)
      for (int i = -ghosts; i < f.n[0] + ghosts; ++i) f.at(i, j, 0) = Real(u(f.position(l, i, j, 0))[a]);
  }
  return velocity;
}

template <class Real, class Function>
Field<Real> center_field(const Lattice& l, const Function& value) {
  Field<Real> f(l, at_centers);
  for (int j = 0; j < l.n[1]; ++j)
    for (int i = 0; i < l.n[0]; ++i) f.at(i, j, 0) = Real(value(f.position(l, i, j, 0)));
  return f;
}

template <class Real>
double product(const Field<Real>& f, const Field<Real>& g) {
  double sum = 0;
  for (int j = 0; j < f.n[1]; ++j)
    for (int i = 0; i < f.n[0]; ++i) sum += double(f.at(i, j, 0)) * double(g.at(i, j, 0));
  return sum;
}
template <class Real>
double squares(const Field<Real>& f) {
  return product(f, f);
}

// Columns a, N, k, then the factor of each scheme: of ten steps, the tenth root.
template <class Real>
void compare_amplification(const Row& row, double tolerance, Outcome& out) {
  const double cfl = row.numbers[0], k = row.numbers[2];
  const int n = row.whole(1);
  FlowProblem problem = flat_problem(1, scene::Side::Kind::periodic);
  const Lattice l = make_lattice(problem, n);
  const auto u = velocity_of<Real>(l, [](const Point3&) { return Vec3(1, 0, 0); });
  const char* names[] = {"semi-Lagrangian", "MacCormack", "BFECC"};
  for (int s = 0; s < 3; ++s) {
    auto f = center_field<Real>(l, [&](const Point3& x) { return std::cos(2 * pi * k * x[0]); });
    Field<Real> to = f;
    Workspace<Real> work;
    const double before = squares(f);
    for (int step = 0; step < 10; ++step) {
      fill_ghosts(f, Quantity::density, l);
      advect({Scheme(s), Interpolation::linear, Limiter::none, 1}, l, {}, u, cfl * l.h, Quantity::density, f, to, work);
      std::swap(f, to);
    }
    out.add(
        absolute(fmt::format("{}, CFL {}, {} of {}, {}", names[s], cfl, k, n, sizeof(Real) == 8 ? "double" : "float"),
                 row.numbers[3 + s], std::pow(squares(f) / before, 0.05), tolerance));
  }
}

Check read_amplification(const Value& v) {
  const double tolerance = v["accuracy"]["abs"].number();
  const auto rows = read_rows(v["expected"]["rows"], false, 6);
  return {"", [=](VerifyProfile) {
            Outcome out;
            for (const Row& row : rows) {
              compare_amplification<double>(row, tolerance, out);
              compare_amplification<float>(row, 1e-5, out);
            }
            return out;
          }};
}

// Columns nu, dt, N, k, factor of cos(2 pi k x).
Check read_diffusion(const Value& v) {
  const double tolerance = v["accuracy"]["rel"].number();
  const auto rows = read_rows(v["expected"]["rows"], false, 5);
  return {"", [=](VerifyProfile) {
            Outcome out;
            for (const Row& row : rows) {
              const double nu = row.numbers[0], dt = row.numbers[1], k = row.numbers[3];
              const Lattice l = make_lattice(flat_problem(1, scene::Side::Kind::periodic), row.whole(2));
              const auto wave = center_field<double>(l, [&](const Point3& x) { return std::cos(2 * pi * k * x[0]); });
              auto f = wave;
              Diffusion<double>(l, {}, at_centers, 1e-12, 100)(f, Quantity::density, nu * dt);
              // The wave's share of it: what rounding puts into the mean does not decay.
              out.add(relative(fmt::format("nu {}, dt {}", nu, dt), row.numbers[4],
                               product(f, wave) / product(wave, wave), tolerance));
            }
            return out;
          }};
}

// Expected are the solution at cells, "p312" at (3, 1, 2), and the root of its mean square, "l2".
Check read_poisson(const Value& v) {
  const double h = v["input"]["h"].number_in(1e-9, 1e9);
  const Value size = v["input"]["n"], expected = v["expected"];
  std::array<int, 3> n{};
  for (std::size_t a = 0; a < 3; ++a) n[a] = size[a].integer_in(1, 128);
  struct Cell {
    std::string name;
    std::array<int, 3> at;
    double value;
  };
  std::vector<Cell> cells;
  for (const std::string& name : expected.fields()) {
    if (name == "l2") continue;
    Cell cell{name, {}, expected[name].number()};
    const bool named = name.size() == 4 && name[0] == 'p';
    for (std::size_t a = 0; a < 3; ++a) {
      cell.at[a] = named ? name[a + 1] - '0' : -1;
      if (cell.at[a] < 0 || cell.at[a] >= std::min(n[a], 10))
        expected[name].complain("p and three digits, a cell, as its name");
    }
    cells.push_back(cell);
  }
  const double l2 = expected["l2"].number(), tolerance = v["accuracy"]["abs"].number();
  return {"", [=](VerifyProfile) {
            FlowProblem problem;
            problem.box = {Point3::Zero(), h * Vec3(n[0], n[1], n[2])};
            const Lattice l = make_lattice(problem, *std::max_element(n.begin(), n.end()));
            std::vector<double> p;
            double sum = 0;
            for (int k = 0; k < l.n[2]; ++k)
              for (int j = 0; j < l.n[1]; ++j)
                for (int i = 0; i < l.n[0]; ++i) sum += p.emplace_back((7 * i + 13 * j + 29 * k) % 11 - 5.0);
            for (double& value : p) value = sum / double(p.size()) - value;
            Helmholtz<double>(l, at_centers, true).solve(p, 0, 1);
            Outcome out;
            for (const Cell& cell : cells) {
              const auto& [i, j, k] = cell.at;
              const double got =
                  p[std::size_t(i) + std::size_t(l.n[0]) * (std::size_t(j) + std::size_t(l.n[1]) * std::size_t(k))];
              out.add(absolute(cell.name, cell.value, got, tolerance));
            }
            double square = 0;
            for (const double value : p) square += value * value;
            out.add(absolute("l2", l2, std::sqrt(square / double(p.size())), tolerance));
            return out;
          }};
}

// Columns scheme, n, steps, energy, mass, greatest, least, error: a Gaussian that is turned once, walls around it.
void compare_rotation(const Row& row, double tolerance, Outcome& out) {
  const int n = row.whole(0), steps = row.whole(1);
  const Lattice l = make_lattice(flat_problem(1, scene::Side::Kind::free_slip), n);
  const auto u =
      velocity_of<double>(l, [](const Point3& x) -> Vec3 { return 2 * pi * Vec3(0.5 - x[1], x[0] - 0.5, 0); });
  auto f = center_field<double>(
      l, [](const Point3& x) { return std::exp(-(x - Point3(0.5, 0.75, 0)).squaredNorm() / (2 * 0.05 * 0.05)); });
  const Field<double> first = f;
  Field<double> to = f;
  Workspace<double> work;
  for (int i = 0; i < steps; ++i) {
    fill_ghosts(f, Quantity::density, l);
    advect({row.advection(), Interpolation::linear, Limiter::none, 4}, l, {}, u, 1.0 / steps, Quantity::density, f, to,
           work);
    std::swap(f, to);
  }
  double mass = 0, mass_before = 0, error = 0, greatest = -infinity, least = infinity;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      mass += f.at(i, j, 0);
      mass_before += first.at(i, j, 0);
      error += std::pow(f.at(i, j, 0) - first.at(i, j, 0), 2);
      greatest = std::max(greatest, f.at(i, j, 0));
      least = std::min(least, f.at(i, j, 0));
    }
  const std::string name = fmt::format("{}, {}", row.scheme, n);
  const auto add = [&](const char* what, double expected, double got) {
    out.add(relative(name + ", " + what, expected, got, tolerance));
  };
  add("energy", row.numbers[2], squares(f) / squares(first));
  add("mass", row.numbers[3], mass / mass_before);
  add("greatest", row.numbers[4], greatest);
  // The least value may be 0, so its tolerance is a share of the greatest value at the start, which is 1.
  out.add(absolute(name + ", least", row.numbers[5], least, tolerance));
  add("error", row.numbers[6], std::sqrt(error / squares(first)));
}

Check read_rotation(const Value& v) {
  const auto rows = read_rows(v["expected"]["rows"], true, 7);
  const double tolerance = v["accuracy"]["rel"].number();
  return {"", [=](VerifyProfile profile) {
            Outcome out;
            for (const Row& row : rows) {
              if (profile == VerifyProfile::quick && row.whole(0) > 128) {
                out.left_out += 5;
                out.left_out_because = "256^2 cells are for the paper profile";
                continue;
              }
              compare_rotation(row, tolerance, out);
            }
            return out;
          }};
}

// eps h exp(-r^2) around a vortex, at cells near (r, 0).
Check read_confinement(const Value& v) {
  const double epsilon = v["input"]["eps"].number(), h = v["input"]["h"].number_in(1e-2, 1);
  const auto radii = v["input"]["r"].numbers(), expected = v["expected"]["f_theta"].numbers();
  if (expected.size() != radii.size()) v["expected"]["f_theta"].complain("a number for every r");
  return {"", [=](VerifyProfile) {
            FlowProblem problem = flat_problem(1, scene::Side::Kind::open);
            problem.box = {Point3(-4, -4, 0), Point3(4, 4, 0)};
            const Lattice l = make_lattice(problem, int(std::lround(8 / h)));
            auto u = velocity_of<double>(l, [](const Point3& x) -> Vec3 {
              const double r2 = x.squaredNorm();
              return (r2 > 0 ? -std::expm1(-r2) / (2 * r2) : 0.5) * Vec3(-x[1], x[0], 0);
            });
            Velocity<double> before = u;
            add_confinement(epsilon, l, {}, 1, u);
            for (int a = 0; a < 2; ++a)
              for (int j = 0; j < u[a].n[1]; ++j)
                for (int i = 0; i < u[a].n[0]; ++i) u[a].at(i, j, 0) -= before[a].at(i, j, 0);
            Outcome out;
            for (std::size_t i = 0; i < radii.size(); ++i) {
              const double r = radii[i];
              const Vec3 cells = (Point3(r, 0, 0) - l.low) / l.h;
              out.add(relative(fmt::format("around, r = {}", r), expected[i], interpolate(u[1], l, cells), 0.02));
              out.add(absolute(fmt::format("outwards, r = {}", r), 0, interpolate(u[0], l, cells),
                               0.02 * std::abs(expected[i])));
            }
            return out;
          }};
}

}  // namespace

Check read_fluid(const Value& v) {
  // The input says the kind of a vector: by the columns of its rows, or by its quantities.
  const Value in = v["input"];
  const std::string rows = in.has("rows") ? in["rows"].text() : "";
  if (rows == "a,N,k,SL,MC,BFECC") return read_amplification(v);
  if (rows == "nu,dt,N,k,factor") return read_diffusion(v);
  if (rows == "scheme,n,steps,energy,mass,max,min,rel_error") return read_rotation(v);
  if (in.has("n") && in.has("h")) return read_poisson(v);
  if (in.has("eps")) return read_confinement(v);
  return read_fluid_flow(v);
}

}  // namespace airlight::experiments::verification
