#include "methods/fogshop/fog.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/base/error.h"

namespace airlight::fogshop {
namespace {

using scene::GaussianSum;
using scene::Homogeneous;
using scene::Medium;
// The mean cosine of isotropic and Henyey-Greenstein scattering; nothing for other phase functions, which Fogshop refuses.
std::optional<double> mean_cosine_of(const scene::PhaseFunction& phase) {
  if (std::holds_alternative<scene::Isotropic>(phase)) return 0;
  const auto* hg = std::get_if<scene::HenyeyGreenstein>(&phase);
  return hg ? std::optional(hg->g) : std::nullopt;
}

std::string objection_to(const GaussianSum& sum) {
  if (sum.cutoff < 6) return fmt::format("cuts its Gaussians at {} widths, and this method's have no end", sum.cutoff);
  if (std::any_of(sum.gaussians.begin(), sum.gaussians.end(), [](const auto& g) { return g.amplitude < 0; }))
    return "has a Gaussian of negative amplitude, and densities here cannot be clamped at 0";
  return "";
}

}  // namespace

std::vector<std::string> unsupported_media(const std::vector<Medium>& media) {
  std::vector<std::string> reasons;
  const Medium* first = nullptr;
  for (std::size_t i = 0; i < media.size(); ++i) {
    const Medium& medium = media[i];
    if (!extinguishes(medium)) continue;
    const auto object = [&](const std::string& why) { reasons.push_back(label(media, i) + " " + why); };
    if (const std::string why = scene::unknown_field<Homogeneous, GaussianSum>(media, i); !why.empty())
      reasons.push_back(why);
    const auto* sum = std::get_if<GaussianSum>(&medium.field);
    if (const std::string why = sum ? objection_to(*sum) : ""; !why.empty()) object(why);
    if (!std::holds_alternative<scene::Unbounded>(medium.region))
      object("is bounded, and the closed forms know no boundary");
    const auto g = mean_cosine_of(medium.phase);
    if (!g) object(fmt::format("has phase function {}, expected isotropic or hg", phase_name(medium.phase)));
    if (g.value_or(0) != 0 && constant_part(medium.field) > 0)
      object("has a constant and phase function hg: its closed form (Eq. 17) is of the isotropic one");
    if (first && mean_cosine_of(first->phase) && g && g != mean_cosine_of(first->phase))
      object("has another phase function than the first");
    if (!first) {
      first = &medium;
      continue;
    }
    const Rgb extinction_ratio = medium.sigma_t / medium.sigma_t.maxCoeff(),
              other = first->sigma_t / first->sigma_t.maxCoeff();
    if (((extinction_ratio - other).abs() > 1e-12).any())
      object("extinguishes in another extinction_ratio than the first");
  }
  return reasons;
}

Fog make_fog(const std::vector<Medium>& media) {
  Fog fog;
  bool first = true;
  std::vector<Rgb> albedos;           // of the Gaussians
  Rgb from_constant = Rgb::Zero();    // what the constants scatter [1/m], at extinction ratio 1
  std::vector<Rgb> constant_albedos;  // of media with a constant
  for (const Medium& medium : media) {
    if (!extinguishes(medium)) continue;
    const double strength = medium.sigma_t.maxCoeff();
    if (first) {
      fog.extinction_ratio = medium.sigma_t / strength;
      fog.albedo = medium.albedo;
      fog.g = mean_cosine_of(medium.phase).value();
      first = false;
    }
    const auto add_constant = [&](double extinction) {
      if (!(extinction > 0)) return;
      fog.sum.constant += extinction;
      from_constant += extinction * medium.albedo;
      constant_albedos.push_back(medium.albedo);
    };
    add_constant(strength * constant_part(medium.field));
    const auto* sum = std::get_if<GaussianSum>(&medium.field);
    if (!sum) continue;  // homogeneous: supports() refuses all other fields
    for (scene::Gaussian g : sum->gaussians) {
      g.amplitude *= strength;
      fog.sum.gaussians.push_back(g);
      albedos.push_back(medium.albedo);
    }
  }
  const auto differs = [&](const Rgb& albedo) { return ((albedo - fog.albedo).abs() > 1e-12).any(); };
  if (std::none_of(albedos.begin(), albedos.end(), differs) &&
      std::none_of(constant_albedos.begin(), constant_albedos.end(), differs))
    return fog;
  const Rgb constant_albedo = fog.sum.constant > 0 ? Rgb(from_constant / fog.sum.constant) : Rgb(Rgb::Zero());
  fog.albedo = constant_albedo;
  for (const Rgb& albedo : albedos) fog.albedo = fog.albedo.max(albedo);
  const Rgb most = (fog.albedo > 0).select(fog.albedo, 1.0);
  for (const Rgb& albedo : albedos) fog.colours.push_back(albedo / most);
  fog.constant_colour = constant_albedo / most;
  return fog;
}

}  // namespace airlight::fogshop
