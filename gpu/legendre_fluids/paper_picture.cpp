#include "gpu/legendre_fluids/paper_picture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "gpu/frame.h"
#include "gpu/legendre_fluids/light.h"
#include "gpu/legendre_fluids/paper_light.h"
#include "gpu/raster/backdrops.h"
#include "gpu/view_uniforms.h"
#include "gpu/wavelet_fog/surface_light.h"
#include "methods/legendre_fluids/lit_media.h"
#include "methods/legendre_fluids/paper_picture.h"
#include "scene/base/error.h"
#include "scene/light/background.h"
#include "scene/light/scattered_lights.h"

namespace airlight::gpu::legendre_fluids {
namespace {

using scene::Execution;
using scene::Scene;
using scene::View;

constexpr int tile = 8;            // of pixels, both ways
constexpr int most_loops = 50000;  // of a ray's column: llvmpipe ends all loops after 65535 iterations

int column_points(const scene::TensorShape& density) { return (density[0] + density[1] + density[2] - 3) / 2 + 1; }

// Definitions of paper_image.comp for columns.
void define_columns(const scene::TensorShape& density, bool ends, Definitions& definitions) {
  definitions["ENDS"] = ends ? "1" : "0";
  const scene::LegendrePoints& rule = scene::legendre_points(column_points(density));
  std::vector<std::string> nodes, weights;
  for (Eigen::Index i = 0; i < rule.node.size(); ++i) {
    nodes.push_back(fmt::format("{:.9f}", 0.5 + 0.5 * rule.node[i]));
    weights.push_back(fmt::format("{:.9f}", 0.5 * rule.weight[i]));
  }
  definitions["COLUMN_POINTS"] = std::to_string(nodes.size());
  definitions["NODES"] = fmt::format("float[]({})", fmt::join(nodes, ", "));
  definitions["WEIGHTS"] = fmt::format("float[]({})", fmt::join(weights, ", "));
}

// Can anything be seen behind the medium, or in it.
bool ends_rays(const Scene& scene) {
  return scene.geometry != nullptr || !scene.backdrops.empty() || scene::has_environment(scene);
}

class PreparedPaperGpu final : public scene::Prepared, public TakesDensity {
 public:
  PreparedPaperGpu(std::shared_ptr<const Scene>, const airlight::legendre_fluids::PaperOptions&, scene::Settings given);
  std::vector<scene::Stage> stages() const override;
  std::vector<scene::StageTime> prepare_times() const override { return times_; }
  scene::Rendering render(const View&, const Execution&) const override;
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const Scene>, const Execution&) override;
  bool take(std::size_t medium, const DensityOnDevice&) override;

 private:
  std::vector<scene::StageTime> prepare(std::shared_ptr<const Scene>);
  void find_surfaces(const Scene* before);
  void find_programs();
  // Where rays end, and what they see there.
  struct Ends {
    const Buffer *distances = nullptr, *seen = nullptr, *lit = nullptr;
  };
  Ends find_ends(const View&) const;
  void dim(const View&, const scene::Light&) const;
  void draw(const View&, const Ends&) const;
  std::map<std::string, double> counters() const;

  std::shared_ptr<const Scene> scene_;
  airlight::legendre_fluids::PaperOptions options_;
  scene::Settings given_;
  Context& context_;
  airlight::legendre_fluids::PaperMedium media_;
  scene::LegendrePointer field_;  // of those; null where nothing extinguishes
  std::vector<scene::DirectionalLight> lights_;
  std::array<bool, 3> moving_{};
  std::unique_ptr<PaperSystems> systems_;                // null: no light scatters
  std::unique_ptr<FirstHits> first_hits_;                // null: no surface ends a ray
  std::unique_ptr<Backdrops> backdrops_;                 // null: there are none
  std::unique_ptr<wavelet_fog::SurfaceLight> surfaces_;  // null: nothing can be seen behind the medium
  Program *image_ = nullptr, *dim_ = nullptr;
  double negative_direct_ = 0, negative_density_ = 0;
  int direct_made_ = 0;          // lights whose E_d is solved for this frame
  bool flows_ = false;           // the density is a flow's
  bool unseen_ = false;          // the host has not seen E_d
  mutable bool stale_ = false;   // E_d is of another density, or of another light
  std::optional<Traffic> next_;  // of next(), if there was one
  mutable Frame frame_;
  std::vector<scene::StageTime> times_;
};

PreparedPaperGpu::PreparedPaperGpu(std::shared_ptr<const Scene> scene,
                                   const airlight::legendre_fluids::PaperOptions& options, scene::Settings given)
    : options_(options), given_(std::move(given)), context_(Context::get()), frame_(context_) {
  times_ = prepare(std::move(scene));
}

// For a first frame, or one that keeps what the frame before has in common with it.
std::vector<scene::StageTime> PreparedPaperGpu::prepare(std::shared_ptr<const Scene> scene) {
  const Use use(context_);
  const Traffic traffic = context_.traffic();
  frame_.timer.restart();
  const std::shared_ptr<const Scene> before = std::exchange(scene_, std::move(scene));
  const std::vector<scene::DirectionalLight> lights_before = std::exchange(lights_, {});
  const Rgb sigma_before = media_.medium ? media_.medium->sigma_t : Rgb(Rgb::Zero());
  moving_ = airlight::legendre_fluids::moving_axes(*scene_);
  for (const scene::Light& light : scene_->lights)
    if (const auto* sun = std::get_if<scene::DirectionalLight>(&light);
        sun && (scatter(scene_->media, light) || (ends_rays(*scene_) && scene::shines(light))))
      lights_.push_back(*sun);
  const auto kept = before ? airlight::legendre_fluids::kept_medium(media_, *before, *scene_) : std::nullopt;
  media_ = kept ? *kept : airlight::legendre_fluids::paper_medium(*scene_);
  field_ = media_.density;
  // Where no light shines, one without colour: columns are part of the systems' picture.
  if (lights_.empty() && ends_rays(*scene_)) lights_.push_back({-scene_->camera.forward, Rgb::Zero()});
  if (!field_ || lights_.empty()) {
    systems_.reset();
    surfaces_.reset();
    return {};
  }
  if (!kept)
    negative_density_ =
        field_->negative() ? airlight::legendre_fluids::negative_share(field_->shape(), field_->coefficients()) : 0;
  const bool had_surfaces = bool(surfaces_);
  find_surfaces(before.get());
  const bool same_density = kept && !std::exchange(flows_, false);
  const bool goes_on = systems_ && systems_->become(same_density, moving_);
  if (!goes_on) systems_ = std::make_unique<PaperSystems>(context_, media_, lights_, options_, moving_);
  const bool dims = surfaces_ && wavelet_fog::lamps_light_surfaces(*scene_);
  if (!goes_on || had_surfaces != bool(surfaces_) || dims != bool(dim_)) find_programs();
  if (!goes_on) {
    frame_.timer.stage("upload");
    systems_->begin();
    negative_direct_ = 0;
    for (const Eigen::VectorXd& e : systems_->direct())
      negative_direct_ = std::max(negative_direct_, airlight::legendre_fluids::negative_share(systems_->shape(), e));
    stale_ = unseen_ = false;
    frame_.timer.stage("direct systems");
  } else {
    const auto same_way = [](const scene::DirectionalLight& a, const scene::DirectionalLight& b) {
      return a.to_light == b.to_light;
    };
    stale_ = stale_ || !same_density || (media_.medium->sigma_t != sigma_before).any() ||
             !std::equal(lights_.begin(), lights_.end(), lights_before.begin(), lights_before.end(), same_way);
    unseen_ = unseen_ || stale_;
    if ((context_.traffic() - traffic).bytes_up > 0) frame_.timer.stage("upload");
  }
  direct_made_ = !goes_on || stale_ ? int(lights_.size()) : 0;
  return (context_.traffic() - traffic).bytes_up > 0 ? frame_.timer.times() : std::vector<scene::StageTime>();
}

void PreparedPaperGpu::find_surfaces(const Scene* before) {
  if (!surfaces_ || !scene::same_surfaces(*before, *scene_)) {
    surfaces_.reset();
    first_hits_.reset();
  }
  backdrops_.reset();
  if (!ends_rays(*scene_)) return surfaces_.reset();
  if (!surfaces_ && wavelet_fog::something_ends_rays(*scene_))
    first_hits_ = std::make_unique<FirstHits>(context_, *scene_);
  if (!scene_->backdrops.empty()) backdrops_ = std::make_unique<Backdrops>(context_, *scene_);
  if (!surfaces_ || !surfaces_->become(*scene_))
    surfaces_ = std::make_unique<wavelet_fog::SurfaceLight>(context_, *scene_, first_hits_.get());
}

void PreparedPaperGpu::find_programs() {
  Definitions definitions = systems_->definitions();
  dim_ = surfaces_ && wavelet_fog::lamps_light_surfaces(*scene_)
             ? &program(context_, "paper_dim", tile, tile, definitions)
             : nullptr;
  define_columns(field_->shape(), bool(surfaces_), definitions);
  image_ = &program(context_, "paper_image", tile, tile, definitions);
}

std::optional<std::vector<scene::StageTime>> PreparedPaperGpu::next(std::shared_ptr<const Scene> scene,
                                                                    const Execution&) {
  // Variant `ray` draws what a scene without media shows.
  if (!LegendreLight().supports(*scene, given_).empty() ||
      (ends_rays(*scene) && !airlight::legendre_fluids::paper_medium(*scene).density))
    return std::nullopt;
  const Traffic before = context_.traffic();
  std::vector<scene::StageTime> times = prepare(std::move(scene));
  next_ = context_.traffic() - before;
  return times;
}

std::vector<scene::Stage> PreparedPaperGpu::stages() const {
  const bool kept = bool(systems_);
  const std::string why = field_ ? scene::why_nothing_scatters(*scene_) : "no medium extinguishes";
  const std::string how =
      !kept ? ""
            : fmt::format("{} of {} unknowns",
                          options_.solver.closure == airlight::legendre_fluids::Closure::upwind ? "GMRES"
                                                                                                : "conjugate gradients",
                          scene::tensor_size(systems_->shape()));
  return {{"direct systems", kept, kept ? how : why},
          {"scattered systems", kept, kept ? how : why},
          {"albedo", bool(media_.scattering[0]),
           media_.scattering[0] ? "a field: of several densities in one box" : "the same everywhere"},
          {"image", kept, kept ? "coefficients of the faces towards the camera" : why},
          {"clamping", kept, kept ? "negative radiance is taken as 0" : why},
          {"backdrops", bool(backdrops_), backdrops_ ? "where they end camera rays" : "there are none"},
          {"surfaces", surfaces_ && surfaces_->shines(),
           surfaces_ && surfaces_->shines() ? "lights through the medium, background"
                                            : "no surface is lit, no background"}};
}

bool PreparedPaperGpu::take(std::size_t medium, const DensityOnDevice& density) {
  const Use use(context_);
  const bool several = std::count_if(scene_->media.begin(), scene_->media.end(), scene::extinguishes) > 1;
  if (medium > 0 || several || !systems_ || !systems_->take(density)) return false;
  flows_ = stale_ = unseen_ = true;
  direct_made_ = int(lights_.size());
  return true;
}

PreparedPaperGpu::Ends PreparedPaperGpu::find_ends(const View& view) const {
  Ends ends;
  if (!surfaces_) return ends;
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  const Buffer* primitives = nullptr;
  if (first_hits_ || backdrops_) ends.distances = &frame_.buffers.get("ends", 4 * pixels);
  if (first_hits_) {
    primitives = &frame_.buffers.get("primitives", 4 * pixels);
    first_hits_->find(view, *ends.distances, primitives);
  }
  if (backdrops_) {
    ends.seen = &frame_.buffers.get("seen", 12 * pixels);
    backdrops_->find(view, *ends.distances, bool(first_hits_), *ends.seen);
  }
  if (!surfaces_->shines()) return ends;
  ends.lit = &frame_.buffers.get("lit", sizeof(wavelet_fog::LitData) * pixels);
  surfaces_->render(*scene_, view, primitives, *ends.lit, [&](const scene::Light& light) { dim(view, light); });
  return ends;
}

void PreparedPaperGpu::dim(const View& view, const scene::Light& light) const {
  const auto* sun = std::get_if<scene::DirectionalLight>(&light);
  const auto alike = [&](const scene::DirectionalLight& l) {
    return l.to_light == sun->to_light && (l.irradiance == sun->irradiance).all();
  };
  const auto found = sun ? std::find_if(lights_.begin(), lights_.end(), alike) : lights_.end();
  if (found == lights_.end()) return;  // it does not shine
  const std::array<int, 3> first = systems_->first_of_direct(std::size_t(found - lights_.begin()));
  Program& p = *dim_;
  frame_.buffers.get("lit", sizeof(wavelet_fog::LitData) * std::size_t(view.width) * std::size_t(view.height))
      .bind(at::lit);
  systems_->direct_values().bind(at::direct);
  set_view(p, view);
  p.set_double("to_light", sun->to_light);
  p.set_double("box_low", field_->box().lo);
  p.set_double("box_high", field_->box().hi);
  for (std::size_t c = 0; c < 3; ++c) p.set(at_index("first", c), first[c]);
  p.dispatch(view.width, view.height);
}

void PreparedPaperGpu::draw(const View& view, const Ends& ends) const {
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  Program& p = *image_;
  std::vector<std::pair<const char*, int>> all{{"mean", at::mean_layer}, {"airlight", at::airlight_layer}};
  if (surfaces_) {
    const Buffer& unused = systems_->faces();
    (ends.distances ? *ends.distances : unused).bind(at::ray_ends);
    (ends.seen ? *ends.seen : unused).bind(at::seen);
    (ends.lit ? *ends.lit : unused).bind(at::lit);
    p.set("has_ends", ends.distances != nullptr);
    p.set("has_seen", ends.seen != nullptr);
    p.set("has_lit", ends.lit != nullptr);
    all.insert(all.end(), {{"surface", at::surface_layer}, {"transmittance", at::transmittance_layer}});
    p.set("sigma_t", media_.medium->sigma_t);
  }
  for (const auto& [name, binding] : all) {
    const Buffer& buffer = frame_.buffers.get(name, 12 * pixels);
    buffer.bind(binding);
    frame_.download.add(name, buffer, 12 * pixels);
  }
  Buffer& counts = frame_.buffers.get("counts", 8);
  counts.clear();
  counts.bind(at::status);
  frame_.download.add_values("counts", counts, 8);
  systems_->faces().bind(at::faces);
  set_view(p, view);
  p.set_double("box_low", field_->box().lo);
  p.set_double("box_high", field_->box().hi);
  p.set("scale", systems_->scale());
  for (std::size_t c = 0; c < 3; ++c) p.set(fmt::format("system_of[{}]", c), systems_->system_of()[c]);
  p.dispatch(view.width, view.height);
}

std::map<std::string, double> PreparedPaperGpu::counters() const {
  std::map<std::string, double> all{{"unknowns", double(scene::tensor_size(systems_->shape()))},
                                    {"iterations", double(systems_->iterations())},
                                    {"direct_systems_made", double(direct_made_)}};
  const auto counts = frame_.download.values<unsigned>("counts");
  if (counts.empty()) return all;
  all["negative_share"] = counts[0] > 0 ? double(counts[1]) / counts[0] : 0;
  if (!unseen_) all["negative_direct_share"] = negative_direct_;
  if (!flows_) all["negative_density_share"] = negative_density_;
  return all;
}

scene::Rendering PreparedPaperGpu::render(const View& view, const Execution& execution) const {
  airlight::legendre_fluids::require_view(view, moving_);
  const Use use(context_);
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  for (;;) {
    scene::Rendering result{scene::Film(view.width, view.height), {}, {}};
    frame_.begin(execution);
    if (systems_) {
      if (stale_) {
        frame_.timer.begin("direct systems");
        systems_->solve_direct(frame_);
      }
      frame_.timer.begin("scattered systems");
      systems_->solve_scattered(frame_, -view.camera.forward);
      if (surfaces_) frame_.timer.begin("surfaces");
      const Ends ends = find_ends(view);
      frame_.timer.begin("image");
      draw(view, ends);
    } else {
      for (const char* layer : {"mean", "airlight"}) {
        frame_.buffers.get(layer, 12 * pixels).clear();
        frame_.download.add(layer, frame_.buffers.get(layer, 12 * pixels), 12 * pixels);
      }
    }
    frame_.finish(result);
    // Systems that were not solved to the end are solved anew, with more steps.
    if (systems_ && !systems_->keep_up(frame_)) continue;
    stale_ = false;
    result.counters["rays"] = double(pixels);
    if (systems_) result.counters.merge(counters());
    if (next_) result.counters.merge(next_->counters("next_"));
    result.film.metadata = {{"method", "legendre_fluids_gpu"},
                            {"settings", given_.canonical()},
                            {"scene", scene_->name},
                            {"hash", scene_->hash}};
    return result;
  }
}

}  // namespace

namespace {

void object_to_columns(const Scene& scene, std::vector<std::string>& reasons) {
  for (const scene::Medium& medium : scene.media)
    if (const auto* field = std::get_if<scene::LegendrePointer>(&medium.field);
        field && extinguishes(medium) &&
        column_points((*field)->shape()) * scene::tensor_size((*field)->shape()) > most_loops)
      reasons.push_back(
          fmt::format("variant = paper with surfaces, backdrops or particles in a density of {} coefficients: shaders "
                      "add up columns of fewer, about {}, for llvmpipe's limit on loops",
                      scene::tensor_size((*field)->shape()), 2500));
}

}  // namespace

std::vector<std::string> unsupported_paper(const Scene& scene, const airlight::legendre_fluids::PaperOptions& options) {
  std::vector<std::string> reasons;
  if (ends_rays(scene)) object_to_columns(scene, reasons);
  if (options.n > most_intensities)
    reasons.push_back(fmt::format("variant = paper with n = {}: shaders take up to {} coefficients along an axis",
                                  options.n, most_intensities));
  const airlight::legendre_fluids::LightSolver& solver = options.solver;
  if (solver.closure == airlight::legendre_fluids::Closure::least_squares && solver.weight > most_weight)
    reasons.push_back(fmt::format("boundary_weight = {:g}: shaders' normal equations keep their digits up to {:g}",
                                  solver.weight, most_weight));
  return reasons;
}

std::unique_ptr<scene::Prepared> prepare_paper(std::shared_ptr<const Scene> scene,
                                               const airlight::legendre_fluids::PaperOptions& options,
                                               const scene::Settings& given) {
  if (ends_rays(*scene) && !airlight::legendre_fluids::paper_medium(*scene).density) return nullptr;
  return std::make_unique<PreparedPaperGpu>(std::move(scene), options, given);
}

}  // namespace airlight::gpu::legendre_fluids
