#include "reference/lit_media/lit_media.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/ray_marcher/light_maps.h"
#include "scene/base/stopwatch.h"
#include "scene/light/sky_directions.h"
#include "scene/media/same_medium.h"

namespace airlight::lit_media {
namespace {

constexpr double nearest_light = 0.01;       // [m]
constexpr double nearest_share = 0.01;       // of a medium's diagonal, or of the mean free path of one without an end
constexpr double most_evaluations = 1e12;    // of densities, in the maps
constexpr std::size_t room_of_kernels = 64;  // entries after the last

std::size_t padded(std::size_t n) { return (n + room_of_kernels - 1) / room_of_kernels * room_of_kernels; }

double count_lights(const scene::Scene& scene, const Options& options) {
  double lights = 0;
  for (const scene::Light& light : scene.lights) lights += is_delta(light) ? 1 : options.environment_directions;
  return lights;
}

// The part [begin, end) of ascending distances that lies within an interval.
std::pair<std::size_t, std::size_t> within(const std::vector<double>& t, Interval inside) {
  if (inside.empty()) return {0, 0};
  const auto first = std::lower_bound(t.begin(), t.end(), inside.lo),
             last = std::upper_bound(first, t.end(), inside.hi);
  return {std::size_t(first - t.begin()), std::size_t(last - t.begin())};
}

// The distance that light comes from at least [m]: nearest_light, or less in scenes of millimetres.
double least_distance(const std::vector<ray_marcher::Layer>& layers) {
  double least = nearest_light;
  for (const ray_marcher::Layer& layer : layers) {
    const double diagonal = bounding_box(*layer.medium).size().stableNorm();
    const double free_path = 1 / (layer.constant * layer.medium->sigma_t.maxCoeff());
    least = std::min(least, nearest_share * (diagonal < infinity ? diagonal : free_path));
  }
  return least;
}

scene::Incident kept_off(const scene::Light& light, scene::Incident from, double least) {
  if (from.distance >= least) return from;
  from.irradiance = intensity_towards(light, -from.to_light) / (least * least);
  return from;
}

}  // namespace

void bind(scene::SettingBinder& b, Options& o) {
  b.choice("self_shadow", o.self_shadow, {{"map", true}, {"none", false}},
           "what media take of light on its way to a point: looked up in a map of each light, or nothing");
  b.integer("environment_directions", o.environment_directions, 1, 1 << 12,
            "directions that stand for each environment light, drawn as its radiance");
  light_map::bind(b, o.map, "self_shadow");
}

std::vector<std::string> unsupported(const scene::Scene& scene, const Options& options) {
  if (!options.self_shadow) return {};
  std::vector<std::string> reasons;
  if (const std::string reason = light_map::unsupported(options.map); !reason.empty()) reasons.push_back(reason);
  const double lights = count_lights(scene, options);
  const double work = lights * options.map.size * options.map.size * options.map.steps * double(scene.media.size());
  if (work > most_evaluations)
    reasons.push_back(fmt::format(
        "maps of {:.3g} lights with {}^2 texels of {} steps in {} media are {:.2g} evaluations, expected at most {:.0e}",
        lights, options.map.size, options.map.steps, scene.media.size(), work, most_evaluations));
  return reasons;
}

void Counters::operator+=(const Counters& other) {
  points += other.points;
  look_ups += other.look_ups;
  occlusion_rays += other.occlusion_rays;
}

Plan make_plan(std::shared_ptr<const scene::Scene> scene, const Options& options, const Plan* before) {
  Plan plan{std::move(scene), options, {}, {}, false, 0};
  plan.layers =
      ray_marcher::make_layers(plan.scene->media, before ? before->layers : std::vector<ray_marcher::Layer>{});
  // Media that dim no light swallow none.
  const bool swallowed = options.self_shadow && scene::swallows_distant_light(plan.scene->media);
  plan.lights = scene::lights_from_directions(plan.scene->lights, options.environment_directions, swallowed);
  for (const ray_marcher::Layer& layer : plan.layers)
    if (!plan.lights.empty() && (layer.medium->albedo * layer.medium->sigma_t > 0).any()) plan.scatters = true;
  plan.nearest = least_distance(plan.layers);
  return plan;
}

bool fits(const Plan& plan, const scene::Scene& scene) {
  return !scene.hash.empty() && scene.matter_hash == plan.scene->matter_hash &&
         scene.light_hash == plan.scene->light_hash;
}

bool needs_maps(const Plan& plan) {
  return plan.options.self_shadow && !plan.layers.empty() && !plan.lights.empty() &&
         (plan.scatters || plan.scene->geometry);
}

double map_bytes(const Plan& plan) {
  const light_map::Options& options = plan.options.map;
  return needs_maps(plan)
             ? double(plan.lights.size()) * bytes_of_map(light_map::varied_media(plan.scene->media, options), options)
             : 0;
}

LitMedia::LitMedia(Plan plan)
    : plan_(std::move(plan)),
      by_kernels_(!ray_marcher::too_fine_for_kernels(*plan_.scene)),
      densities_(by_kernels_ ? ray_marcher::densities_by_kernels(plan_.layers, plan_.scene->media)
                             : light_map::densities_of(plan_.scene->media)) {}

LitMedia::LitMedia(std::shared_ptr<const scene::Scene> scene, const Options& options, const scene::Execution& execution,
                   const LitMedia* before)
    : LitMedia(make_plan(std::move(scene), options, before ? &before->plan_ : nullptr)) {
  if (!needs_maps(plan_)) return;
  scene::Stopwatch watch;
  const bool keeps = before && !before->maps_.empty() && before->by_kernels_ == by_kernels_ &&
                     scene::same_media(before->plan_.scene->media, plan_.scene->media);
  light_map::Maps maps =
      keeps ? make_maps(plan_.lights, plan_.scene->media, options.map, densities_, execution, "lit media",
                        before->plan_.lights, before->maps_)
            : make_maps(plan_.lights, plan_.scene->media, options.map, densities_, execution, "lit media");
  maps_ = std::move(maps.of_lights);
  maps_made_ = maps.made;
  if (maps_made_ > 0) map_seconds_ = watch.lap();
}

void LitMedia::add_densities(const Ray& ray, const std::vector<double>& t, Samples& s, Counters& counters) const {
  // Without an end: a single point would have no interval.
  const Interval range{t.front(), infinity};
  s.density.resize(plan_.layers.size());
  for (std::size_t k = 0; k < plan_.layers.size(); ++k) {
    const ray_marcher::Layer& layer = plan_.layers[k];
    std::vector<double>& density = s.density[k];
    density.assign(t.size(), 0.0);
    const auto [begin, end] = within(t, varied_extent(layer, ray, range));
    if (begin < end) {
      s.varied.resize(padded(end - begin));
      densities_(std::size_t(layer.medium - plan_.scene->media.data()), end - begin, s.x.data() + begin,
                 s.y.data() + begin, s.z.data() + begin, s.varied.data());
      std::copy_n(s.varied.begin(), end - begin, density.begin() + std::ptrdiff_t(begin));
      counters.points += std::int64_t(end - begin);
    }
    const auto [first, last] = within(t, constant_extent(layer, ray, range));
    for (std::size_t i = first; i < last; ++i) density[i] += layer.constant;
  }
}

void LitMedia::add_light(std::size_t l, const Ray& ray, std::size_t begin, std::size_t end, Samples& s,
                         Counters& counters) const {
  const scene::Light& light = plan_.lights[l];
  const light_map::LightMap* map = maps_.empty() ? nullptr : maps_[l].get();
  if (map) {
    for (auto& depth : s.depth) depth.resize(padded(end - begin));
    float* const depths[] = {s.depth[0].data(), s.depth[1].data(), s.depth[2].data()};
    map->varied_depths(end - begin, s.x.data() + begin, s.y.data() + begin, s.z.data() + begin, depths);
  }
  const bool everywhere_equal = !scene::ball(light);  // a sun: as at the first point
  scene::Incident from{Vec3::Zero(), 0, Rgb::Zero()};
  s.per_density.resize(plan_.layers.size());
  for (std::size_t i = begin; i < end; ++i) {
    const Point3 x(s.x[i], s.y[i], s.z[i]);
    if (i == begin || !everywhere_equal) {
      from = kept_off(light, incident(light, x), plan_.nearest);
      const double cosine = std::clamp(from.to_light.dot(ray.direction), -1.0, 1.0);
      for (std::size_t k = 0; k < plan_.layers.size(); ++k) {
        const scene::Medium& medium = *plan_.layers[k].medium;
        s.per_density[k] = medium.albedo * medium.sigma_t * from.irradiance * phase_value(medium.phase, cosine);
      }
    }
    Rgb scattered = Rgb::Zero();
    for (std::size_t k = 0; k < plan_.layers.size(); ++k)
      if (s.density[k][i] != 0) scattered += s.per_density[k] * s.density[k][i];
    if ((scattered == 0).all()) continue;
    if (plan_.scene->geometry) {
      ++counters.occlusion_rays;
      if (plan_.scene->geometry->occluded({x, from.to_light}, from.distance)) continue;
    }
    if (map) {
      ++counters.look_ups;
      Rgb depth = map->constant_depth(x);
      for (int c = 0; c < 3; ++c) depth[c] += double(s.depth[map->channels() == 1 ? 0 : c][i - begin]);
      if (depth[0] == depth[1] && depth[1] == depth[2])
        scattered *= std::exp(-depth[0]);
      else
        scattered *= (-depth).exp();
    }
    s.source[i] += scattered;
  }
}

void LitMedia::add_extinction(const Ray& ray, const std::vector<double>& t, Samples& s, Counters& counters) const {
  s.extinction.assign(t.size(), Rgb::Zero());
  if (t.empty() || plan_.layers.empty()) return;
  for (auto* places : {&s.x, &s.y, &s.z}) places->resize(t.size() + room_of_kernels);
  for (std::size_t i = 0; i < t.size(); ++i) {
    const Point3 x = ray.at(t[i]);
    s.x[i] = x[0], s.y[i] = x[1], s.z[i] = x[2];
  }
  add_densities(ray, t, s, counters);
  for (std::size_t i = 0; i < t.size(); ++i)
    for (std::size_t k = 0; k < plan_.layers.size(); ++k)
      s.extinction[i] += plan_.layers[k].medium->sigma_t * s.density[k][i];
}

void LitMedia::extinction_along(const Ray& ray, const std::vector<double>& t, Samples& samples) const {
  Counters unread;
  add_extinction(ray, t, samples, unread);
}

void LitMedia::along(const Ray& ray, const std::vector<double>& t, Samples& s, Counters& counters) const {
  add_extinction(ray, t, s, counters);
  s.source.assign(t.size(), Rgb::Zero());
  if (!plan_.scatters) return;
  std::size_t begin = t.size(), end = 0;  // of points where there is something
  for (std::size_t i = 0; i < t.size(); ++i) {
    if ((s.extinction[i] == 0).all()) continue;
    begin = std::min(begin, i);
    end = i + 1;
  }
  if (begin >= end) return;
  for (std::size_t l = 0; l < plan_.lights.size(); ++l) add_light(l, ray, begin, end, s, counters);
}

Rgb LitMedia::transmittance_to_light(std::size_t l, const Point3& x) const {
  return maps_.empty() ? Rgb::Ones() : Rgb((-maps_[l]->optical_depth(x)).exp());
}

Interval LitMedia::extent(const Ray& ray, Interval t) const {
  Interval all{infinity, -infinity};
  for (const ray_marcher::Layer& layer : plan_.layers)
    for (const Interval part : {constant_extent(layer, ray, t), varied_extent(layer, ray, t)})
      if (!part.empty()) all = {std::min(all.lo, part.lo), std::max(all.hi, part.hi)};
  return all;
}

std::size_t LitMedia::map_bytes() const {
  std::size_t bytes = 0;
  for (const auto& map : maps_) bytes += map->bytes();
  return bytes;
}

}  // namespace airlight::lit_media
