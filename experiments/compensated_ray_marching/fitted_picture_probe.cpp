#include "experiments/compensated_ray_marching/fitted_picture_probe.h"

#include <algorithm>
#include <cmath>

#include "experiments/application/renderers.h"
#include "experiments/compensated_ray_marching/fitted_smoke.h"
#include "scene/base/error.h"
#include "scene/convert/gaussian_samples.h"
#include "scene/convert/residual_file.h"
#include "scene/media/fitted.h"

namespace airlight::experiments {
namespace {

enum class Residual { left_out, kept, within_support };
const scene::Choices<Residual> residuals{
    {"left_out", Residual::left_out}, {"kept", Residual::kept}, {"within_support", Residual::within_support}};

constexpr float least_sum = 1e-10f;  // of the Gaussians, below which Zhou et al. take the residual as 0

std::size_t first_with_voxels(const scene::Scene& scene) {
  for (std::size_t i = 0; i < scene.media.size(); ++i)
    if (scene::grid_of(scene.media[i].field)) return i;
  throw Error("fitted_picture: no medium of the scene has voxels");
}

// Relative L2, difference of the means over the mean, root mean square over the greatest value: of the layer "mean" of both films, all
// channels together.
struct Difference {
  double relative_l2, bias, over_most;
};
Difference difference(const scene::Film& film, const scene::Film& truth) {
  const auto &a = film.layer("mean"), &b = truth.layer("mean");
  double squares = 0, norm = 0, sum = 0, mean = 0, most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double off = double(a[i]) - b[i];
    squares += off * off;
    norm += double(b[i]) * b[i];
    sum += off;
    mean += b[i];
    most = std::max(most, double(b[i]));
  }
  return {std::sqrt(squares / norm), sum / mean, std::sqrt(squares / double(a.size())) / most};
}

}  // namespace

std::string FittedPicture::about() const {
  return "error of a picture of smoke as Gaussians and residual, against one of its voxels; Zhou et al. 2008, Figures 3 and 9";
}

std::vector<scene::SettingSpec> FittedPicture::settings() const {
  return {
      scene::choice_setting("renderer", "path_tracer", {"path_tracer", "deterministic", "ray_marcher"},
                            "of all pictures"),
      scene::integer_setting("samples", "16", 1, 1e6, "a pixel, of the path tracer"),
      scene::integer_setting("gaussians", "400", 0, 100000, "fitted to the voxels"),
      scene::choice_setting("residual", Residual::kept, residuals,
                            "within_support: the density is 0 where the Gaussians are below 1e-10, as in the paper"),
      scene::flag_setting("keep_empty", false, "no density where the smoke has none, whatever the threshold"),
      scene::integer_setting("threshold", "0", 0, 126, "levels of this size or less are dropped")};
}

std::vector<std::string> FittedPicture::figures() const {
  return {"rel_l2", "beyond_noise", "bias", "rms_over_max", "noise", "density_percent", "residual_kB"};
}

Findings FittedPicture::run(const ProbeInput& input, const scene::Settings& s,
                            const scene::Execution& execution) const {
  if (input.file.empty()) throw Error("fitted_picture: a [[scene]] with voxels is needed");
  const scene::Scene original = scene::load_scene(input.file.string(), input.overrides);
  const std::size_t medium = first_with_voxels(original);
  const scene::VoxelGrid& grid = *scene::grid_of(original.media[medium].field);

  auto fitted = std::make_shared<scene::Fitted>();
  fitted->gaussians = gaussians_for(grid, int(s.integer("gaussians")), execution);
  const Residual kind = s.choice("residual", residuals);
  const scene::Residual residual =
      scene::residual_of(grid, fitted->gaussians, {int(s.integer("threshold")), {}, s.flag("keep_empty")});
  if (kind != Residual::left_out) fitted->residual = std::make_shared<const scene::Residual>(residual);
  fitted->grid = kind == Residual::left_out ? decoded(residual.layout, fitted->gaussians, {})
                                            : decoded(fitted->gaussians, residual);
  if (kind == Residual::within_support) {
    const std::vector<float> sum = scene::gaussian_samples(fitted->gaussians, residual.layout);
    for (std::size_t i = 0; i < sum.size(); ++i)
      if (sum[i] < least_sum) fitted->grid.values[i] = 0;
  }

  scene::Execution rendering = execution;
  rendering.store = nullptr;  // pictures are made, not kept
  const scene::Renderer& renderer = find_renderer(s.text("renderer"), "fitted_picture");
  const bool paths = renderer.name() == "path_tracer";
  const auto film = [&](const scene::DensityField& field, int seed) {
    auto scene = std::make_shared<scene::Scene>(original);
    scene->media[medium].field = field;
    scene::finish(*scene);
    std::map<std::string, std::string> given;
    if (paths) given = {{"samples", std::to_string(s.integer("samples"))}, {"seed", std::to_string(seed)}};
    return renderer.prepare(scene, scene::Settings(renderer.settings(), given), rendering)
        ->render(view_of(*scene), rendering)
        .film;
  };
  // Another seed than the original's: what they have in common must not look like agreement.
  const scene::Film truth = film(original.media[medium].field, 1);
  const Difference d = difference(film(scene::FittedPointer(fitted), 2), truth);
  const double noise = paths ? difference(film(original.media[medium].field, 3), truth).relative_l2 : 0;
  double squares = 0, norm = 0;
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    squares += std::pow(double(fitted->grid.values[i]) - grid.values[i], 2);
    norm += std::pow(double(grid.values[i]), 2);
  }
  Findings found;
  found.figures = {
      exactly("rel_l2", d.relative_l2),
      exactly("bias", d.bias),
      exactly("rms_over_max", d.over_most),
      exactly("noise", noise),
      exactly("beyond_noise", std::sqrt(std::max(0.0, d.relative_l2 * d.relative_l2 - noise * noise))),
      exactly("density_percent", 100 * std::sqrt(squares / norm)),
      exactly("residual_kB", fitted->residual ? 1e-3 * double(scene::residual_bytes(residual).size()) : 0)};
  return found;
}

}  // namespace airlight::experiments
