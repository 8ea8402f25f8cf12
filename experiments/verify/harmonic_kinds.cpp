// Zhou et al. 2008: spherical harmonics, depths of Gaussians in them, exponentials of those.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "experiments/verify/harmonics_on_device.h"
#include "experiments/verify/monte_carlo.h"
#include "experiments/verify/own_tolerance.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/smoke_vector.h"
#include "methods/compensated_ray_marching/gaussian_depth.h"
#include "methods/compensated_ray_marching/harmonic_exponential.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/math/gauss_legendre.h"
#include "scene/math/sh_product.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::experiments::verification {
namespace {

using crm::Harmonics;

constexpr int most_bands = 6;  // of the shaders of the centres

Check up_to_most_bands(Check check, int order) {
  if (order > most_bands) check.on_device = nullptr, check.not_on_device = "the device knows at most six bands";
  return check;
}

// A list of numbers against a function of what was read, and against one of the device, by default at the vector's own tolerance.
using Compute = std::function<std::vector<double>()>;
Check list_check(const Value& v, int order, const Compute& compute, const Compute& on_device = {},
                 std::optional<OwnTolerance> there = {}) {
  const std::vector<double> expected =
      v["expected"].is_array() ? v["expected"].numbers() : std::vector<double>{v["expected"].number()};
  const auto compared = [expected](const Compute& compute, OwnTolerance t) {
    return [=](VerifyProfile) {
      Outcome out;
      compare_all(out, "", expected, compute(), t);
      return out;
    };
  };
  const OwnTolerance t = tolerance_of(v);
  Check check{"", compared(compute, t)};
  if (on_device)
    check.on_device = compared(on_device, there.value_or(OwnTolerance{t.relative, t.absolute + gpu::injected_error()}));
  return up_to_most_bands(check, order);
}

constexpr double off_tables = 9e-5;  // of a band, what the tables of 256 distances leave: harmonics_test.cpp

int order_of(const Value& in) { return in["order"].integer_in(1, 12); }
Vec3 axis_of(const Value& v) { return v.vector().normalized(); }
Harmonics joined(Harmonics a, const Harmonics& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Harmonics harmonics_of(const Value& v, int order) {
  Harmonics all = v.numbers();
  if (int(all.size()) != order * order) v.complain("order^2 coefficients");
  return all;
}

// a and b of the optimal linear exponential at some sizes, with their standard errors over a sample of the family.
struct Linear {
  std::vector<double> a, b, a_error, b_error;
};

Linear of_family(const std::vector<Harmonics>& family, const std::vector<double>& sizes) {
  Linear linear;
  for (const double s : sizes) {
    const crm::LinearExponential one(family, s, 1);
    linear.a.push_back(one.constant(s));
    linear.b.push_back(one.slope(s));
  }
  return linear;
}

// The family's members are as many for each count, and random: its parts by turns are samples of their own.
Linear of_sample(const std::vector<Harmonics>& family, const std::vector<double>& sizes) {
  constexpr std::size_t parts = 20;
  Linear all = of_family({family.front()}, sizes);
  for (std::vector<double>* list : {&all.a, &all.b, &all.a_error, &all.b_error}) list->assign(sizes.size(), 0.0);
  std::vector<Linear> each;
  for (std::size_t p = 0; p < parts; ++p) {
    std::vector<Harmonics> part;
    for (std::size_t i = p; i < family.size(); i += parts) part.push_back(family[i]);
    each.push_back(of_family(part, sizes));
  }
  for (std::size_t i = 0; i < sizes.size(); ++i)
    for (const auto& [value, error] : {std::pair(&Linear::a, &Linear::a_error), {&Linear::b, &Linear::b_error}}) {
      double sum = 0, squares = 0;
      for (const Linear& one : each) sum += (one.*value)[i] / parts;
      for (const Linear& one : each) squares += std::pow((one.*value)[i] - sum, 2);
      (all.*value)[i] = sum;
      (all.*error)[i] = std::sqrt(squares / (parts * (parts - 1)));
    }
  return all;
}

// The family of one Gaussian about any axis, its distance log-uniform. Lengths are in widths.
struct OneGaussian {
  double nearest, farthest, cut;
};

// From "one blocker, d/r log-uniform in [0.3, 10], cut 3", with any words after it.
OneGaussian one_gaussian_of(const Value& family) {
  OneGaussian one{};
  if (std::sscanf(family.text().c_str(), "one blocker, d/r log-uniform in [%lf, %lf], cut %lf", &one.nearest,
                  &one.farthest, &one.cut) != 3 ||
      !(one.nearest > 0 && one.nearest < one.farthest && one.farthest < 1e6 && one.cut > 1e-3 && one.cut < 1e3))
    family.complain("unit_vectors, counts, or \"one blocker, d/r log-uniform in [NEAREST, FARTHEST], cut CUT\"");
  return one;
}

// By quadrature on either side of the cut, where the depth has a kink.
Linear of_one_gaussian(const OneGaussian& one, const std::vector<double>& sizes) {
  const scene::GaussLegendre rule = scene::gauss_legendre(32);
  Linear all{std::vector<double>(sizes.size()), std::vector<double>(sizes.size()), {}, {}};
  const double middle = std::clamp(one.cut, one.nearest, one.farthest);
  for (const auto& [lo, hi] :
       {std::pair(std::log(one.nearest), std::log(middle)), {std::log(middle), std::log(one.farthest)}})
    for (std::size_t k = 0; k < rule.node.size(); ++k) {
      const double distance = std::exp(lo + 0.5 * (hi - lo) * (1 + rule.node[k]));
      Harmonics h = crm::about_axis(crm::zonal_depth(4, distance, one.cut), Vec3::UnitZ());
      h[0] = 0;
      double square = 0;
      for (const double value : h) square += value * value;
      for (double& value : h) value /= std::sqrt(square);
      const Linear there = of_family({h}, sizes);
      const double share = 0.5 * rule.weight[k] * (hi - lo) / std::log(one.farthest / one.nearest);
      for (std::size_t i = 0; i < sizes.size(); ++i) all.a[i] += share * there.a[i], all.b[i] += share * there.b[i];
    }
  return all;
}

}  // namespace

Check read_sh_basis(const Value& v) {
  const int order = order_of(v["input"]);
  const Vec3 w = axis_of(v["input"]["direction"]);
  // Some ten products of numbers up to 2 on the device, each rounded to 2^-24.
  return list_check(
      v, 1, [=] { return scene::evaluate_sh(order, w); },
      [=] {
        gpu::Context& context = gpu::Context::get();
        gpu::Program& program = gpu::compensated_ray_marching::program(context, "harmonics_towards", 1, 1, {});
        const gpu::Buffer result(context, "harmonics", 4 * std::size_t(order * order));
        result.bind(gpu::compensated_ray_marching::at::result);
        program.set("sh_order", order);
        program.set("direction", w);
        program.dispatch(1);
        const std::vector<float> got = result.download<float>();
        return std::vector<double>(got.begin(), got.end());
      },
      OwnTolerance{0, 20 * std::exp2(-24) + 2 * gpu::injected_error()});
}

Check read_sh_triple_entry(const Value& v) {
  const Value in = v["input"];
  const int order = order_of(in), size = order * order;
  std::array<int, 3> at{};
  for (std::size_t a = 0; a < 3; ++a) at[a] = in[std::string(1, char('i' + a))].integer_in(0, size - 1);
  Harmonics f(std::size_t(size), 0.0), h = f;
  f[std::size_t(at[0])] = h[std::size_t(at[1])] = 1;
  const auto entry = [=](const Harmonics& product) { return Harmonics{product[std::size_t(at[2])]}; };
  return list_check(
      v, order, [=] { return entry(scene::triple_product(order)(f, h)); },
      [=] { return entry(step_on_device(Step::product, order, joined(f, h))); });
}

Check read_sh_triple_counts(const Value& v) {
  const std::vector<double> orders = v["input"]["orders"].numbers(), all = v["expected"]["nonzero"].numbers(),
                            unique = v["expected"]["unique_sorted"].numbers();
  int highest = 1;
  for (std::size_t i = 0; i < orders.size(); ++i)
    highest = std::max(highest, v["input"]["orders"][i].integer_in(1, 12));
  const OwnTolerance t = tolerance_of(v);
  Check check{
      "", [=](VerifyProfile) {
        std::vector<double> some, every;
        for (const double order : orders) {
          const auto& terms = scene::triple_product(int(order)).terms();
          some.push_back(double(terms.size()));
          every.push_back(0);
          // Orders that three indices can stand in.
          for (const auto& term : terms)
            every.back() += term.i == term.j && term.j == term.k ? 1 : term.i == term.j || term.j == term.k ? 3 : 6;
        }
        Outcome out;
        compare_all(out, "nonzero", all, every, t);
        compare_all(out, "unique", unique, some, t);
        return out;
      }};
  check.on_device = [=](VerifyProfile) {
    Outcome out;
    std::vector<double> every;
    for (const double order : orders) every.push_back(step_on_device(Step::terms, int(order), {0})[0]);
    compare_all(out, "nonzero", all, every, t);
    return out;
  };
  return up_to_most_bands(check, highest);
}

Check read_sh_triple_product(const Value& v) {
  const Value in = v["input"];
  const int order = order_of(in);
  const Harmonics f = harmonics_of(in["f"], order), g = harmonics_of(in["g"], order);
  return list_check(
      v, order, [=] { return scene::triple_product(order)(f, g); },
      [=] { return step_on_device(Step::product, order, joined(f, g)); });
}

Check read_hg_zh(const Value& v) {
  const int order = order_of(v["input"]);
  const double g = v["input"]["g"].number_in(-1, 1);
  Check check = list_check(v, order, [=] { return crm::henyey_greenstein(order, g); });
  // Light from one direction leaves the phase function about that direction.
  check.on_device = [=, expected = v["expected"].numbers()](VerifyProfile) {
    const Vec3 axis = Vec3(2, -1, 2) / 3;
    return compare_scattered(order, g, scene::evaluate_sh(order, axis), crm::about_axis(expected, axis));
  };
  return up_to_most_bands(check, order);
}

Check read_sh_convolution(const Value& v) {
  const Value in = v["input"];
  const int order = order_of(in);
  const std::vector<double> zonal = in["zonal"].numbers();
  if (int(zonal.size()) != order) in["zonal"].complain("a coefficient for every band");
  const Harmonics f = harmonics_of(in["f"], order);
  Check check = list_check(v, order, [=] { return crm::convolved(f, zonal); });
  const double g = order > 1 ? zonal[1] / zonal[0] / std::sqrt(3) : 0;
  const Harmonics phase = crm::henyey_greenstein(order, std::clamp(g, -1.0, 1.0));
  double other = 0;
  for (std::size_t l = 0; l < zonal.size(); ++l) other = std::max(other, std::abs(zonal[l] - phase[l]));
  check.not_on_device = "the device knows no phase functions but Henyey and Greenstein's";
  if (other < 1e-5)
    check.on_device = [=, expected = harmonics_of(v["expected"], order)](VerifyProfile) {
      return compare_scattered(order, g, f, expected);
    };
  return up_to_most_bands(check, order);
}

Check read_zh_rotation(const Value& v) {
  const Value in = v["input"];
  const std::vector<double> zonal = in["zonal"].numbers();
  const Vec3 axis = axis_of(in["axis"]);
  const int order = int(zonal.size());
  std::vector<double> scaled = zonal;
  for (std::size_t l = 0; l < zonal.size(); ++l) scaled[l] *= gpu::compensated_ray_marching::about_axis_factor(int(l));
  return list_check(
      v, order, [=] { return crm::about_axis(zonal, axis); },
      [=] {
        return step_on_device(Step::about_axis, order, joined(scaled, {axis[0], axis[1], axis[2]}));
      });
}

Check read_theta_of_d(const Value& v) {
  const double d = v["input"]["d"].number_in(0, 1e300);
  const Compute angle = [=] { return step_on_device(Step::angle, 4, {1 / d}); };
  Check check = list_check(
      v, 1, [=] { return Harmonics{crm::angle_of_distance(d)}; }, d < 1 ? Compute() : angle);
  check.not_on_device = "the device knows no angle within a width: an object hides light from outside of it alone";
  return check;
}

Check read_rbf_zh_optical_depth(const Value& v) {
  const Value in = v["input"];
  // Distance and depth are in widths, whatever these are.
  const double radius = in["radius"].number_in(1e-6, 1e6), d = in["d"].number_in(0, 1e6), cut = cut_of(in);
  const int order = order_of(in);
  const Harmonics expected = v["expected"].numbers();
  Check check = list_check(v, order, [=] { return crm::zonal_depth(order, d, cut); });
  check.on_device = [=](VerifyProfile) {
    const Vec3 axis = Vec3(1, -2, 2) / 3, seen = d > 0 ? axis : Vec3::UnitZ();
    scene::GaussianSum sum;
    sum.cutoff = cut;
    sum.gaussians = {{d * radius * axis, radius, 1}};
    Harmonics depth = passed_on_device(order, crm::Transmittance::series, sum, 1 / radius).minus_depth;
    for (double& value : depth) value = -value;
    // The table, as the processor reads it, and what its samples leave.
    Harmonics between(std::size_t(order), 0.0), nothing(depth.size(), 0.0);
    crm::DepthTable(order, crm::DepthTable::Spacing::even, crm::depth_samples, cut).zonal(d, between.data());
    const Harmonics oracle = crm::about_axis(expected, seen);
    return Outcome{{absolute("off the processor's table", 0, distance(depth, crm::about_axis(between, seen)),
                             1e-12 + gpu::injected_error()),
                    absolute("off", 0, distance(depth, oracle), off_tables * std::sqrt(order / (4 * pi))),
                    absolute("off, of the whole", 0, distance(depth, oracle) / distance(oracle, nothing), 1e-4)}};
  };
  return up_to_most_bands(check, order);
}

Check read_sh_exponential(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const scene::GaussianSum smoke = gaussians_of(in, "blockers_xyz_r_w");
  const double sigma_t = in["sigma_t"].number();
  const Harmonics depth = expected["minus_depth_vector"].numbers(), passed = expected["exp_of_bandlimited"].numbers();
  const OwnTolerance t = tolerance_of(v);
  return {
      "",
      [=](VerifyProfile) {
        Outcome out;
        const Harmonics got = minus_depth(smoke, Point3::Zero(), sigma_t);
        compare_all(out, "depth", depth, got, t);
        compare_all(out, "passed", passed, crm::exact_exponential(got), t);
        return out;
      },
      // By tables of 256 distances, and by exponentials that have errors of their own: as near the exact one as the processor's.
      [=](VerifyProfile) {
        using crm::Transmittance;
        double most = 0;  // of the depths that are added
        for (const scene::Gaussian& g : smoke.gaussians) most += sigma_t * g.width * g.amplitude;
        Outcome out;
        for (const auto& [kind, name] : {std::pair(Transmittance::paper_linear, "linear"),
                                         {Transmittance::paper_squared, "squared"},
                                         {Transmittance::series, "series"}}) {
          const auto of = [kind = kind](const Harmonics& f) {
            return kind == Transmittance::paper_linear ? crm::linear_exponential(4)(f)
                   : kind == Transmittance::paper_squared
                       ? crm::squared_exponential(f, crm::linear_exponential(4), crm::squaring_threshold)
                       : crm::series_exponential(f);
          };
          const Passed got = passed_on_device(4, kind, smoke, sigma_t);
          const auto off = [&, name = name](const char* what, const Harmonics& a, const Harmonics& b,
                                            double tolerance) {
            out.add(absolute(fmt::format("{} {}", name, what), 0, distance(a, b), tolerance));
          };
          off("off the depth", got.minus_depth, depth, most * off_tables * std::sqrt(4 / (4 * pi)));
          off("off the processor's", got.passed, of(got.minus_depth), 1e-12 + 10 * gpu::injected_error());
          // Factor on the tables' error: exponentials of functions below 0 on the whole sphere are at most 1.
          off("off what passes", got.passed, passed, distance(of(depth), passed) + most * off_tables);
        }
        return out;
      }};
}

Check read_ol_table(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const std::vector<double> sizes = in["s"].numbers(), a = expected["a"].numbers(), b = expected["b"].numbers();
  if (a.size() != sizes.size() || b.size() != sizes.size()) expected.complain("an a and a b for every s");
  const OwnTolerance t = tolerance_of(v);
  Check check{"", nullptr, nullptr, "the device reads this table, and does not make it"};
  if (in.has("counts")) {
    std::vector<int> counts;
    for (std::size_t i = 0; i < in["counts"].size(); ++i) counts.push_back(in["counts"][i].integer_in(1, 1000));
    const std::vector<double> a_error = v["stderr"]["a"].numbers(), b_error = v["stderr"]["b"].numbers();
    if (a_error.size() != a.size() || b_error.size() != b.size()) v["stderr"].complain("one for every a and b");
    check.job = [=](VerifyProfile profile) {
      const Linear got = of_sample(crm::depth_family(4, counts, profile == VerifyProfile::quick ? 400 : 20000), sizes);
      Outcome out;
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        out.add(statistical(fmt::format("a {}", i), a[i], a_error[i], got.a[i], got.a_error[i], accept_se));
        out.add(statistical(fmt::format("b {}", i), b[i], b_error[i], got.b[i], got.b_error[i], accept_se));
      }
      return out;
    };
    return check;
  }
  std::vector<Harmonics> family;
  if (in.has("unit_vectors"))
    for (std::size_t i = 0; i < in["unit_vectors"].size(); ++i)
      family.push_back(harmonics_of(in["unit_vectors"][i], 4));
  const OneGaussian one = family.empty() ? one_gaussian_of(in["family"]) : OneGaussian{};
  check.job = [=](VerifyProfile) {
    const Linear got = family.empty() ? of_one_gaussian(one, sizes) : of_family(family, sizes);
    Outcome out;
    compare_all(out, "a", a, got.a, t);
    compare_all(out, "b", b, got.b, t);
    return out;
  };
  return check;
}

}  // namespace airlight::experiments::verification
