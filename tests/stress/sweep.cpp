#include "tests/stress/sweep.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "experiments/renderers.h"
#include "reference/ray_marcher/options.h"
#include "scene/error.h"
#include "scene/film.h"
#include "scene/scene.h"

namespace airlight::stress {
namespace {

using scene::Film;

// How far apart two pictures of one renderer may be, relative to the brightest pixel: its arithmetic. And from the
// quadrature at the base: what its page says of it.
struct Tolerance {
  double own, truth;
};
Tolerance tolerance(const std::string& renderer, const scene::Scene& scene) {
  if (renderer == "deterministic") return {1e-6, 1e-6};
  if (renderer == "shadow_planes") return {1e-6, 1e-4};
  if (renderer == "fogshop") return {1e-5, 0.25};  // approximate; its error is measured elsewhere
  if (renderer == "ray_marcher") return {2e-3, ray_marcher::stated_error(scene)};
  if (renderer == "path_tracer") return {1e-5, 1e-5};  // beside its standard error
  if (renderer == "ray_marcher_gpu") return {2e-3, ray_marcher::stated_error(scene)};
  return {2e-3, renderer == "fogshop_gpu" ? 0.25 : 0.01};
}

enum class Outcome { right, at_loading, by_name, wrong, unavailable };

struct Picture {
  Outcome outcome = Outcome::right;
  std::string message;
  Film film;
};

Picture picture(const std::string& text, const std::string& renderer_name) {
  std::shared_ptr<const scene::Scene> scene;
  try {
    scene = std::make_shared<const scene::Scene>(scene::parse_scene(text, "sweep", "."));
  } catch (const Error& e) {
    return {Outcome::at_loading, e.what(), {}};
  }
  const scene::Renderer& renderer = experiments::find_renderer(renderer_name, "sweep");
  std::map<std::string, std::string> given;
  if (renderer_name == "path_tracer") given["samples"] = "1024";
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

// What is wrong with `film`, which should be `expected` times `ratio` to `share` of its brightest pixel and, where it
// is known, six standard errors (128 pixels of a sweep: 3e-7 of a false alarm). A picture holds nothing below 1e-45,
// and full precision from 1.2e-38 on.
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
    if (noisy) allowed += 6 * std::hypot(film.layer("se")[i], expected.has("se") ? expected.layer("se")[i] * ratio : 0);
    found += v, sum += e;
    if (std::abs(v - e) > allowed)
      return fmt::format("value {}: {:.6g} where {:.6g} is expected, brightest {:.3g}", i, v, e, most);
  }
  // Nor may all light be missed, with standard errors of 0 or of something else.
  if (noisy && sum > 1e-36 && !(std::abs(found - sum) < 0.5 * sum))
    return fmt::format("a sum of {:.3g} where {:.3g} is expected", found, sum);
  return "";
}

bool all_finite(const Film& film) {
  for (const auto& [name, values] : film.layers)
    for (const float v : values)
      if (!std::isfinite(v)) return false;
  return true;
}

}  // namespace

std::map<std::string, Tally> sweep(const SweepCase& c, const std::vector<double>& values,
                                   const std::vector<std::string>& renderers) {
  std::map<std::string, Tally> result;
  const Picture truth = picture(c.text(c.base), "deterministic");
  if (truth.outcome != Outcome::right) {
    Tally& t = result["deterministic"];
    t.wrong = 1, t.details.push_back("base: " + truth.message);
    return result;
  }
  for (const std::string& name : renderers) {
    Tally& tally = result[name];
    const auto wrong = [&](double s, const std::string& what) {
      ++tally.wrong;
      tally.details.push_back(fmt::format("{:.0e}: {}", s, what));
    };
    const Picture base = picture(c.text(c.base), name);
    if (base.outcome != Outcome::right) {
      tally.available = false;
      tally.details.push_back(base.message);
      continue;
    }
    const Tolerance of = tolerance(name, scene::parse_scene(c.text(c.base), "sweep", "."));
    if (!base.film.has(c.layer)) {
      tally.available = false;
      continue;
    }
    // The quadrature has one scattering (and none of an environment): that is what is compared where the other has
    // more.
    const std::string single = c.layer == "mean" ? "airlight" : c.layer;
    if (truth.film.has(single))
      if (const std::string d = difference(base.film, truth.film, 1, single, of.truth, false); !d.empty())
        wrong(c.base, "base: " + d);
    for (const double s : values) {
      if (s < c.from || s > c.to || s == c.base) {
        if (s >= 1e-100 && s <= 1e100) continue;  // the law says nothing, but the ends must be refused or right
      }
      const Picture p = picture(c.text(s), name);
      if (p.outcome == Outcome::at_loading) {
        ++tally.at_loading;
      } else if (p.outcome == Outcome::by_name) {
        ++tally.by_name;
      } else if (s < c.from || s > c.to) {
        all_finite(p.film) ? void(++tally.right) : wrong(s, "not finite");
      } else {
        const std::string d =
            difference(p.film, base.film, c.factor(s) / c.factor(c.base), c.layer, of.own + c.law, c.dark);
        d.empty() ? void(++tally.right) : wrong(s, d);
      }
    }
  }
  return result;
}

}  // namespace airlight::stress
