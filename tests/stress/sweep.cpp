#include "tests/stress/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>

#include "experiments/application/renderers.h"
#include "reference/ray_marcher/options.h"
#include "scene/base/error.h"
#include "scene/film/film.h"
#include "scene/scene.h"
#include "tests/pictures.h"

namespace airlight::stress {
namespace {

using scene::Film;
using test::all_finite;

// How far apart two pictures of one renderer may be, relative to the brightest pixel: its arithmetic. And from the
// truth: what its page says of it.
struct Tolerance {
  double own, truth;
};

bool has_gaussians(const scene::Scene& scene) {
  return std::any_of(scene.media.begin(), scene.media.end(), [](const scene::Medium& medium) {
    return std::holds_alternative<scene::GaussianSum>(medium.field);
  });
}

// Fogshop's closed forms alone are exact. S: its light maps of 64^2 directions, 0.003 of the brightest measured in
// `smoke` (3e-5 with exact depths), 0.006 in a Gaussian 18 deep. paper: a quarter, or
// it warns (domain.h): 0.24. The sky's grid of 24 cells and 64 directions: 0.014.
double fogshop_error(const std::string& spec, const scene::Scene& scene) {
  if (!has_gaussians(scene)) return 1e-5;
  if (spec.ends_with("paper")) return 0.25;
  return spec.ends_with("volume") ? 0.02 : 0.01;
}

// Whether its airlight is that of one scattering, which is what the quadrature knows; of all orders only many paths know it.
bool of_one_scattering(const std::string& spec) {
  return !spec.starts_with("compensated_ray_marching") || spec.find("multiple=none") != std::string::npos;
}

// Fog of engines: a lamp is a centimetre away at least, and steps are equal. Where its picture warns of that no law holds.
bool is_engine_fog(const std::string& spec) {
  return spec.starts_with("froxel_fog") || spec.starts_with("half_resolution_march");
}

Tolerance tolerance(const std::string& spec, const scene::Scene& scene) {
  const std::string renderer = spec.substr(0, spec.find(' '));
  if (renderer == "deterministic") return {1e-6, 1e-6};
  if (renderer == "shadow_planes") return {1e-6, 1e-4};
  if (renderer == "fogshop") return {1e-5, fogshop_error(spec, scene)};
  if (renderer == "ray_marcher") return {2e-3, ray_marcher::stated_error(scene)};
  // Equal steps or slices that are no coarser than they warn of, and maps of lights with 32 slices.
  if (is_engine_fog(renderer)) return {2e-3, 0.05};
  if (renderer == "path_tracer") return {1e-5, 1e-5};  // beside its standard error
  if (renderer == "ray_marcher_gpu") return {2e-3, ray_marcher::stated_error(scene)};
  // 12 cells, between whose middles source radiance is interpolated: 0.047. paper: by two Gaussians' centres, 0.14.
  if (renderer.starts_with("compensated_ray_marching"))
    return {renderer.ends_with("_gpu") ? 2e-4 : 2e-5, spec.find("paper") == std::string::npos ? 0.05 : 0.2};
  // Panels to a relative 1e-5.
  if (renderer == "legendre_fluids") return {2e-5, 2e-5};
  // Columns to the sun from a map of half cells: 0.0006.
  if (renderer == "wavelet_fog") return {1e-5, 0.002};
  return {2e-3, renderer == "fogshop_gpu" ? 2e-3 + fogshop_error(spec, scene) : 0.01};
}

enum class Outcome { right, at_loading, by_name, wrong, unavailable };

struct Picture {
  Outcome outcome = Outcome::right;
  std::string message;
  Film film;
};

Picture picture(const std::string& text, const std::string& spec) {
  std::shared_ptr<const scene::Scene> scene;
  try {
    scene = std::make_shared<const scene::Scene>(scene::parse_scene(text, "sweep", "."));
  } catch (const Error& e) {
    return {Outcome::at_loading, e.what(), {}};
  }
  std::istringstream words(spec);
  std::string renderer_name, word;
  words >> renderer_name;
  std::map<std::string, std::string> given;
  if (renderer_name == "path_tracer") given["samples"] = "1024";
  while (words >> word) given[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
  const scene::Renderer& renderer = experiments::find_renderer(renderer_name, "sweep");
  const scene::Settings settings(renderer.settings(), given);
  if (const auto reasons = renderer.supports(*scene, settings); !reasons.empty())
    return {Outcome::by_name, reasons.front(), {}};
  try {
    return {Outcome::right, "", renderer.prepare(scene, settings, {1, {}})->render(view_of(*scene), {1, {}}).film};
  } catch (const Unavailable& e) {
    return {Outcome::unavailable, e.what(), {}};
  } catch (const Error& e) {
    return {Outcome::by_name, e.what(), {}};
  }
}

double greatest(const Film& film, const std::string& layer) {
  double most = 0;
  for (const float v : film.layer(layer)) most = std::max(most, double(std::abs(v)));
  return most;
}

// The difference, as text, between `film` and `expected` times `ratio`, where it exceeds `share` of the brightest pixel
// and, if known, six standard errors (128 pixels of a sweep: 3e-7 of a false alarm). A picture holds nothing below
// 1e-45, and full precision from 1.2e-38 on.
std::string difference(const Film& film, const Film& expected, double ratio, const std::string& layer, double share,
                       bool dark) {
  const double most = greatest(expected, layer) * ratio;
  if (!(most <= 3.4e38)) {
    for (const float v : film.layer(layer))
      if (!std::isfinite(v)) return "";  // no number of a picture: refused when it is written
    return fmt::format("finite where {:.3g} is expected", most);
  }
  const bool noisy = film.has("se");
  double found = 0, sum = 0;
  for (std::size_t i = 0; i < film.layer(layer).size(); ++i) {
    const double v = film.layer(layer)[i], e = dark ? 0 : expected.layer(layer)[i] * ratio;
    if (!std::isfinite(v)) return fmt::format("{} where {:.3g} is expected", v, e);
    double allowed = share * most + 1e-37;
    // The standard error is that of the mean: below 1.5e-8 of it, squares of sums have no digits.
    if (noisy)
      allowed += 6 * std::hypot(film.layer("se")[i], expected.has("se") ? expected.layer("se")[i] * ratio : 0) +
                 (layer == "mean" ? 0 : 1.5e-8 * film.layer("mean")[i]);
    found += v, sum += e;
    if (std::abs(v - e) > allowed)
      return fmt::format("value {}: {:.6g} where {:.6g} is expected, brightest {:.3g}", i, v, e, most);
  }
  // Nor may all light be missed, with standard errors of 0 or of something else.
  if (noisy && sum > 1e-36 && !(std::abs(found - sum) < 0.5 * sum))
    return fmt::format("a sum of {:.3g} where {:.3g} is expected", found, sum);
  return "";
}

// The truth, of one scattering or of all, kept: many cases begin at one scene.
const Picture& truth_of(const std::string& text, bool single) {
  static std::map<std::string, Picture> known;
  const auto [place, made] = known.try_emplace((single ? "1 " : "all ") + text);
  const bool sky = text.find("'environment'") != std::string::npos;
  if (made)
    place->second = picture(text, !single ? "path_tracer paths=scattered samples=16384 seed=7"
                                  : sky   ? "path_tracer max_order=1 samples=65536 seed=7"
                                          : "deterministic");
  // The tracer's own layer of that name holds one scattering.
  if (made && !single && place->second.outcome == Outcome::right)
    place->second.film.layers["airlight"] = place->second.film.layer("mean");
  return place->second;
}

// The greatest distance of a layer from the truth, relative to its brightest pixel.
double error_of(const Film& film, const Film& truth, const std::string& layer) {
  double most = 0, error = 0;
  for (std::size_t i = 0; i < film.layer(layer).size(); ++i) {
    most = std::max(most, double(std::abs(truth.layer(layer)[i])));
    error = std::max(error, double(std::abs(film.layer(layer)[i] - truth.layer(layer)[i])));
  }
  return most > 0 ? error / most : 0;
}

// One renderer, one case.
struct Swept {
  const SweepCase& c;
  const std::string& spec;
  Tally& tally;

  void wrong(double s, const std::string& what) {
    ++tally.wrong;
    tally.details.push_back(fmt::format("{:.0e}: {}", s, what));
  }

  // Counts a picture that is as it should be unless `what` says why not; a picture that warns of its approximation is
  // not held to the truth, and is counted as what it is.
  void count(double s, const Film& film, const std::string& what) {
    if (!what.empty())
      wrong(s, what);
    else
      ++(film.metadata.contains("warning") ? tally.warned : tally.right);
  }

  // Compared is the light that the air scatters.
  std::string untrue(const std::string& text, const Film& film, double tolerance) {
    const Picture& truth = truth_of(text, of_one_scattering(spec));
    const std::string single = c.layer == "mean" ? "airlight" : c.layer;
    if (truth.outcome != Outcome::right) return "truth: " + truth.message;
    if (!truth.film.has(single) || !film.has(single)) return "";
    tally.error = std::max(tally.error, error_of(film, truth.film, single));
    if (film.metadata.contains("warning")) return all_finite(film) ? "" : "not finite";
    return difference(film, truth.film, 1, single, tolerance, false);
  }

  // Is there a picture? If not, that is counted.
  bool drawn(const Picture& p) {
    if (p.outcome == Outcome::at_loading) ++tally.at_loading;
    if (p.outcome == Outcome::by_name) ++tally.by_name;
    return p.outcome == Outcome::right;
  }

  void against_truths() {
    for (const double s : c.truths) {
      const Picture p = picture(c.text(s), spec);
      if (!drawn(p)) continue;
      const scene::Scene scene = scene::parse_scene(c.text(s), "sweep", ".");
      count(s, p.film, untrue(c.text(s), p.film, tolerance(spec, scene).truth));
    }
  }

  void by_law(const std::vector<double>& values) {
    const Picture base = picture(c.text(c.base), spec);
    if (base.outcome != Outcome::right) tally.details.push_back(base.message);
    tally.available = base.outcome == Outcome::right && base.film.has(c.layer);
    if (!tally.available) return;
    const Tolerance of = tolerance(spec, scene::parse_scene(c.text(c.base), "sweep", "."));
    if (const std::string d = untrue(c.text(c.base), base.film, of.truth); !d.empty()) wrong(c.base, "base: " + d);
    for (const double s : values) {
      const bool outside = s < c.from || s > c.to;
      // The law says nothing there or nothing new, but the ends must be refused or right.
      if ((outside || s == c.base) && s >= 1e-100 && s <= 1e100) continue;
      const Picture p = picture(c.text(s), spec);
      if (!drawn(p)) continue;
      if (outside || (is_engine_fog(spec) && p.film.metadata.contains("warning")))
        count(s, p.film, all_finite(p.film) ? "" : "not finite");
      else
        count(s, p.film,
              difference(p.film, base.film, c.factor(s) / c.factor(c.base), c.layer, of.own + c.law, c.dark));
    }
  }
};

}  // namespace

std::map<std::string, Tally> sweep(const SweepCase& c, const std::vector<double>& values,
                                   const std::vector<std::string>& renderers) {
  std::map<std::string, Tally> result;
  for (const std::string& spec : renderers) {
    Swept swept{c, spec, result[spec]};
    c.truths.empty() ? swept.by_law(values) : swept.against_truths();
  }
  return result;
}

}  // namespace airlight::stress
