// Gupta and Narasimhan 2007: the fluid in a box whose walls nothing passes. Fields, projections, right sides, steps.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/application/json_value.h"
#include "experiments/verify/fluid_on_device.h"
#include "experiments/verify/legendre_vectors.h"
#include "experiments/verify/readers.h"
#include "methods/legendre_fluids/time_steps.h"

namespace airlight::experiments::verification {
namespace {

using namespace legendre_fluids;

constexpr double fluid_gate = 1e-12;  // of the vectors: relative to the largest entry

ConfinedSpace space_of(const Value& v) { return {v.has("d") ? v["d"].integer_in(2, 3) : 2, v["n"].integer_in(2, 32)}; }

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

// A vector's space, the parts of the solver that it asks for, by the processor or the device, and what they lead to.
class Comparing {
 public:
  Comparing(const ConfinedSpace& space, bool on_device) : space_(space), on_device_(on_device) {}
  const ConfinedSpace* operator->() const { return &space_; }
  const ConfinedSpace& space() const { return space_; }
  bool on_device() const { return on_device_; }
  const Outcome& outcome() const { return out_; }
  void add(const Comparison& c) { out_.add(c); }

  double energy(const Array& u) const { return 0.5 * space_.inner(u, u); }
  Array projected(const Array& u) const {
    if (!on_device_) return space_.project(u);
    DeviceFluid fluid(space_, {}, u);
    fluid.device->project();
    return fluid.now().velocity;
  }
  // The rate of u, carried by w, before projection.
  Array advected(const Array& w, const Array& u) const {
    if (!on_device_) return space_.advected(space_.at_points(w), u);
    return &w == &u ? DeviceFluid(space_, {}, u).rates().velocity : carried_on_device(space_, w, u);
  }
  Array scalar_advected(const Array& w, const Array& r) const {
    return on_device_ ? DeviceFluid(space_, carrying, w, r).rates().density
                      : space_.scalar_advected(space_.at_points(w), r);
  }
  // Runge-Kutta, between halves of diffusion where there is a viscosity.
  Array stepped(Array u, double dt, double viscosity) const {
    if (on_device_) {
      DeviceFluid fluid(space_, {viscosity, 0, true}, u);
      fluid.device->step(dt);
      return fluid.now().velocity;
    }
    const auto diffuse = [&] {
      if (viscosity > 0) u = space_.project(space_.diffused(u, 0.5 * viscosity * dt));
    };
    diffuse();
    u = runge_kutta_4(u, dt, [&](const Array& now) { return projected(advected(now, now)); });
    diffuse();
    return u;
  }

  // Relative to the largest entry: 1e-12 on the processor, as the vectors say; on the device what single precision leaves.
  double gate() const { return on_device_ ? 2e-5 : fluid_gate; }
  void arrays(const std::string& name, const Array& expected, const Array& got) {
    for (const Comparison& c : largest_differences(name, expected, got, gate())) add(c);
  }
  // Compares arrays of the paper's variants, which the device computes in double precision, too.
  void arrays_in_double(const std::string& name, const Array& expected, const Array& got, double gate) {
    for (const Comparison& c : largest_differences(name, expected, got, gate)) add(c);
  }
  // Entry by entry, relative to a size that may be that of other arrays.
  void entries(const std::string& name, const Array& expected, const Array& got, double size) {
    for (Eigen::Index i = 0; i < expected.size(); ++i)
      add(absolute(fmt::format("{} {}", name, i), expected[i], got[i], gate() * size));
  }
  // `device`: the absolute tolerance there.
  void number(const Value& v, const std::string& field, double got, double device) {
    if (!v.has(field)) return;
    const double expected = v[field].number();
    add(on_device_ ? absolute(field, expected, got, device) : relative(field, expected, got, fluid_gate, fluid_gate));
  }
  // 1e-6 of it on the device.
  void number(const Value& v, const std::string& field, double got) {
    if (v.has(field)) number(v, field, got, 1e-6 * std::abs(v[field].number()));
  }
  void zero(const std::string& name, double got, double device) {
    add(absolute(name, 0, got, on_device_ ? device : fluid_gate));
  }
  // Numbers that do not depend on a solver: compared once.
  void of_input(const Value& v, const std::string& field, double got) {
    if (!on_device_) number(v, field, got);
  }

 private:
  ConfinedSpace space_;
  bool on_device_;
  Outcome out_;
};

// On the processor comparisons take no time: they are computed where the vector is read. On the device they are computed later, from a copy.
template <class Compare>
Check compared(const Value& v, Compare&& compare) {
  Comparing here(space_of(v), false);
  compare(v, here);
  Check check{"", [out = here.outcome()](VerifyProfile) { return out; }};
  if (here->n() + v.has("w_a") > gpu::legendre_fluids::most_coefficients)
    check.not_on_device = "the device knows no more coefficients along an axis";
  else
    check.on_device = [json = v.json(), where = v.where(), compare](VerifyProfile) {
      const Value copy(json, where);
      Comparing there(space_of(copy), true);
      compare(copy, there);
      return there.outcome();
    };
  return check;
}

void compare_projection(const Value& v, const Array& u, Comparing& out) {
  const Array projected = out.projected(u), divergence = out->divergence(u);
  if (!out.on_device()) out.arrays("div_before", scalar_of(v["div_before"], out.space()), divergence);
  out.of_input(v, "div_norm_before", divergence.norm());
  out.arrays("projection", velocity_of(v, out.space(), "", "_proj"), projected);
  if (out.on_device())
    out.arrays_in_double("projection, paper_repaired", velocity_of(v, out.space(), "", "_proj"),
                         projected_by_paper(out.space(), u), fluid_gate);
  out.of_input(v, "energy_before", out.energy(u));
  out.number(v, "energy_after", out.energy(projected));
  out.zero("divergence after", out->divergence(projected).cwiseAbs().maxCoeff(), 2e-6);
}

// At one point.
Components position(const Vec3& x) {
  return {Array::Constant(1, x[0]), Array::Constant(1, x[1]), Array::Constant(1, x[2])};
}

}  // namespace

Check read_legendre_project(const Value& v) {
  return compared(v, [](const Value& v, Comparing& out) { compare_projection(v, velocity_of(v, out.space()), out); });
}

// A polynomial by its terms; its coefficients, then what project has.
Check read_legendre_coefficients(const Value& v) {
  struct Term {
    double factor;
    Vec3 powers;
  };
  return compared(v, [](const Value& v, Comparing& out) {
    std::vector<std::vector<Term>> field(std::size_t(out->dimensions()));
    for (std::size_t a = 0; a < field.size(); ++a)
      for (std::size_t i = 0; i < v["field"][a].size(); ++i) {
        const Value term = v["field"][a][i];
        field[a].push_back({term["c"].number(), term["powers"].vector()});
      }
    const Array u = out->from_function([&](const Vec3& x) {
      Vec3 sum = Vec3::Zero();
      for (std::size_t a = 0; a < field.size(); ++a)
        for (const Term& t : field[a])
          sum[Eigen::Index(a)] +=
              t.factor * std::pow(x[0], t.powers[0]) * std::pow(x[1], t.powers[1]) * std::pow(x[2], t.powers[2]);
      return sum;
    });
    if (!out.on_device()) out.arrays("coefficients", velocity_of(v, out.space()), u);
    compare_projection(v, u, out);
  });
}

Check read_legendre_evaluate(const Value& v) {
  return compared(v, [](const Value& v, Comparing& out) {
    const int d = out->dimensions();
    Array u = velocity_of(v, out.space()), r = scalar_of(v["r"], out.space());
    const Value points = v["points"];
    std::vector<Vec3> places, speeds;
    std::vector<Array> value, gradient, slope;  // expected
    for (std::size_t i = 0; i < points.size(); ++i) {
      places.push_back(points[i]["x"].vector());
      value.push_back(points[i]["u"].vector().head(d));
      slope.push_back(points[i]["grad_r"].vector().head(d));
      gradient.emplace_back(d * d);
      for (int a = 0; a < d; ++a) gradient[i].segment(a * d, d) = points[i]["grad_u"][std::size_t(a)].vector().head(d);
    }
    const double most_r = r.cwiseAbs().maxCoeff();
    if (out.on_device()) {
      DeviceFluid fluid(out.space(), carrying, u, r);
      speeds = speeds_of_particles(fluid, places);
      u = fluid.now().velocity, r = fluid.density;  // a microsecond moves nothing, to single precision
    }
    // Relative to a point's largest entry; on the device to that of all points.
    const auto size = [&](const std::vector<Array>& all, std::size_t i) {
      double most = all[i].cwiseAbs().maxCoeff();
      for (std::size_t k = 0; out.on_device() && k < all.size(); ++k)
        most = std::max(most, all[k].cwiseAbs().maxCoeff());
      return most;
    };
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Components at = position(places[i]);
      Array got(d), got_gradient(d * d), got_slope(d);
      for (int a = 0; a < d; ++a) {
        got[a] = out.on_device() ? speeds[i][a] : out->sampled(u, a, at)[0];
        got_slope[a] = out->scalar_sampled_gradient(r, a, at)[0];
        for (int b = 0; b < d; ++b) got_gradient[a * d + b] = out->sampled_gradient(u, a, b, at)[0];
      }
      out.entries(fmt::format("point {} u", i), value[i], got, size(value, i));
      out.entries(fmt::format("point {} grad u", i), gradient[i], got_gradient, size(gradient, i));
      out.entries(fmt::format("point {} grad r", i), slope[i], got_slope, size(slope, i));
      out.number(points[i], "r", out->scalar_sampled(r, at)[0], out.gate() * most_r);
    }
  });
}

Check read_legendre_advect(const Value& v) {
  return compared(v, [](const Value& v, Comparing& out) {
    const Array u = velocity_of(v, out.space()), w = v.has("w_a") ? velocity_of(v, out.space(), "w_") : u;
    const Array rate = out.advected(v.has("w_a") ? w : u, u), projected = out.projected(rate);
    const Array expected = velocity_of(v, out.space(), "rhs_unprojected_");
    for (int a = 0; a < out->dimensions(); ++a)
      out.arrays(fmt::format("before projection, {}", "xyz"[a]), out->component(expected, a), out->component(rate, a));
    out.arrays("right side", velocity_of(v, out.space(), "rhs_"), projected);
    out.zero("rate of energy", out->inner(u, projected),
             (v.has("w_a") ? 2e-5 : 1e-6) * std::sqrt(out->inner(u, u) * out->inner(projected, projected)));
  });
}

Check read_legendre_diffuse(const Value& v) {
  return compared(v, [](const Value& v, Comparing& out) {
    using Diffusion = ConfinedSpace::Diffusion;
    const Array u = velocity_of(v, out.space());
    const double amount = v["nu_dt"].number_in(0, 1e9);
    if (out.on_device()) {
      DeviceFluid fluid(out.space(), {1, 0, true}, u);
      fluid.device->diffuse(amount);
      return out.arrays("exact factor", velocity_of(v, out.space(), "exp_"), fluid.now().velocity);
    }
    const Array exact = out->diffused(u, amount), implicit = out->diffused(u, amount, Diffusion::backward_euler);
    out.arrays("exact factor", velocity_of(v, out.space(), "exp_"), exact);
    out.arrays("backward Euler", velocity_of(v, out.space(), "implicit_"), implicit);
    out.number(v, "energy_before", out.energy(u));
    out.number(v, "energy_exp", out.energy(exact));
    out.number(v, "energy_implicit", out.energy(implicit));
  });
}

namespace {

Check read_step(const Value& v, double viscosity) {
  return compared(v, [viscosity](const Value& v, Comparing& out) {
    const Array before = velocity_of(v, out.space()), u = out.stepped(before, v["dt"].number_in(0, 1e3), viscosity);
    out.of_input(v, "energy_before", out.energy(before));
    out.arrays("after the step", velocity_of(v, out.space(), "", "_1"), u);
    out.number(v, "energy_after", out.energy(u));
    out.zero("divergence after", out->divergence(u).cwiseAbs().maxCoeff(), 2e-6 * u.cwiseAbs().maxCoeff());
  });
}

}  // namespace

Check read_legendre_rk4(const Value& v) { return read_step(v, 0); }
Check read_legendre_step(const Value& v) { return read_step(v, v["nu"].number_in(1e-9, 1e9)); }

Check read_legendre_density(const Value& v) {
  return compared(v, [](const Value& v, Comparing& out) {
    const Array w = velocity_of(v, out.space()), r = scalar_of(v["r"], out.space()), rate = out.scalar_advected(w, r);
    const double dt = v["dt"].number_in(0, 1e3), to_mass = std::pow(2.0, 0.5 * out->dimensions());
    Array next;
    if (out.on_device()) {
      DeviceFluid fluid(out.space(), carrying, w, r);
      fluid.device->step(dt);
      next = fluid.now().density;
      out.zero("the velocity's change", (fluid.velocity - w).cwiseAbs().maxCoeff(), 1e-7 * w.cwiseAbs().maxCoeff());
    } else {
      next = runge_kutta_4(r, dt, [&](const Array& now) { return out.scalar_advected(w, now); });
    }
    out.arrays("right side", scalar_of(v["rhs"], out.space()), rate);
    if (out.on_device())
      out.arrays_in_double("right side, paper", scalar_of(v["rhs"], out.space()), advected_by_paper(out.space(), w, r),
                           1e-9);
    out.arrays("after the step", scalar_of(v["r_1"], out.space()), next);
    out.of_input(v, "mass_before", to_mass * r[0]);
    out.number(v, "mass_after", to_mass * next[0]);
    out.of_input(v, "l2_norm_before", r.norm());
    out.of_input(v, "l2_norm_after", next.norm());
    if (out.on_device()) return;
    out.zero("rate of mass", to_mass * rate[0], 0);
    out.zero("rate of the norm", rate.dot(r) / r.norm(), 0);
  });
}

Check read_legendre_energy_identity(const Value& v) {
  return compared(v, [](const Value& v, Comparing& out) {
    const Array u = velocity_of(v, out.space()), w = velocity_of(v, out.space(), "w_"),
                r = scalar_of(v["r"], out.space());
    const Array flat = out.projected(w), moved = out.scalar_advected(w, r), still = out.scalar_advected(flat, r);
    const double to_mass = std::pow(2.0, 0.5 * out->dimensions()), size = out.gate() * r.norm();
    out.of_input(v, "energy_u", out.energy(u));
    out.of_input(v, "energy_w", out.energy(w));
    out.number(v, "w_grad_u_dot_u", -out->inner(u, out.advected(w, u)), out.gate() * out->inner(u, u));
    out.number(v, "w_grad_r_times_r", -moved.dot(r), size);
    out.number(v, "w_grad_r_integral", -to_mass * moved[0], size);
    out.number(v, "w_projected_energy", out.energy(flat));
    out.zero("w_projected_grad_r_times_r", still.dot(r), size * still.norm());
    out.zero("w_projected_grad_r_integral", still[0], out.gate() * still.norm());
    if (out.on_device()) return;
    const Components at = out->at_points(u);
    Array squares = Array::Zero(at[0].size());
    for (int a = 0; a < out->dimensions(); ++a) squares += at[a].cwiseAbs2();
    out.number(v, "minus_half_div_w_u2",
               -0.5 * out->integral(out->scalar_at_points(out->divergence(w)).cwiseProduct(squares)));
    out.zero("w_projected_grad_u_dot_u", out->inner(u, out.advected(flat, u)), 0);
    double gradient_energy = 0;
    const Components nodes{out->nodes(), out->nodes(), out->nodes()};
    for (int a = 0; a < out->dimensions(); ++a)
      for (int b = 0; b < out->dimensions(); ++b)
        gradient_energy += out->integral(out->sampled_gradient(u, a, b, nodes).cwiseAbs2());
    out.number(v, "gradient_energy_u", gradient_energy);
  });
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
  const auto compare = [=](bool on_device) {
    Comparing out(ConfinedSpace(2, 16), on_device);
    Array u = out->project(out->from_function([](const Vec3& x) {
      return Vec3(std::sin(pi * x[0]) * std::cos(pi * x[1]), -std::cos(pi * x[0]) * std::sin(pi * x[1]), 0);
    }));
    const int steps = std::max(1, int(std::lround(time / 0.01)));
    for (int i = 0; i < steps; ++i) u = out.stepped(u, time / steps, viscosity);
    // Relative to the greatest speed on the device; the energy is quadratic.
    const double single = out.gate() * std::exp(-2 * pi * pi * viscosity * time);
    out.add(relative("energy", energy_then, out.energy(u), on_device ? 2 * out.gate() : accuracy));
    for (std::size_t i = 0; i < points.size(); ++i)
      for (int a = 0; a < 2; ++a)
        out.add(absolute(fmt::format("u_{}, point {}", "xy"[a], i), points[i].u[a],
                         out->sampled(u, a, position(points[i].x))[0], on_device ? single : accuracy));
    return out.outcome();
  };
  return {"", [=](VerifyProfile) { return compare(false); }, [=](VerifyProfile) { return compare(true); }};
}

}  // namespace airlight::experiments::verification
