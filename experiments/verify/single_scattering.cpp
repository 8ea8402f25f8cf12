// Order (1, 0) from delta lights, by the deterministic reference.
#include <fmt/format.h>

#include <algorithm>

#include "experiments/verify/readers.h"
#include "experiments/verify/vector_scene.h"
#include "reference/deterministic/airlight.h"
#include "reference/deterministic/limits.h"

namespace airlight::experiments::verification {
namespace {

constexpr double sharpest = 1e-13;  // a tenth of it is what the quadrature can meet
constexpr double most_terms = 1e9;  // ten seconds, where no ray meets its tolerance

// Ten times sharper than the vector's own tolerance, so that the quadrature spends a tenth of it.
Comparison order_one(std::string what, double expected, const scene::Scene& scene, const Ray& ray, double t_end,
                     double tolerance) {
  const deterministic::Airlight got = deterministic::airlight(scene, ray, t_end, {0.1 * tolerance});
  Comparison c = relative(std::move(what), expected, got.radiance[0], tolerance);
  if (!got.converged) {
    c.tolerance_text = "quadrature not converged";
    c.tolerance = -1;
  }
  return c;
}

}  // namespace

Check read_airlight_scene(const Value& v) {
  const Value in = v["in"];
  scene::Scene scene;
  scene.media = {gaussian_fog(gaussians_from_objects(in["gaussians"]), in["beta0"].number(), 1, scene::Isotropic{})};
  scene.lights = {scene::PointLight{in["light"].vector(), Rgb::Constant(in["I0"].number()), 0}};
  const Ray ray = ray_from(in["view"], in["dir"]);
  const double end = in["d_r"].number_or_infinite(), expected = v["value"].number();
  return {"", [=](VerifyProfile) { return Outcome{{order_one("L1", expected, scene, ray, end, 1e-9)}}; }};
}

Check read_single_scattering_shape(const Value& v) {
  const Value in = v["input"], shape = in["shape"];
  scene::Region region;
  if (shape["type"].text() == "sphere")
    region = scene::Sphere{Point3::Zero(), shape["R"].number()};
  else if (shape["type"].text() == "box")
    region = Box{shape["lo"].vector(), shape["hi"].vector()};
  else
    shape["type"].complain("sphere or box");
  scene::Scene scene;
  scene.media = {fog(region, in["sigma_t"].number_in(0, 1e300), in["albedo"].number_in(0, 1),
                     phase_from(in["phase"]["name"], number_or(in["phase"], "g", 0)))};
  scene.lights = {light_from(in["light"])};
  const Ray ray = ray_from(in["o"], in["d"]);
  const double expected = v["expected"]["L1"].number();
  const double accuracy = v["accuracy"]["rel"].number_in(sharpest, 1);
  return {"", [=](VerifyProfile) { return Outcome{{order_one("L1", expected, scene, ray, infinity, accuracy)}}; }};
}

Check read_single_scattering_gaussians(const Value& v) {
  const Value in = v["input"];
  scene::Scene scene;
  scene.media = {gaussian_fog(gaussians_from_rows(in["gaussians"]), in["b0"].number_in(0, 1e300),
                              in["albedo"].number_in(0, 1),
                              phase_from(in["phase"]["name"], number_or(in["phase"], "g", 0)))};
  for (std::size_t i = 0; i < in["lights"].size(); ++i) scene.lights.push_back(light_from(in["lights"][i]));
  const Point3 eye = in["eye"].vector();
  struct Row {
    Ray ray;
    double length, radiance, depth;
  };
  std::vector<Row> rows;
  const Value rays = v["expected"]["rays"];
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3 offset = rays[i]["p"].vector() - eye;
    rows.push_back({{eye, offset.normalized()}, offset.norm(), rays[i]["L1"].number(), rays[i]["T"].number()});
  }
  const double accuracy = v["accuracy"]["rel"].number_in(sharpest, 1);
  const double each = std::max(deterministic::terms_of_ray(scene), double(deterministic::Accuracy().max_evaluations) *
                                                                       deterministic::terms_of_evaluation(scene));
  if (const double needed = double(rows.size()) * each; needed > most_terms)
    v["input"].complain(
        fmt::format("at most {:.0e} evaluations of terms of densities, not {:.1g}: fewer rays, lights "
                    "or Gaussians",
                    most_terms, needed));
  return {"", [=](VerifyProfile) {
            Outcome out;
            for (std::size_t i = 0; i < rows.size(); ++i) {
              const Row& r = rows[i];
              const std::string ray = "ray " + std::to_string(i);
              out.add(order_one(ray + " L1", r.radiance, scene, r.ray, r.length, accuracy));
              out.add(relative(ray + " depth", r.depth, scene::optical_depth(scene.media, r.ray, {0, r.length})[0],
                               accuracy));
            }
            return out;
          }};
}

}  // namespace airlight::experiments::verification
