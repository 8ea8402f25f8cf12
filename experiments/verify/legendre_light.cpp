// Gupta and Narasimhan 2007: light in a Legendre box, by the deterministic reference and by the method's rays, which share nothing; and the
// paper's systems.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/verify/legendre_vectors.h"
#include "experiments/verify/one_ray.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/vector_scene.h"
#include "gpu/legendre_fluids/light.h"
#include "gpu/legendre_fluids/paper_light.h"
#include "methods/legendre_fluids/light_rays.h"
#include "methods/legendre_fluids/paper_light.h"
#include "methods/legendre_fluids/point_values.h"
#include "reference/deterministic/airlight.h"

namespace airlight::experiments::verification {
namespace {

constexpr double accuracy = 1e-12;  // relative, of light
constexpr double single = 2e-5;     // of the largest value, on the device

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
  s.world.camera.kind = scene::Camera::Kind::orthographic;
  s.world.lights = {scene::DirectionalLight{s.to_light, Rgb::Constant(s.incoming)}};
  return s;
}

// By the reference, then by the method.
std::array<Comparison, 2> scattered(const std::string& what, const Setting& s, const Point3& x, double end,
                                    double expected) {
  const Ray ray{x, -s.to_eye};
  const deterministic::Airlight got = deterministic::airlight(s.world, ray, end, {0.1 * accuracy});
  Comparison c = relative(what, expected, got.radiance[0], accuracy);
  if (!got.converged) {
    c.tolerance_text = "quadrature not converged";
    c.tolerance = -1;
  }
  legendre_fluids::RayVisits visits;
  const legendre_fluids::LightRays rays(s.world, {12, 0.1 * accuracy});
  return {c, relative(what + ", rays", expected, rays.airlight(ray, end, visits)[0], accuracy)};
}

void add(std::vector<Comparison>& all, const std::array<Comparison, 2>& both) {
  all.insert(all.end(), both.begin(), both.end());
}

// The places of the film of `image`: u and v are along the axes that the face does not have, in their order.
Point3 on_face(int axis, double side, double u, double v) {
  Point3 x;
  x[axis] = side;
  x[axis == 0 ? 1 : 0] = u;
  x[axis == 2 ? 1 : 2] = v;
  return x;
}

constexpr double pixel = 1e-9;  // [m] across

// A layer of what the device shows along a ray.
double seen(const OneRay& look, const Ray& ray, const char* layer = "airlight") {
  return look(ray, pixel).layer(layer)[0];
}

const gpu::legendre_fluids::LegendreLight device_light;

// The film of `image`, and its comparison pixel by pixel with pictures that the device draws from `before` the face [m].
struct Image {
  int axis, side;
  std::vector<double> across, along;
  Tensor expected;
  Image(const Value& v, const char* field)
      : axis(v["face"]["axis"].integer_in(0, 2)),
        side(v["face"]["side"].integer_in(-1, 1)),
        across(v["u"].numbers()),
        along(v["v"].numbers()),
        expected(tensor_from(v[field])) {
    if (expected.shape != scene::TensorShape{int(across.size()), int(along.size()), 1})
      v[field].complain("a row for each u, a column for each v");
  }
  template <class Each>
  void each(Each&& each) const {
    Eigen::Index at = 0;
    for (const double u : across)
      for (const double v : along)
        each(fmt::format("u = {}, v = {}", u, v), on_face(axis, side, u, v), expected.values[at++]);
  }
  void compare(const OneRay& look, const Setting& s, double before, Outcome& out) const {
    each([&](const std::string& what, const Point3& x, double value) {
      out.add(absolute(what, value, seen(look, {x + before * s.to_eye, -s.to_eye}),
                       single * expected.values.cwiseAbs().maxCoeff()));
    });
  }
};

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
  return {"",
          [=](VerifyProfile) {
            Outcome out;
            for (std::size_t i = 0; i < rows.size(); ++i) {
              const double depth = scene::optical_depth(s.world.media, {rows[i].x, s.to_light}, {0, infinity})[0];
              out.add(relative(fmt::format("{} tau_d", i), rows[i].depth, depth, 1e-12, 1e-13));
              out.add(relative(fmt::format("{} E_d", i), rows[i].arriving, s.incoming * std::exp(-depth), 1e-12));
              add(out.comparisons, scattered(fmt::format("{} E_s", i), s, rows[i].x, infinity, rows[i].leaving));
            }
            return out;
          },
          [=](VerifyProfile) {
            const OneRay look(device_light, s.world);
            double most = 0;
            for (const Row& r : rows) most = std::max(most, r.leaving);
            Outcome out;
            for (std::size_t i = 0; i < rows.size(); ++i) {
              const Row& r = rows[i];
              const double arrives = s.incoming * seen(look, {r.x, s.to_light}, "transmittance");
              out.add(absolute(fmt::format("{} E_d", i), r.arriving, arrives, single * s.incoming));
              out.add(absolute(fmt::format("{} E_s", i), r.leaving, seen(look, {r.x, -s.to_eye}), single * most));
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
  return {"",
          [=](VerifyProfile) {
            Outcome out;
            for (std::size_t i = 0; i < rows.size(); ++i) {
              const Row& r = rows[i];
              const double depth = scene::optical_depth(s.world.media, {r.x, -s.to_eye}, {0, r.end})[0];
              const double behind = r.background * std::exp(-depth);
              out.add(relative(fmt::format("{} tau_view", i), r.depth, depth, 1e-12));
              out.add(relative(fmt::format("{} attenuated", i), r.attenuated, behind, 1e-12));
              const auto air = scattered(fmt::format("{} airlight", i), s, r.x, r.end, r.airlight);
              add(out.comparisons, air);
              out.add(relative(fmt::format("{} total", i), r.total, behind + air[0].got, accuracy));
            }
            return out;
          },
          // The depth and the background of each pixel lie behind the medium.
          [=](VerifyProfile) {
            double most = 0;
            for (const Row& r : rows) most = std::max(most, r.total);
            Outcome out;
            for (std::size_t i = 0; i < rows.size(); ++i) {
              const Row& r = rows[i];
              scene::Scene world = s.world;
              scene::Backdrop behind{1, 1, std::vector<float>(3, float(r.background)), {float(r.end)}, true};
              world.camera = view_along({r.x, -s.to_eye}, pixel).camera;
              world.backdrops = {std::make_shared<const scene::Backdrop>(behind)};
              const scene::Film film = OneRay(device_light, world)({r.x, -s.to_eye}, pixel);
              const auto near = [&](const char* what, double expected, const char* layer, double size) {
                out.add(absolute(fmt::format("{} {}", i, what), expected, film.layer(layer)[0], single * size));
              };
              near("airlight", r.airlight, "airlight", most);
              near("attenuated", r.attenuated, "surface", most);
              near("total", r.total, "mean", most);
              near("exp(-tau_view)", std::exp(-r.depth), "transmittance", 1);
            }
            return out;
          }};
}

Check read_legendre_image(const Value& v) {
  const Setting s = setting_from(v);
  const Image image(v, "E_s");
  return {"",
          [=](VerifyProfile) {
            Outcome out;
            image.each([&](const std::string& what, const Point3& x, double expected) {
              add(out.comparisons, scattered(what, s, x, infinity, expected));
            });
            return out;
          },
          [=](VerifyProfile) {
            Outcome out;
            image.compare({device_light, s.world}, s, 0, out);
            return out;
          }};
}

Check read_legendre_upwind(const Value& v) {
  constexpr double tolerance = 1e-12;
  const scene::LegendrePointer box = box_from(v);
  legendre_fluids::PaperOptions options;
  options.n = v["n"].integer_in(1, 12);
  options.solver.closure = legendre_fluids::Closure::upwind;
  const Vec3 light = direction_from(v["omega_d"]), view = direction_from(v["omega_s"]);
  const double sigma = v["sigma"].number_in(0, 1e9), beta = v["beta"].number_in(0, 1e9),
               g = v["g"].number_in(-0.999, 0.999);
  const double incoming = v["E_in"].number_in(0, 1e9);
  const double omega = phase_value(scene::HenyeyGreenstein{g}, std::clamp(light.dot(view), -1.0, 1.0));
  const bool flat_box = !v["R"][0][0].is_array();
  const scene::TensorShape all = {options.n, options.n, flat_box ? 1 : options.n};
  const auto coefficients = [&](const char* field) {
    Tensor tensor = tensor_from(v[field]);
    if (tensor.shape != all) v[field].complain(fmt::format("{} coefficients along each axis", options.n));
    return tensor;
  };
  const Tensor direct = coefficients("E_d_coeffs"), scattered = coefficients("E_s_coeffs");
  const double flat = flat_box ? std::sqrt(0.5) : 1;  // in two dimensions L_0 along z is left out of the coefficients
  std::optional<Image> image;
  if (v.has("E_s_image")) image.emplace(v, "E_s_image");
  Check check{"", [=](VerifyProfile) {
                const legendre_fluids::PaperLight paper(*box, options, {true, true, flat == 1});
                const Eigen::VectorXd e_d = incoming * paper.direct(light, sigma);
                const Eigen::VectorXd e_s = paper.scattered(e_d, view, sigma, beta * omega);
                Outcome out{largest_differences("E_d", direct.values, flat * e_d, tolerance)};
                out.add(largest_differences("E_s", scattered.values, flat * e_s, tolerance)[0]);
                if (!image) return out;
                const Eigen::VectorXd face = paper.on_face(e_s, image->axis, image->side);
                scene::TensorShape shape = paper.shape();
                shape[std::size_t(image->axis)] = 1;
                Eigen::VectorXd got(image->expected.values.size());
                Eigen::Index at = 0;
                image->each([&](const std::string&, const Point3& x, double) {
                  got[at++] = legendre_fluids::series_value(shape, face.data(), x);
                });
                out.add(largest_differences("image", image->expected.values, got, tolerance)[0]);
                return out;
              }};
  if (!(sigma >= 1e-9 && beta <= sigma)) {
    check.not_on_device = "the device knows no albedo above 1 and no medium without extinction";
    return check;
  }
  check.on_device = [=, s = setting_from(v)](VerifyProfile) {
    scene::Scene world = s.world;
    finish(world);
    const legendre_fluids::PaperMedium media = legendre_fluids::paper_medium(world);
    const std::vector<scene::DirectionalLight> lights{std::get<scene::DirectionalLight>(world.lights[0])};
    gpu::Context& context = gpu::Context::get();
    gpu::legendre_fluids::PaperSystems systems(context, media, lights, options, {true, true, !flat_box});
    systems.begin();
    Outcome out{largest_differences("E_d", direct.values, flat * incoming * systems.direct().at(0), single)};
    gpu::Frame frame(context);
    scene::Rendering rendering{scene::Film(1, 1), {}, {}};
    frame.begin({1, {}});
    systems.solve_scattered(frame, s.to_eye);
    frame.finish(rendering);
    out.add(truth("converged", systems.keep_up(frame)));
    const std::vector<float> series = systems.faces().download<float>();
    const scene::TensorShape shape = systems.shape();
    Eigen::VectorXd got(scattered.values.size());
    Eigen::Index at = 0;
    for (int i = 0; i < shape[0]; ++i)
      for (int j = 0; j < shape[1]; ++j)
        for (int k = 0; k < shape[2]; ++k, ++at)
          got[at] = flat * systems.scale()[0] * series[std::size_t(at)] / std::sqrt((i + 0.5) * (j + 0.5) * (k + 0.5));
    out.add(largest_differences("E_s", scattered.values, got, single)[0]);
    if (image)
      image->compare(
          {device_light, s.world, {{"variant", "paper"}, {"closure", "upwind"}, {"n", std::to_string(options.n)}}}, s,
          1, out);
    return out;
  };
  return check;
}

}  // namespace airlight::experiments::verification
