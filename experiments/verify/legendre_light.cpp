// Gupta and Narasimhan 2007: light in a Legendre box, by the deterministic reference, which shares nothing with the paper's systems.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/verify/legendre_vectors.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/vector_scene.h"
#include "reference/deterministic/airlight.h"

namespace airlight::experiments::verification {
namespace {

constexpr double accuracy = 1e-11;  // relative, of light

// A field in two dimensions is one that is the same for all z: L_0 there is 1/sqrt(2).
scene::LegendrePointer box_from(const Value& v) {
  Tensor tensor = tensor_from(v["R"]);
  for (const int n : tensor.shape)
    if (n > scene::LegendreBox::most)
      v["R"].complain(fmt::format("at most {} coefficients along an axis", scene::LegendreBox::most));
  if (!v["R"][0][0].is_array()) tensor.values *= std::sqrt(2.0);
  return std::make_shared<const scene::LegendreBox>(Box{Point3::Constant(-1), Point3::Constant(1)}, tensor.shape,
                                                    tensor.values);
}

Vec3 padded(const Value& v) {
  const std::vector<double> x = v.numbers();
  if (x.size() != 2 && x.size() != 3) v.complain("two or three numbers");
  return {x[0], x[1], x.size() == 3 ? x[2] : 0};
}

Vec3 direction_from(const Value& v) {
  const Vec3 d = padded(v);
  if (!(d.norm() > 0)) v.complain("a direction");
  return d.normalized();
}

// The light travels along omega_d, the scattered light along omega_s.
struct Setting {
  scene::Scene world;
  Vec3 to_light, to_eye;
  double incoming;
};
Setting setting_from(const Value& v) {
  Setting s;
  const double sigma = v["sigma"].number_in(1e-9, 1e9), g = v["g"].number_in(-0.999, 0.999);
  s.to_light = -direction_from(v["omega_d"]);
  s.to_eye = direction_from(v["omega_s"]);
  s.incoming = v["E_in"].number_in(0, 1e9);
  scene::Medium medium = fog(scene::Unbounded{}, sigma, v["beta"].number_in(0, sigma) / sigma, scene::Isotropic{});
  if (g != 0) medium.phase = scene::HenyeyGreenstein{g};
  medium.field = box_from(v);
  s.world.media = {medium};
  s.world.lights = {scene::DirectionalLight{s.to_light, Rgb::Constant(s.incoming)}};
  return s;
}

Comparison scattered(std::string what, const Setting& s, const Point3& x, double end, double expected) {
  const deterministic::Airlight got = deterministic::airlight(s.world, {x, -s.to_eye}, end, {0.1 * accuracy});
  Comparison c = relative(std::move(what), expected, got.radiance[0], accuracy);
  if (!got.converged) {
    c.tolerance_text = "quadrature not converged";
    c.tolerance = -1;
  }
  return c;
}

}  // namespace

Check read_legendre_scatter(const Value& v) {
  const Setting s = setting_from(v);
  struct Row {
    Point3 x;
    double depth, arriving, leaving;
  };
  std::vector<Row> rows;
  const Value points = v["points"];
  for (std::size_t i = 0; i < points.size(); ++i)
    rows.push_back(
        {padded(points[i]["x"]), points[i]["tau_d"].number(), points[i]["E_d"].number(), points[i]["E_s"].number()});
  return {"", [=](VerifyProfile) {
            Outcome out;
            for (std::size_t i = 0; i < rows.size(); ++i) {
              const double depth = scene::optical_depth(s.world.media, {rows[i].x, s.to_light}, {0, infinity})[0];
              out.comparisons.push_back(relative(fmt::format("{} tau_d", i), rows[i].depth, depth, 1e-12, 1e-13));
              out.comparisons.push_back(
                  relative(fmt::format("{} E_d", i), rows[i].arriving, s.incoming * std::exp(-depth), 1e-12));
              out.comparisons.push_back(scattered(fmt::format("{} E_s", i), s, rows[i].x, infinity, rows[i].leaving));
            }
            return out;
          }};
}

Check read_legendre_airlight(const Value& v) {
  const Setting s = setting_from(v);
  struct Row {
    Point3 x;
    double end, background, depth, attenuated, airlight, total;
  };
  std::vector<Row> rows;
  const Value pixels = v["pixels"];
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Value p = pixels[i];
    rows.push_back({p["x"].vector(), p["depth"].number(), p["background"].number(), p["tau_view"].number(),
                    p["attenuated"].number(), p["airlight"].number(), p["total"].number()});
  }
  return {"", [=](VerifyProfile) {
            Outcome out;
            for (std::size_t i = 0; i < rows.size(); ++i) {
              const Row& r = rows[i];
              const double depth = scene::optical_depth(s.world.media, {r.x, -s.to_eye}, {0, r.end})[0];
              const double behind = r.background * std::exp(-depth);
              out.comparisons.push_back(relative(fmt::format("{} tau_view", i), r.depth, depth, 1e-12));
              out.comparisons.push_back(relative(fmt::format("{} attenuated", i), r.attenuated, behind, 1e-12));
              const Comparison air = scattered(fmt::format("{} airlight", i), s, r.x, r.end, r.airlight);
              out.comparisons.push_back(air);
              out.comparisons.push_back(relative(fmt::format("{} total", i), r.total, behind + air.got, accuracy));
            }
            return out;
          }};
}

Check read_legendre_image(const Value& v) {
  const Setting s = setting_from(v);
  const int axis = v["face"]["axis"].integer_in(0, 2), side = v["face"]["side"].integer_in(-1, 1);
  const std::vector<double> across = v["u"].numbers(), along = v["v"].numbers();
  const Tensor expected = tensor_from(v["E_s"]);
  if (expected.shape != scene::TensorShape{int(across.size()), int(along.size()), 1})
    v["E_s"].complain("a row for each u, a column for each v");
  return {"", [=](VerifyProfile) {
            Outcome out;
            Eigen::Index at = 0;
            for (const double first : across)
              for (const double second : along) {
                Point3 x;
                x[axis] = side;
                x[axis == 0 ? 1 : 0] = first;
                x[axis == 2 ? 1 : 2] = second;
                out.comparisons.push_back(
                    scattered(fmt::format("u = {}, v = {}", first, second), s, x, infinity, expected.values[at++]));
              }
            return out;
          }};
}

}  // namespace airlight::experiments::verification
