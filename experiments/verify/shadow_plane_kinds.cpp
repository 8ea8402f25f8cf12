// The evaluators and shadows of methods/shadow_planes.
#include <algorithm>
#include <cmath>

#include "experiments/verify/readers.h"
#include "experiments/verify/vector_scene.h"
#include "gpu/raster/first_hits.h"
#include "gpu/shadow_planes/evaluator.h"
#include "methods/shadow_planes/bounded_media.h"
#include "methods/shadow_planes/mapped_rule.h"
#include "methods/shadow_planes/paper_medium.h"
#include "methods/shadow_planes/polynomial.h"
#include "methods/shadow_planes/shadow_volumes.h"

namespace airlight::experiments::verification {
namespace {

using namespace shadow_planes;

const MappedRule<double>& rule() {
  static const MappedRule<double> r(64, 6);
  return r;
}

// Hazy and murky are printed forms in these vectors.
PhaseForm phase_of(const Value& in) {
  const std::string name = in["phase"].text();
  if (name == "iso") return phase_form(scene::Isotropic{});
  if (name == "rayleigh") return phase_form(scene::Rayleigh{});
  if (name == "hazy") return phase_form(scene::Hazy{}, true);
  if (name == "murky") return phase_form(scene::Murky{}, true);
  if (name == "hg") return phase_form(scene::HenyeyGreenstein{in["g"].number()});
  in["phase"].complain("one of iso, rayleigh, hazy, murky, hg");
}

// Error through rounding of the input.
double conditioning(double extinction, double T, double h, double x0, double x1) {
  const double length = std::isinf(x1) ? 0 : std::max({std::abs(x0), std::abs(x1), std::abs(T)}) / (x1 - x0);
  return 1 + extinction * (x0 + std::hypot(x0 - T, h)) + length;
}

}  // namespace

Check read_planes_airlight(const Value& v) {
  const Value in = v["input"];
  const double k = in["k_t"].number(), T = in["T"].number(), h = in["h"].number(), x0 = in["x0"].number(),
               x1 = in["x1"].number_or_infinite(), scale = in["albedo"].number_in(0, 1) * in["intensity"].number();
  const PhaseForm phase = phase_of(in);
  const double expected = v["expect"]["log10_L"].number();
  constexpr auto one = [](double, double, double) { return 1.0; };
  // The integral is `share` of the rule's.
  const auto compare = [=](double share, double error) {
    const double shape = share * airlight_integral(rule(), phase, k, T, h, LitPart<double>{x0, x1 - x0}, one);
    const double got =
        std::log10(scale * k / (4 * pi)) + std::log10(shape) - k * (x0 + std::hypot(x0 - T, h)) / std::log(10.0);
    const double tolerance = 5e-14 + 4e-16 * conditioning(k, T, h, x0, x1) + std::log10(1 + error);
    // The expected logarithm has 16 digits.
    return Outcome{{absolute("log10 L", expected, got, tolerance + 2e-15 * std::abs(expected))}};
  };
  return {
      "", [=](VerifyProfile) { return compare(1, 0); },
      // The integral of the rounded input, which is all that a float can know. The exponential factor is the processor's: no float holds it.
      [=](VerifyProfile) {
        static const MappedRule<double> truth(128, 6);
        const auto length = [](double l) { return l < gpu::far_away ? float(l) : gpu::far_away; };
        const gpu::shadow_planes::EvaluatorCase c{float(k), float(h), float(x0 - T), length(x1 - x0)};
        const double got = gpu::shadow_planes::integrals_on_device(gpu::Context::get(), {phase}, {c}).front();
        const LitPart<double> part{0, c.length < gpu::far_away ? c.length : infinity};
        const double exact =
            airlight_integral(truth, phase, double(c.extinction), double(-c.d0), double(c.h), part, one);
        // The greatest error of the rule's 16 nodes is that of murky.
        return compare(got / exact, phase.kind == PhaseForm::Kind::isotropic ? 5e-6 : 1e-4);
      }};
}

Check read_taylor_coefficients(const Value& v) {
  const Value in = v["input"];
  const PhaseForm phase = phase_of(in);
  const double a = in["a"].number();
  const int degree = in["degree"].integer_in(0, 64);
  const std::vector<double> expected = v["expect"]["c"].numbers();
  if (int(expected.size()) != degree + 1) v["expect"]["c"].complain("as many numbers as the degree and one more");
  return {"", [=](VerifyProfile) {
            const std::vector<double> got = taylor_coefficients(phase, a, degree);
            double most = 0;
            for (const double c : expected) most = std::max(most, std::abs(c));
            Outcome outcome;
            for (int n = 0; n <= degree; ++n)
              outcome.add(absolute("c" + std::to_string(n), expected[n], got[n], 1e-13 * most));
            return outcome;
          }};
}

Check read_taylor_integral(const Value& v) {
  const Value in = v["input"];
  const PhaseForm phase = phase_of(in);
  const double a = in["a"].number(), theta0 = in["theta0"].number(), theta1 = in["theta1"].number();
  const int degree = in["degree"].integer_in(0, 64);
  const double polynomial = v["expect"]["J_poly"].number(), exact = v["expect"]["J_exact"].number();
  return {"", [=](VerifyProfile) {
            const double got =
                std::exp(-a) * integrate_polynomial(taylor_coefficients(phase, a, degree), 0, theta0, theta1);
            // On a ray past the light at distance 1 with extinction a.
            const double x0 = std::tan(theta0), x1 = std::tan(theta1);
            const double by_rule = std::exp(-a * q_at(x0, 1.0)) *
                                   airlight_integral(rule(), phase, a, 0.0, 1.0, LitPart<double>{x0, x1 - x0},
                                                     [](double, double, double) { return 1.0; });
            return Outcome{{relative("polynomial", polynomial, got, 1e-11), relative("exact", exact, by_rule, 1e-13)}};
          }};
}

Check read_spot(const Value& v) {
  const Value in = v["input"];
  const Ray ray = ray_from(in["O"], in["dir"]);
  const LightFromRay light = light_from_ray(ray, in["S"].vector());
  const Vec3 axis = in["axis"].vector().normalized();
  const PhaseForm phase = phase_of(in);
  const double n = in["n"].number(), k = in["k_t"].number(), x0 = in["x0"].number(), x1 = in["x1"].number();
  const double L = v["expect"]["L"].number(), T = v["expect"]["T"].number(), h = v["expect"]["h"].number();
  return {"", [=](VerifyProfile) {
            const double shape = airlight_integral(rule(), phase, k, light.T, light.h, LitPart<double>{x0, x1 - x0},
                                                   [&](double q, double half, double w) {
                                                     const Vec3 d = 2 * q * half * light.n + (w - half) * ray.direction;
                                                     return std::pow(std::max(0.0, d.dot(axis)), n);
                                                   });
            const double got = k / (4 * pi) * std::exp(-k * (x0 + std::hypot(x0 - light.T, light.h))) * shape;
            // max(0, cos)^n has a kink of order n where the ray leaves the lit side.
            return Outcome{{relative("T", T, light.T, 1e-14), relative("h", h, light.h, 1e-14),
                            relative("L", L, got, n < 2 ? 1e-4 : 1e-10)}};
          }};
}

Check read_shadow(const Value& v) {
  const Value in = v["input"];
  scene::TriangleMesh mesh;
  for (std::size_t i = 0; i < in["vertices"].size(); ++i) mesh.vertices.push_back(in["vertices"][i].vector());
  for (std::size_t i = 0; i < in["triangles"].size(); ++i) {
    const Value t = in["triangles"][i];
    const int last = int(mesh.vertices.size()) - 1;
    mesh.triangles.push_back({t[0].integer_in(0, last), t[1].integer_in(0, last), t[2].integer_in(0, last)});
  }
  const Ray ray = ray_from(in["O"], in["dir"]);
  const Point3 light = in["S"].vector();
  const double k = in["k_t"].number(), far = in["far"].number();
  const Value expect = v["expect"];
  const double end = expect["x_end"].number(), L = expect["L"].number();
  std::vector<double> bounds;
  for (std::size_t i = 0; i < expect["lit"].size(); ++i) {
    bounds.push_back(expect["lit"][i][0].number());
    bounds.push_back(expect["lit"][i][1].number());
  }
  const Value profile = expect["count_profile"];
  const int at_eye = profile[0][2].integer(), at_end = profile[profile.size() - 1][2].integer();
  return {
      "", [=](VerifyProfile) {
        auto scene = std::make_shared<scene::Scene>();
        scene->surfaces.push_back({"mesh", mesh, scene::Lambert{}});
        finish(*scene);
        const auto hit = scene->geometry->first_hit(ray);
        const double stop = hit ? std::min(far, hit->t) : far;
        const ShadowVolumes shadows(std::make_shared<Occluders>(scene), light);
        std::vector<Crossing> crossings;
        std::vector<ShadowVolumes::Interval> lit;
        int m = shadows.count(ray.origin);
        Outcome outcome{{relative("x_end", end, stop, 1e-13), absolute("m at the eye", at_eye, m, 0)}};
        shadows.lit_parts(ray, stop, m, nullptr, crossings, lit);
        for (const Crossing& c : crossings) m += c.change;
        outcome.add(absolute("m at the end", at_end, m, 0));
        outcome.add(absolute("lit parts", double(bounds.size() / 2), double(lit.size()), 0));
        double sum = 0;
        const LightFromRay from = light_from_ray(ray, light);
        for (std::size_t i = 0; i < lit.size() && 2 * i < bounds.size(); ++i) {
          outcome.add(relative("begin", bounds[2 * i], lit[i].begin, 1e-13));
          outcome.add(relative("end", bounds[2 * i + 1], lit[i].end, 1e-13));
          sum += lit_airlight(rule(), PhaseForm{}, k, 1, 1, from.T, from.h, {lit[i].begin, lit[i].end - lit[i].begin});
        }
        outcome.add(relative("L", L, sum, 1e-12));
        return outcome;
      }};
}

Check read_bounded(const Value& v) {
  const Value in = v["input"], params = in["params"], expect = v["expect"];
  scene::Medium medium;
  medium.sigma_t = Rgb::Constant(in["k_t"].number());
  const std::string shape = in["shape"].text();
  if (shape == "sphere")
    medium.region = scene::Sphere{params[0].vector(), params[1].number()};
  else if (shape == "box")
    medium.region = Box{params[0].vector(), params[1].vector()};
  else
    in["shape"].complain("sphere or box");
  const Ray ray = ray_from(in["O"], in["dir"]);
  const Point3 light = in["S"].vector();
  const double R = in["R"].number(), x_in = expect["x_in"].number(), x_out = expect["x_out"].number();
  const double exact = expect["L_exact"].number(), paper = expect["L_paper"].number();
  return {"", [=](VerifyProfile) {
            static const MappedRule<double> grazing(64, 6, true);
            const Interval inside = clip(medium.region, ray, {0, infinity});
            const double got =
                BoundedMedia({medium}).airlight(grazing, ray, light, {0, infinity}, [](const Vec3&) { return 1.0; })[0];
            // The vector's R of a box is sampled.
            const PaperMedium as_printed(medium, {});
            const double of_paper = as_printed(scene::PointLight{light, Rgb::Ones(), 0}, ray, inside)[0] *
                                    std::exp(medium.sigma_t[0] * (as_printed.R() - R));
            return Outcome{{absolute("x_in", x_in, inside.lo, 1e-13 * (1 + x_in)),
                            relative("x_out", x_out, inside.hi, 1e-13), relative("L", exact, got, 1e-11),
                            relative("L of the paper", paper, of_paper, 1e-12)}};
          }};
}

}  // namespace airlight::experiments::verification
