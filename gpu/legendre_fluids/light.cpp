#include "gpu/legendre_fluids/light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "gpu/film_layers.h"
#include "gpu/frame.h"
#include "gpu/legendre_fluids/legendre_fluids.h"
#include "gpu/legendre_fluids/lit_media.h"
#include "gpu/legendre_fluids/paper_picture.h"
#include "gpu/raster/backdrops.h"
#include "gpu/view_uniforms.h"
#include "gpu/wavelet_fog/surface_light.h"
#include "methods/legendre_fluids/light.h"
#include "methods/legendre_fluids/light_options.h"
#include "scene/base/error.h"
#include "scene/light/background.h"
#include "scene/light/scattered_lights.h"
#include "scene/single_precision.h"

namespace airlight::gpu::legendre_fluids {
namespace {

using airlight::legendre_fluids::LitMedia;
using airlight::legendre_fluids::LitMedium;
using airlight::legendre_fluids::RayOptions;
using airlight::legendre_fluids::with_sky;
using scene::Execution;
using scene::Scene;
using scene::View;

constexpr int ray_tile = 4;               // of rays, both ways
constexpr double least_tolerance = 1e-6;  // that single precision can keep
constexpr double bent_share = 0.1;        // of it, that may be missed where light has kinks
constexpr int walked_words = 3;           // of light_rays.comp
constexpr int first_rounds = 16, most_rounds = 8192;
// Iterations of loops of shadow rays in a round, about: eight rays share llvmpipe's limit.
constexpr int software_budget = 3000, hardware_budget = 1 << 30;

// The range of the depth over a panel, up to which that many points miss no more than the tolerance: coefficients of exp(-r z) are at most
// 2 (r/2)^k / k!.
double widest_panel(const RayOptions& options) {
  const double order = 2 * options.points;
  return 4 * std::exp((std::log(0.5 * std::max(options.tolerance, least_tolerance)) + std::lgamma(order + 1)) / order);
}

class PreparedLightGpu final : public scene::Prepared, public TakesDensity {
 public:
  PreparedLightGpu(std::shared_ptr<const Scene>, const RayOptions&, scene::Settings given);

  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;
  scene::Rendering render_once(const View&, const Execution&) const;
  bool take(std::size_t medium, const DensityOnDevice& d) override {
    const Use use(context_);
    return media_ && media_->take(medium, d.state, d.field, d.coefficients, d.box);
  }

 private:
  std::vector<scene::StageTime> prepare(std::shared_ptr<const Scene>);
  void find_programs(bool shadow);
  void follow_round(const View&, int round, bool shadowed) const;
  bool negative() const { return media_ && media_->negative(); }
  bool shadowed() const { return shadows_ != nullptr; }
  bool any_medium() const { return !lit_.media.empty(); }
  bool scatters() const;
  bool ambient() const { return scene_->ambient_in_scatter.maxCoeff() > 0 && any_medium(); }
  void follow(const View&, const Buffer* distances, std::size_t pixels) const;
  void dim(const View&, const scene::Light&) const;
  void compose(std::size_t pixels, const Buffer& lit, const Buffer* seen) const;

  scene::Settings given_;
  RayOptions options_;
  Context& context_;
  std::shared_ptr<const Scene> scene_;
  LitMedia lit_;
  std::unique_ptr<LightMediaOnDevice> media_;  // null: no medium extinguishes
  std::unique_ptr<FirstHits> first_hits_;      // null: no surface ends a ray
  std::unique_ptr<Backdrops> backdrops_;       // null: there are none
  std::unique_ptr<wavelet_fog::SurfaceLight> surfaces_;
  Program *rays_ = nullptr, *dim_ = nullptr, *composition_ = nullptr, *cut_ = nullptr, *columns_ = nullptr,
          *shadows_ = nullptr;
  std::vector<bool> shadowed_;         // by light: may surfaces stand before it
  mutable int rounds_ = first_rounds;  // of stretches, where a density may be below 0 or surfaces may shade a ray
  double negative_share_ = 0;
  std::optional<Traffic> next_;  // of next(), if there was one
  mutable Frame frame_;
  std::vector<scene::StageTime> times_;
};

PreparedLightGpu::PreparedLightGpu(std::shared_ptr<const Scene> scene, const RayOptions& options, scene::Settings given)
    : given_(std::move(given)), options_(options), context_(Context::get()), frame_(context_) {
  times_ = prepare(std::move(scene));
}

// For a first frame, or one that keeps what the frame before has in common with it.
std::vector<scene::StageTime> PreparedLightGpu::prepare(std::shared_ptr<const Scene> given) {
  const Use use(context_);
  const Traffic traffic = context_.traffic();
  frame_.timer.restart();
  const std::shared_ptr<const Scene> before = std::exchange(scene_, with_sky(std::move(given), options_));
  if (!before || !scene::same_surfaces(*before, *scene_)) {
    surfaces_.reset();
    first_hits_.reset();
    if (wavelet_fog::something_ends_rays(*scene_)) first_hits_ = std::make_unique<FirstHits>(context_, *scene_);
  }
  backdrops_ = scene_->backdrops.empty() ? nullptr : std::make_unique<Backdrops>(context_, *scene_);
  const bool same_lamps = surfaces_ && surfaces_->become(*scene_);
  if (!same_lamps) surfaces_ = std::make_unique<wavelet_fog::SurfaceLight>(context_, *scene_, first_hits_.get());
  const LitMedia media_before = std::exchange(lit_, LitMedia(*scene_, &lit_));
  const bool same_media = media_ ? media_->become(media_before) : !any_medium();
  if (!same_media) media_ = any_medium() ? std::make_unique<LightMediaOnDevice>(context_, lit_, options_) : nullptr;
  negative_share_ = lit_.greatest_negative_share();
  shadowed_ = shadowed_lights(*scene_, lit_);
  const bool shadow = scatters() && std::find(shadowed_.begin(), shadowed_.end(), true) != shadowed_.end();
  if (!composition_ || !same_media || !same_lamps || shadow != shadowed()) find_programs(shadow);
  if ((context_.traffic() - traffic).bytes_up == 0) return {};
  frame_.timer.stage("upload");
  return frame_.timer.times();
}

void PreparedLightGpu::find_programs(bool shadow) {
  rays_ = dim_ = cut_ = columns_ = shadows_ = nullptr;
  Definitions definitions{{"MEDIA", "0"}};
  if (any_medium()) {
    definitions = media_->definitions();
    definitions["SHADOWED"] = std::to_string(int(shadow));
    if (shadow) shadows_ = &program(context_, "light_shadows", ray_tile, ray_tile, definitions);
    rays_ = &program(context_, "light_rays", ray_tile, ray_tile, definitions);
    if (wavelet_fog::lamps_light_surfaces(*scene_))
      dim_ = &program(context_, "light_dim", ray_tile, ray_tile, definitions);
    if (negative()) {
      cut_ = &program(context_, "light_cut", ray_tile, ray_tile, definitions);
      columns_ = &program(context_, "light_columns", 32, 1, definitions);
    }
  }
  composition_ = &program(context_, "light_composition", 64, 1, definitions);
}

std::optional<std::vector<scene::StageTime>> PreparedLightGpu::next(std::shared_ptr<const Scene> scene,
                                                                    const Execution&) {
  // A medium may be one that the paper's systems draw.
  if (given_.text("variant") != "ray" || !LegendreLight().supports(*scene, given_).empty()) return std::nullopt;
  const Traffic before = context_.traffic();
  std::vector<scene::StageTime> times = prepare(std::move(scene));
  next_ = context_.traffic() - before;
  return times;
}

bool PreparedLightGpu::scatters() const {
  const auto scattering = [](const LitMedium& m) { return (m.medium->albedo * m.medium->sigma_t).maxCoeff() > 0; };
  return !lit_.lights.empty() && std::any_of(lit_.media.begin(), lit_.media.end(), scattering);
}

std::vector<scene::Stage> PreparedLightGpu::stages() const {
  const std::string dark = scene::why_nothing_scatters(*scene_);
  const std::string why = !any_medium() ? "no medium extinguishes" : dark.empty() ? "no medium scatters" : dark;
  const bool ends = first_hits_ != nullptr, lit = surfaces_->shines();
  return {
      {"distances", ends, ends ? "where camera rays end" : "nothing ends a ray"},
      {"backdrops", bool(backdrops_), backdrops_ ? "where they end camera rays" : "there are none"},
      {"rays", any_medium(),
       negative() || shadowed() ? "a stretch of every ray in each round, until all are done"
       : scatters()             ? fmt::format("{} dispatches for each of {} lights, a stretch of every ray each",
                                              media_->stretches(), lit_.lights.size())
       : any_medium()           ? "columns alone"
                                : why},
      {"airlight", scatters(), scatters() ? "along the rays" : why},
      {"clamping", negative(),
       negative() ? fmt::format("a density is below 0 in {:.2g} of its box, and taken as 0", negative_share_)
                  : "no density is below 0"},
      {"shadows", shadowed(), shadowed() ? "surfaces may stand before a light" : "no surface stands before a light"},
      {"surfaces", lit, lit ? "lights through the media, background" : "no surface is lit, no background"},
      {"environment as a light", scene::has_environment(*scene_) && !lit_.lights.empty(),
       !scene::has_environment(*scene_) ? "no environment"
       : lit_.lights.empty()            ? "nothing scatters, no surface is lit: only the background is drawn"
                                        : fmt::format("{} directions", options_.environment_directions)},
      {"composition", true, "layers of the film"}};
}

// Every ray, under one light after the other, to its end: columns and airlight.
void PreparedLightGpu::follow(const View& view, const Buffer* distances, std::size_t pixels) const {
  Program& p = *rays_;
  const Buffer& columns = frame_.buffers.get("columns", 4 * pixels * lit_.media.size());
  const Buffer& reached = frame_.buffers.get("reached", 8 * pixels);
  (distances ? *distances : columns).bind(at::distances);
  reached.bind(at::reached);
  columns.bind(at::columns);
  frame_.buffers.get("airlight", 12 * pixels).bind(at::airlight_layer);
  set_view(p, view);
  p.set("has_distances", distances != nullptr);
  p.set("loop_count", 3);
  p.set("tolerance", std::max(options_.tolerance, least_tolerance));
  p.set("widest", widest_panel(options_));
  for (std::size_t m = 0; m < lit_.media.size(); ++m) {
    const scene::PhaseFunction& phase = lit_.media[m].medium->phase;
    const auto* hg = std::get_if<scene::HenyeyGreenstein>(&phase);
    p.set(fmt::format("phase_kind[{}]", m), int(phase.index()));
    p.set(fmt::format("phase_g[{}]", m), hg ? hg->g : 0.0);
  }
  const std::size_t lights = scatters() ? lit_.lights.size() : 0;
  if (negative() || shadowed()) {
    Buffer& walked = frame_.buffers.get("walked", 4 * std::size_t(walked_words));
    walked.clear();
    walked.bind(at::walked);
    frame_.download.add_status("walked", walked, walked.bytes());
  }
  if (shadowed()) {
    frame_.buffers.get("shades", 32 * pixels).bind(at::shades);
    first_hits_->surfaces().bind();
    first_hits_->tree().bind(*shadows_);
    set_view(*shadows_, view);
    shadows_->set("triangle_count", first_hits_->surfaces().triangles());
    shadows_->set("loop_count", 3);
    shadows_->set("has_distances", distances != nullptr);
    shadows_->set("shadow_steps", options_.shadow_steps);
    shadows_->set("budget", context_.software() ? software_budget : hardware_budget);
  }
  if (negative()) {
    frame_.buffers.get("stretches", 16 * pixels).bind(at::stretches);
    frame_.buffers.get("ways", 4 * pixels * lit_.media.size() * std::size_t(media_->series())).bind(at::ways);
    p.set("bent", bent_share * std::max(options_.tolerance, least_tolerance));
    set_view(*cut_, view);
    set_view(*columns_, view);
    columns_->set("loop_count", 3);
    cut_->set("has_distances", distances != nullptr);
  }
  for (std::size_t l = 0; l < std::max<std::size_t>(1, lights); ++l) {
    media_->bind(p, lights > 0 ? lit_.lights[l].to_light : Vec3(Vec3::Zero()));
    if (negative()) {
      for (Program* each : {cut_, columns_})
        media_->bind(*each, lights > 0 ? lit_.lights[l].to_light : Vec3(Vec3::Zero()));
      cut_->set("first_light", l == 0);
    }
    p.set("has_light", lights > 0);
    p.set("first_light", l == 0);
    p.set("irradiance", lights > 0 ? lit_.lights[l].irradiance : Rgb(Rgb::Zero()));
    const bool shadowed = this->shadowed() && shadowed_[l];
    if (shadowed) media_->bind(*shadows_, lit_.lights[l].to_light);
    const int rounds = negative() || shadowed ? rounds_ : media_->stretches();
    for (int round = 0; round < rounds; ++round) follow_round(view, round, shadowed);
  }
}

// The next stretch of each ray. Where surfaces may shade it, its next edge first; where a density may be below 0, its end and the light at
// its points first.
void PreparedLightGpu::follow_round(const View& view, int round, bool shadowed) const {
  if (shadowed) {
    shadows_->set("begins", round == 0);
    shadows_->dispatch(view.width, view.height);
  }
  if (negative()) {
    cut_->set("begins", round == 0);
    if (this->shadowed()) cut_->set("has_shadow", shadowed);
    cut_->dispatch(view.width, view.height);
    if (scatters()) columns_->dispatch(int(lit_.media.size()) * media_->series() * view.width, view.height);
  } else {
    rays_->set("begins", round == 0);
  }
  if (this->shadowed()) rays_->set("has_shadow", shadowed);
  if (negative() || this->shadowed()) rays_->set("round", round);
  rays_->dispatch(view.width, view.height);
}

void PreparedLightGpu::dim(const View& view, const scene::Light& light) const {
  const auto* sun = std::get_if<scene::DirectionalLight>(&light);
  if (!media_ || !sun) return;
  frame_.buffers.get("lit", sizeof(wavelet_fog::LitData) * std::size_t(view.width) * std::size_t(view.height))
      .bind(at::lit);
  set_view(*dim_, view);
  media_->bind(*dim_, sun->to_light);
  dim_->dispatch(view.width, view.height);
}

void PreparedLightGpu::compose(std::size_t pixels, const Buffer& lit, const Buffer* seen) const {
  Program& p = *composition_;
  bind_film_layers(frame_, pixels, p,
                   {at::mean_layer, at::transmittance_layer, at::surface_layer, at::airlight_layer, at::ambient_layer},
                   {true, ambient() ? std::optional(scene_->ambient_in_scatter) : std::nullopt});
  lit.bind(at::lit);
  (any_medium() ? frame_.buffers.get("columns", 4 * pixels * lit_.media.size()) : lit).bind(at::columns);
  (seen ? *seen : lit).bind(at::seen);
  p.set("has_seen", seen != nullptr);
  p.set("pixels", int(pixels));
  p.set("has_lit", surfaces_->shines());
  for (std::size_t m = 0; m < lit_.media.size(); ++m)
    p.set(fmt::format("sigma_t[{}]", m), lit_.media[m].medium->sigma_t);
  p.dispatch(int(pixels));
}

scene::Rendering PreparedLightGpu::render(const View& view, const Execution& execution) const {
  const Use use(context_);
  for (;;) {
    scene::Rendering result = render_once(view, execution);
    const auto walked = frame_.download.values<unsigned>("walked");
    if (walked.empty()) return result;
    const int needed = int(walked[0]) + 1;
    if (needed <= rounds_) {
      float missed = 0;
      std::memcpy(&missed, &walked[2], sizeof missed);
      result.counters["rounds"] = needed;
      result.counters["stretches_at_limit"] = walked[1];
      result.counters["missed_depth"] = missed;
      rounds_ = std::min(rounds_, needed + needed / 4);  // other views may take more
      return result;
    }
    if (rounds_ >= most_rounds) throw Error(fmt::format("rays are not done after {} stretches", rounds_));
    rounds_ = std::min(most_rounds, 2 * rounds_);  // and all rays anew
  }
}

scene::Rendering PreparedLightGpu::render_once(const View& view, const Execution& execution) const {
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
  frame_.begin(execution);
  const Buffer& lit = frame_.buffers.get("lit", sizeof(wavelet_fog::LitData) * (surfaces_->shines() ? pixels : 1));
  const Buffer *distances = nullptr, *primitives = nullptr;
  if (first_hits_) {
    frame_.timer.begin("distances");
    distances = &frame_.buffers.get("distances", 4 * pixels);
    primitives = &frame_.buffers.get("primitives", 4 * pixels);
    first_hits_->find(view, *distances, primitives);
  }
  const Buffer* seen = nullptr;
  if (backdrops_) {
    frame_.timer.begin("backdrops");
    if (!distances) distances = &frame_.buffers.get("distances", 4 * pixels);
    seen = &frame_.buffers.get("seen", 12 * pixels);
    backdrops_->find(view, *distances, bool(first_hits_), *seen);
  }
  if (any_medium()) {
    frame_.timer.begin("rays");
    follow(view, distances, pixels);
  } else {
    frame_.buffers.get("airlight", 12 * pixels).clear();
  }
  if (surfaces_->shines()) {
    frame_.timer.begin("surfaces");
    surfaces_->render(*scene_, view, primitives, lit, [&](const scene::Light& light) { dim(view, light); });
  }
  frame_.timer.begin("composition");
  compose(pixels, lit, seen);
  frame_.finish(result);
  if (next_) result.counters.merge(next_->counters("next_"));
  result.counters["rays"] = double(pixels);
  result.counters["negative_share"] = negative_share_;
  result.film.metadata = {{"method", "legendre_fluids_gpu"},
                          {"settings", given_.canonical()},
                          {"scene", scene_->name},
                          {"hash", scene_->hash}};
  if (scene::has_environment(*scene_) && !lit_.lights.empty())
    result.film.metadata["warning"] =
        fmt::format("legendre_fluids_gpu: {} directional lights stand for each environment (environment_directions)",
                    options_.environment_directions);
  return result;
}

}  // namespace

bool draw_flow(scene::Prepared& picture, const scene::Flow& flow, int density, std::size_t medium) {
  auto* prepared = dynamic_cast<TakesDensity*>(&picture);
  const std::optional<DensityOnDevice> there = density_on_device(flow, density);
  return prepared && there && prepared->take(medium, *there);
}

std::string LegendreLight::about() const {
  return "legendre_fluids in compute shaders: single scattering in Legendre boxes, exact optical depths (Gupta and Narasimhan 2007)";
}

std::vector<scene::SettingSpec> LegendreLight::settings() const {
  return airlight::legendre_fluids::LegendreLight().settings();
}

std::vector<std::string> LegendreLight::supports(const Scene& scene, const scene::Settings& settings) const {
  std::vector<std::string> reasons = airlight::legendre_fluids::LegendreLight().supports(scene, settings);
  for (const std::string& reason : beyond_single_precision(scene)) reasons.push_back(reason);
  const airlight::legendre_fluids::LightOptions options = airlight::legendre_fluids::read_light_options(settings);
  if (options.variant == airlight::legendre_fluids::LightOptions::Variant::paper)
    for (const std::string& reason : unsupported_paper(scene, options.paper)) reasons.push_back(reason);
  if (!reasons.empty() || options.variant == airlight::legendre_fluids::LightOptions::Variant::paper) return reasons;
  const auto lit = with_sky({std::shared_ptr<const Scene>(), &scene}, options.ray);
  for (const std::string& reason : unsupported(LitMedia(*lit))) reasons.push_back(reason);
  return reasons;
}

std::unique_ptr<scene::Prepared> LegendreLight::prepare_supported(std::shared_ptr<const Scene> scene,
                                                                  const scene::Settings& settings,
                                                                  const Execution&) const {
  const airlight::legendre_fluids::LightOptions options = airlight::legendre_fluids::read_light_options(settings);
  if (options.variant == airlight::legendre_fluids::LightOptions::Variant::paper)
    if (auto prepared = prepare_paper(scene, options.paper, settings)) return prepared;
  return std::make_unique<PreparedLightGpu>(std::move(scene), options.ray, settings);
}

}  // namespace airlight::gpu::legendre_fluids
