#include "experiments/verify/vector_scene.h"

namespace airlight::experiments::verification {

scene::PhaseFunction phase_from(const Value& name, double g) {
  const std::string& text = name.text();
  if (text == "iso" || text == "isotropic") return scene::Isotropic{};
  if (text == "ray" || text == "rayleigh") return scene::Rayleigh{};
  if (text == "hazy") return scene::Hazy{};
  if (text == "murky") return scene::Murky{};
  if (text == "hg") {
    if (!(g > -1 && g < 1)) name.complain("hg with -1 < g < 1");
    return scene::HenyeyGreenstein{g};
  }
  name.complain("iso, ray, hg, hazy or murky");
}

scene::Light light_from(const Value& v) {
  const std::string& type = v["type"].text();
  if (type == "point") return scene::PointLight{v["pos"].vector(), Rgb::Constant(v["I"].number()), 0};
  if (type == "directional")
    return scene::DirectionalLight{v["to_light"].vector().normalized(), Rgb::Constant(v["E"].number())};
  v["type"].complain("point or directional");
}

Ray ray_from(const Value& origin, const Value& direction) {
  const Vec3 d = direction.vector();
  if (!(d.norm() > 0)) direction.complain("a direction that is not zero");
  return {origin.vector(), d.normalized()};
}

scene::Medium fog(const scene::Region& region, double sigma_t, double albedo, const scene::PhaseFunction& phase) {
  scene::Medium medium;
  medium.region = region;
  medium.sigma_t = Rgb::Constant(sigma_t);
  medium.albedo = Rgb::Constant(albedo);
  medium.phase = phase;
  return medium;
}

scene::Medium gaussian_fog(const std::vector<RawGaussian>& raw, double b0, double albedo,
                           const scene::PhaseFunction& phase) {
  scene::GaussianSum sum;
  sum.constant = b0;
  for (const RawGaussian& g : raw) sum.gaussians.push_back({g.b, 1 / g.a, g.c});
  scene::Medium medium = fog(scene::Unbounded{}, 1, albedo, phase);
  medium.field = sum;
  return medium;
}

std::vector<RawGaussian> gaussians_from_objects(const Value& v) {
  std::vector<RawGaussian> list;
  for (std::size_t i = 0; i < v.size(); ++i)
    list.push_back({v[i]["a"].number(), v[i]["c"].number(), v[i]["b"].vector()});
  return list;
}

std::vector<RawGaussian> gaussians_from_rows(const Value& v) {
  std::vector<RawGaussian> list;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (v[i].size() != 3) v[i].complain("[c, a, [x, y, z]]");
    list.push_back({v[i][1].number(), v[i][0].number(), v[i][2].vector()});
  }
  return list;
}

}  // namespace airlight::experiments::verification
