// variant = grid: source radiance at the nodes of a grid, surfaces lit from directions.
#include <fmt/format.h>

#include "gpu/compensated_ray_marching/lit_grid.h"
#include "gpu/compensated_ray_marching/picture.h"
#include "gpu/view_uniforms.h"
#include "scene/base/stopwatch.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

using airlight::compensated_ray_marching::IncomingLight;
using airlight::compensated_ray_marching::LitGrid;
using scene::Execution;
using scene::Scene;
using scene::View;

class GridPicture final : public Picture {
 public:
  GridPicture(std::shared_ptr<const Scene> scene, const Options& options, std::string settings, Solution last,
              const Execution& execution)
      : Picture(std::move(scene), options, std::move(settings), std::move(last)) {
    const Use use(context_);
    auto projected = bands(options_.grid.levels);
    scene::Stopwatch watch;
    incoming_.emplace(scene_->lights, std::move(projected));
    times_.push_back({"environment", watch.lap()});
    if (scatters_) {
      grid_.emplace(*scene_, smoke_->medium(), options_, *incoming_, execution);
      append(times_, grid_->times());
    }
    StageTimer timer(context_);
    timer.begin("upload");
    begin_march();
    begin_light(timer, execution);
    append(times_, timer.times());
  }

 private:
  void begin_light(StageTimer&, const Execution&);
  void dim(const View&, const scene::Light&) const;

  std::vector<scene::StageTime> light(const Execution&) override;
  bool fits(const Scene& scene) const override { return incoming_->fits(scene.lights); }
  Solution solution() const override { return source_ ? source_->solution() : Solution{}; }
  void find_source(const View&) const override;
  void bind_source(Program&) const override;
  void light_surfaces(const View&) const override;
  std::string single() const override {
    return fmt::format("{} nodes, {} directions", grid_->nodes().size(), incoming_->directions().size());
  }
  std::pair<bool, std::string> multiple() const override;
  std::string surfaces_lit() const override {
    return fmt::format("lit from {} directions, through the smoke", surroundings_->lamps());
  }
  void count(std::map<std::string, double>&) const override;

  std::optional<IncomingLight> incoming_;
  std::optional<LitGrid> grid_;
  std::unique_ptr<SmokeColumns> columns_;
  std::unique_ptr<LitGridOnDevice> source_;
  Program* dim_ = nullptr;
};

void GridPicture::begin_light(StageTimer& timer, const Execution& execution) {
  if (surroundings_->surfaces()) surroundings_->set_lamps(*scene_, *incoming_);
  if (!smoke_) return;
  if (surroundings_->surfaces())
    dim_ = &program(context_, "smoke_dim", pixel_tile, pixel_tile, density_->definitions());
  if (!scatters_) return;
  columns_ = std::make_unique<SmokeColumns>(context_, *first_, *grid_, *density_, middle_);
  source_ = std::make_unique<LitGridOnDevice>(context_, smoke_->medium(), options_, *grid_, *columns_);
  source_->begin_with(last_);
  source_->light(*incoming_, timer, execution);
}

std::vector<scene::StageTime> GridPicture::light(const Execution& execution) {
  scene::Stopwatch watch;
  incoming_->become(scene_->lights);
  if (surroundings_->surfaces()) surroundings_->set_lamps(*scene_, *incoming_);
  std::vector<scene::StageTime> times{{"environment", watch.lap()}};
  if (!scatters_) return times;
  StageTimer timer(context_);
  source_->light(*incoming_, timer, execution);
  append(times, timer.times());
  return times;
}

std::pair<bool, std::string> GridPicture::multiple() const {
  if (!grid_) return {false, "no medium extinguishes"};
  if (!grid_->single_only().empty()) return {false, grid_->single_only()};
  return {true, fmt::format("{} bands, deepest cell {:.2g}; {} iterations, error about {:.1g}{}", options_.order,
                            grid_->deepest_cell(), source_->iterations(), source_->error(),
                            source_->error() > options_.tolerance ? ": more than the tolerance" : "")};
}

void GridPicture::find_source(const View& view) const {
  if (!scatters_) return;
  frame_.timer.begin("towards the camera");
  source_->towards(view, middle_);
}

void GridPicture::bind_source(Program& p) const {
  if (!scatters_) return;
  source_->logarithms().bind(at::logarithms);
  set_grid(p, grid_->grid(), middle_);
  p.set("brightest", airlight::compensated_ray_marching::has_hard_edges(smoke_->medium())
                         ? Rgb((smoke_->medium().albedo * incoming_->brightest()).min(1e37))
                         : Rgb(Rgb::Constant(1e37)));
}

void GridPicture::light_surfaces(const View& view) const {
  surroundings_->light_surfaces(view, frame_, [&](const scene::Light& light) { dim(view, light); });
}

void GridPicture::dim(const View& view, const scene::Light& light) const {
  if (!smoke_) return;
  Program& p = *dim_;
  of_pixels("lit", view, sizeof(wavelet_fog::LitData)).bind(at::lit);
  density_->bind(p);
  set_view(p, view);
  p.set_double("middle", middle_);
  p.set("to_light", std::get<scene::DirectionalLight>(light).to_light);
  p.set("sigma_t", smoke_->medium().sigma_t);
  p.set("widths2", density_->widths2());
  p.set("loop_count", 3);
  p.dispatch(view.width, view.height);
}

void GridPicture::count(std::map<std::string, double>& counters) const {
  if (!scatters_) return;
  counters["iterations"] = source_->iterations();
  counters["multiple_error"] = source_->error();
  counters["deepest_cell"] = grid_->deepest_cell();
}

}  // namespace

std::unique_ptr<Picture> prepare_grid_picture(std::shared_ptr<const Scene> scene, const Options& options,
                                              std::string settings, Solution last, const Execution& execution) {
  return std::make_unique<GridPicture>(std::move(scene), options, std::move(settings), std::move(last), execution);
}

}  // namespace airlight::gpu::compensated_ray_marching
