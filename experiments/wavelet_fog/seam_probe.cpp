#include "experiments/wavelet_fog/seam_probe.h"

#include <algorithm>
#include <cmath>

#include "experiments/wavelet_fog/rays.h"

namespace airlight::experiments {
namespace {

namespace fog = airlight::wavelet_fog;

constexpr double near_object = 20, far_object = 80;  // [cells]
enum class Depth { paper, tele, direct };
const scene::Choices<Depth> depths{{"paper", Depth::paper}, {"tele", Depth::tele}, {"direct", Depth::direct}};
const scene::Choices<fog::Coarse> grids{
    {"wavelet", fog::Coarse::wavelet}, {"clamped", fog::Coarse::clamped}, {"restricted", fog::Coarse::restricted}};

struct Reading {
  Depth depth;
  double mu;

  // Column over t of a ray that ends at `length`.
  double operator()(const fog::Levels& levels, const scene::MapLine& line, Interval t, double length,
                    fog::Visits& visits) const {
    const scene::HeightProfile same = scene::SameAtAllHeights{};
    const double reach = fog::length_in_box(levels, line, length);
    switch (depth) {
      case Depth::paper:
        return fog::summed_depth(levels, same, line, t, reach, mu, visits);
      case Depth::tele:
        return fog::telescoped_depth(levels, same, line, t, reach, mu, visits);
      case Depth::direct:
        break;
    }
    return fog::integral_of_level(levels.grid[0], 0, same, line, t, visits);
  }
};

// Root mean square and greatest of what is added.
struct Spread {
  double sum = 0, most = 0;
  long count = 0;
  void add(double x) {
    sum += x * x;
    most = std::max(most, std::abs(x));
    ++count;
  }
  double rms() const { return std::sqrt(sum / double(count)); }
};

}  // namespace

std::string WaveletSeams::about() const {
  return "levels by the object's distance: errors of the transmittance, and seams at silhouettes (Giroud and Biri 2010, eq. 12)";
}

std::vector<scene::SettingSpec> WaveletSeams::settings() const {
  return {
      scene::choice_setting("depth", Depth::paper, depths, "how the depth comes about, as the variants of wavelet_fog"),
      scene::choice_setting("coarse", fog::Coarse::wavelet, grids, "coarse grids"),
      scene::integer_setting("levels", "3", 0, 20, "of the decomposition"),
      scene::real_setting("mu", "0.6", 0, 1, "detail m counts up to |OP| mu^m"),
      scene::real_setting("mean_depth", "1", 1e-6, 1e3, "mean optical depth of the rays"),
      scene::integer_setting("angles", "96", 1, 100000, "directions of each of six eyes, five lengths each")};
}

std::vector<std::string> WaveletSeams::figures() const {
  return {"rms", "greatest", "seam_rms", "seam_greatest", "above_one"};
}

Findings WaveletSeams::run(const ProbeInput& input, const scene::Settings& s, const scene::Execution&) const {
  const MapRays rays = map_rays(input.file, input.overrides, int(s.integer("angles")), s.real("mean_depth"));
  const Reading reading{s.choice("depth", depths), s.real("mu")};
  const fog::Levels levels = fog::make_levels(rays.map, families[rays.map.degree()], s.choice("coarse", grids),
                                              int(s.integer("levels")), reading.depth == Depth::paper);
  Spread error, seam;
  double above_one = 0;
  fog::Visits visits;
  for (std::size_t i = 0; i < rays.lines.size(); ++i) {
    const Interval t{0, rays.lengths[i]};
    const double exact = scene::integral(rays.map, scene::SameAtAllHeights{}, rays.lines[i], t);
    const double depth = rays.sigma * reading(levels, rays.lines[i], t, t.hi, visits);
    above_one = std::max(above_one, std::expm1(-depth));
    error.add(std::exp(-std::max(0.0, depth)) - std::exp(-rays.sigma * exact));
  }
  fog::Visits aside;
  for (std::size_t i = 0; i < rays.lines.size(); i += 5) {  // each eye and direction once
    const auto seen = [&](double object) {
      return std::exp(-rays.sigma * reading(levels, rays.lines[i], {0, near_object}, object, aside));
    };
    seam.add(seen(far_object) - seen(near_object));
  }
  Findings found;
  found.figures = {exactly("rms", error.rms()), exactly("greatest", error.most), exactly("seam_rms", seam.rms()),
                   exactly("seam_greatest", seam.most), exactly("above_one", above_one)};
  found.counters = {{"rays", double(rays.lines.size())},
                    {"cells_per_ray", double(visits.cells) / double(rays.lines.size())},
                    {"coefficients_per_ray", double(visits.coefficients) / double(rays.lines.size())}};
  return found;
}

}  // namespace airlight::experiments
