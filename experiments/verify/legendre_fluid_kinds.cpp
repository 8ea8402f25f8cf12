// Gupta and Narasimhan 2007: the fluid in a box whose walls nothing passes. Fields, projections, right sides, steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/verify/legendre_vectors.h"
#include "experiments/verify/readers.h"
#include "methods/legendre_fluids/time_steps.h"

namespace airlight::experiments::verification {
namespace {

using namespace legendre_fluids;

constexpr double fluid_gate = 1e-12;  // of the vectors: relative to the largest entry

std::shared_ptr<const ConfinedSpace> space_of(const Value& v) {
  const int d = v.has("d") ? v["d"].integer_in(2, 3) : 2;
  return std::make_shared<const ConfinedSpace>(d, v["n"].integer_in(2, 32));
}

Array scalar_of(const Value& v, const ConfinedSpace& space) {
  const Tensor tensor = tensor_from(v);
  if (tensor.shape != space.shape()) v.complain(fmt::format("{} coefficients along each axis", space.n()));
  return tensor.values;
}

// From the fields `before` + "a" + `after` and so on.
Array velocity_of(const Value& v, const ConfinedSpace& space, const std::string& before = "",
                  const std::string& after = "") {
  Components parts;
  for (int a = 0; a < space.dimensions(); ++a) {
    const Value part = v[before + "abc"[a] + after];
    const Tensor tensor = tensor_from(part);
    if (tensor.shape != space.shape(a))
      part.complain(fmt::format("{} coefficients along axis {}, {} along others", space.n() - 1, "xyz"[a], space.n()));
    parts[a] = tensor.values;
  }
  return space.joined(parts);
}

double energy(const ConfinedSpace& space, const Array& u) { return 0.5 * space.inner(u, u); }

Array acceleration(const ConfinedSpace& space, const Array& u) {
  return space.project(space.advected(space.at_points(u), u));
}

// Comparisons that a vector leads to, computed where it is read: they take no time.
class Comparing {
 public:
  void arrays(const std::string& name, const Array& expected, const Array& got) {
    for (Comparison& c : largest_differences(name, expected, got, fluid_gate)) out_.comparisons.push_back(std::move(c));
  }
  void number(const Value& v, const std::string& field, double got) {
    if (v.has(field)) out_.comparisons.push_back(relative(field, v[field].number(), got, fluid_gate, fluid_gate));
  }
  void zero(const std::string& name, double got) { out_.comparisons.push_back(absolute(name, 0, got, fluid_gate)); }
  Check done() const {
    return {"", [out = out_](VerifyProfile) { return out; }};
  }

 private:
  Outcome out_;
};

void compare_projection(const Value& v, const ConfinedSpace& space, const Array& u, Comparing& out) {
  const Array projected = space.project(u), divergence = space.divergence(u);
  out.arrays("div_before", scalar_of(v["div_before"], space), divergence);
  out.number(v, "div_norm_before", divergence.norm());
  out.arrays("projection", velocity_of(v, space, "", "_proj"), projected);
  out.number(v, "energy_before", energy(space, u));
  out.number(v, "energy_after", energy(space, projected));
  out.zero("divergence after", space.divergence(projected).cwiseAbs().maxCoeff());
}

// At one point.
Components position(const Vec3& x) {
  return {Array::Constant(1, x[0]), Array::Constant(1, x[1]), Array::Constant(1, x[2])};
}

}  // namespace

Check read_legendre_project(const Value& v) {
  const auto space = space_of(v);
  Comparing out;
  compare_projection(v, *space, velocity_of(v, *space), out);
  return out.done();
}

// A polynomial by its terms; its coefficients, then what project has.
Check read_legendre_coefficients(const Value& v) {
  struct Term {
    double factor;
    Vec3 powers;
  };
  const auto space = space_of(v);
  std::vector<std::vector<Term>> field(std::size_t(space->dimensions()));
  for (std::size_t a = 0; a < field.size(); ++a)
    for (std::size_t i = 0; i < v["field"][a].size(); ++i) {
      const Value term = v["field"][a][i];
      field[a].push_back({term["c"].number(), term["powers"].vector()});
    }
  const Array u = space->from_function([&](const Vec3& x) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t a = 0; a < field.size(); ++a)
      for (const Term& t : field[a])
        sum[Eigen::Index(a)] +=
            t.factor * std::pow(x[0], t.powers[0]) * std::pow(x[1], t.powers[1]) * std::pow(x[2], t.powers[2]);
    return sum;
  });
  Comparing out;
  out.arrays("coefficients", velocity_of(v, *space), u);
  compare_projection(v, *space, u, out);
  return out.done();
}

Check read_legendre_evaluate(const Value& v) {
  const auto space = space_of(v);
  const Array u = velocity_of(v, *space), r = scalar_of(v["r"], *space);
  Comparing out;
  for (std::size_t i = 0; i < v["points"].size(); ++i) {
    const Value point = v["points"][i];
    const Components at = position(point["x"].vector());
    const int d = space->dimensions();
    Array value(d), gradient(d * d), gradient_of_r(d), expected(d * d);
    for (int a = 0; a < d; ++a) {
      value[a] = space->sampled(u, a, at)[0];
      gradient_of_r[a] = space->scalar_sampled_gradient(r, a, at)[0];
      const Vec3 row = point["grad_u"][std::size_t(a)].vector();
      for (int b = 0; b < d; ++b) {
        gradient[a * d + b] = space->sampled_gradient(u, a, b, at)[0];
        expected[a * d + b] = row[b];
      }
    }
    out.arrays(fmt::format("u, point {}", i), point["u"].vector().head(d), value);
    out.arrays(fmt::format("grad u, point {}", i), expected, gradient);
    out.arrays(fmt::format("grad r, point {}", i), point["grad_r"].vector().head(d), gradient_of_r);
    out.number(point, "r", space->scalar_sampled(r, at)[0]);
  }
  return out.done();
}

Check read_legendre_advect(const Value& v) {
  const auto space = space_of(v);
  const Array u = velocity_of(v, *space), w = v.has("w_a") ? velocity_of(v, *space, "w_") : u;
  const Array rate = space->advected(space->at_points(w), u), projected = space->project(rate);
  Comparing out;
  out.arrays("before projection", velocity_of(v, *space, "rhs_unprojected_"), rate);
  out.arrays("right side", velocity_of(v, *space, "rhs_"), projected);
  out.zero("rate of energy", space->inner(u, projected));
  return out.done();
}

Check read_legendre_diffuse(const Value& v) {
  using Diffusion = ConfinedSpace::Diffusion;
  const auto space = space_of(v);
  const Array u = velocity_of(v, *space);
  const double amount = v["nu_dt"].number_in(0, 1e9);
  const Array exact = space->diffused(u, amount), implicit = space->diffused(u, amount, Diffusion::backward_euler);
  Comparing out;
  out.arrays("exact factor", velocity_of(v, *space, "exp_"), exact);
  out.arrays("backward Euler", velocity_of(v, *space, "implicit_"), implicit);
  out.number(v, "energy_before", energy(*space, u));
  out.number(v, "energy_exp", energy(*space, exact));
  out.number(v, "energy_implicit", energy(*space, implicit));
  return out.done();
}

namespace {

// Runge-Kutta, between halves of diffusion where there is a viscosity.
Check read_step(const Value& v, double viscosity) {
  const auto space = space_of(v);
  const double dt = v["dt"].number_in(0, 1e3);
  Array u = velocity_of(v, *space);
  Comparing out;
  out.number(v, "energy_before", energy(*space, u));
  if (viscosity > 0) u = space->project(space->diffused(u, 0.5 * viscosity * dt));
  u = runge_kutta_4(u, dt, [&](const Array& now) { return acceleration(*space, now); });
  if (viscosity > 0) u = space->project(space->diffused(u, 0.5 * viscosity * dt));
  out.arrays("after the step", velocity_of(v, *space, "", "_1"), u);
  out.number(v, "energy_after", energy(*space, u));
  out.zero("divergence after", space->divergence(u).cwiseAbs().maxCoeff());
  return out.done();
}

}  // namespace

Check read_legendre_rk4(const Value& v) { return read_step(v, 0); }
Check read_legendre_step(const Value& v) { return read_step(v, v["nu"].number_in(1e-9, 1e9)); }

Check read_legendre_density(const Value& v) {
  const auto space = space_of(v);
  const Components w = space->at_points(velocity_of(v, *space));
  const auto rate = [&](const Array& r) { return space->scalar_advected(w, r); };
  const Array r = scalar_of(v["r"], *space), next = runge_kutta_4(r, v["dt"].number_in(0, 1e3), rate);
  const double to_mass = std::pow(2.0, 0.5 * space->dimensions());
  Comparing out;
  out.arrays("right side", scalar_of(v["rhs"], *space), rate(r));
  out.arrays("after the step", scalar_of(v["r_1"], *space), next);
  out.number(v, "mass_before", to_mass * r[0]);
  out.number(v, "mass_after", to_mass * next[0]);
  out.number(v, "l2_norm_before", r.norm());
  out.number(v, "l2_norm_after", next.norm());
  out.zero("rate of mass", to_mass * rate(r)[0]);
  out.zero("rate of the norm", rate(r).dot(r) / r.norm());
  return out.done();
}

Check read_legendre_energy_identity(const Value& v) {
  const auto space = space_of(v);
  const Array u = velocity_of(v, *space), w = velocity_of(v, *space, "w_"), r = scalar_of(v["r"], *space);
  const Array flat = space->project(w), moved = space->scalar_advected(space->at_points(w), r);
  const double to_mass = std::pow(2.0, 0.5 * space->dimensions());
  Comparing out;
  out.number(v, "energy_u", energy(*space, u));
  out.number(v, "energy_w", energy(*space, w));
  out.number(v, "w_grad_u_dot_u", -space->inner(u, space->advected(space->at_points(w), u)));
  const Components at = space->at_points(u);
  Array squares = Array::Zero(at[0].size());
  for (int a = 0; a < space->dimensions(); ++a) squares += at[a].cwiseAbs2();
  out.number(v, "minus_half_div_w_u2",
             -0.5 * space->integral(space->scalar_at_points(space->divergence(w)).cwiseProduct(squares)));
  out.number(v, "w_grad_r_times_r", -moved.dot(r));
  out.number(v, "w_grad_r_integral", -to_mass * moved[0]);
  out.number(v, "w_projected_energy", energy(*space, flat));
  out.zero("w_projected_grad_u_dot_u", space->inner(u, space->advected(space->at_points(flat), u)));
  double gradient_energy = 0;
  const Components nodes{space->nodes(), space->nodes(), space->nodes()};
  for (int a = 0; a < space->dimensions(); ++a)
    for (int b = 0; b < space->dimensions(); ++b)
      gradient_energy += space->integral(space->sampled_gradient(u, a, b, nodes).cwiseAbs2());
  out.number(v, "gradient_energy_u", gradient_energy);
  return out.done();
}

// With 16 coefficients the solution is met to 2.1e-10 in the mean; steps of 0.01 s.
Check read_legendre_taylor_green(const Value& v) {
  constexpr double accuracy = 2e-9;
  const double viscosity = v["nu"].number_in(0, 1e9), time = v["t"].number_in(0, 1e3),
               energy_then = v["energy"].number();
  struct Point {
    Vec3 x, u;
  };
  std::vector<Point> points;
  for (std::size_t i = 0; i < v["points"].size(); ++i) {
    const auto x = v["points"][i]["x"].numbers(), u = v["points"][i]["u"].numbers();
    if (x.size() != 2 || u.size() != 2) v["points"][i].complain("two numbers in x and in u");
    points.push_back({Vec3(x[0], x[1], 0), Vec3(u[0], u[1], 0)});
  }
  return {"", [=](VerifyProfile) {
            const ConfinedSpace space(2, 16);
            Array u = space.project(space.from_function([](const Vec3& x) {
              return Vec3(std::sin(pi * x[0]) * std::cos(pi * x[1]), -std::cos(pi * x[0]) * std::sin(pi * x[1]), 0);
            }));
            const int steps = std::max(1, int(std::lround(time / 0.01)));
            const double dt = time / steps;
            for (int i = 0; i < steps; ++i) {
              u = space.project(space.diffused(u, 0.5 * viscosity * dt));
              u = runge_kutta_4(u, dt, [&](const Array& now) { return acceleration(space, now); });
              u = space.project(space.diffused(u, 0.5 * viscosity * dt));
            }
            Outcome out;
            out.comparisons.push_back(relative("energy", energy_then, energy(space, u), accuracy));
            for (std::size_t i = 0; i < points.size(); ++i)
              for (int a = 0; a < 2; ++a)
                out.comparisons.push_back(absolute(fmt::format("u_{}, point {}", "xy"[a], i), points[i].u[a],
                                                   space.sampled(u, a, position(points[i].x))[0], accuracy));
            return out;
          }};
}

}  // namespace airlight::experiments::verification
