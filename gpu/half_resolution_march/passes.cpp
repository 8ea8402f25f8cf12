#include "gpu/half_resolution_march/passes.h"

#include "gpu/half_resolution_march/interface.h"
#include "gpu/ray_marcher/interface.h"
#include "gpu/view_uniforms.h"
#include "reference/half_resolution_march/filter.h"
#include "reference/half_resolution_march/passes.h"
#include "scene/media/same_medium.h"

namespace airlight::gpu::half_resolution_march {
namespace {

int columns_of(const Options& o, const scene::View& view) { return (view.width + o.divide - 1) / o.divide; }
int rows_of(const Options& o, const scene::View& view) { return (view.height + o.divide - 1) / o.divide; }
std::size_t blocks_of(const Options& o, const scene::View& view) {
  return std::size_t(columns_of(o, view)) * rows_of(o, view);
}

std::map<std::string, std::string> tiles(std::map<std::string, std::string> definitions = {}) {
  const std::string side = std::to_string(ray_marcher::Rounds::tile);
  definitions.insert({{"LOCAL_SIZE_X", side}, {"LOCAL_SIZE_Y", side}});
  return definitions;
}

// The camera as history.comp projects by it, number 0 or 1.
void set_projection(Program& p, int number, const scene::View& view, const Point3& middle) {
  const std::string n = "[" + std::to_string(number) + "]";
  const HalfFilm half = half_film(view);
  p.set("view_position" + n, Vec3(view.camera.position - middle));
  p.set("view_forward" + n, view.camera.forward);
  p.set("view_right" + n, Vec3(view.camera.right / half.x));
  p.set("view_up" + n, Vec3(view.camera.up / half.y));
  p.set("parallel" + n, view.camera.kind == scene::Camera::Kind::orthographic);
}

}  // namespace

Passes::Passes(Context& context, std::shared_ptr<const scene::Scene> scene, const Options& options,
               ray_marcher::GridStorage storage, FirstHits::Way way, StageTimer& timer,
               const std::function<bool(double)>& progress)
    : context_(context),
      options_(options),
      plan_(airlight::lit_media::make_plan(std::move(scene), options.media)),
      ends_(context, *plan_.scene, way),
      lit_(context, plan_, storage, ends_.surfaces(), timer, progress),
      picture_(context, *plan_.scene, lit_.media(), lit_.columns(), int(plan_.lights.size()), columns_,
               ends_.surfaces()),
      rounds_(context, "march") {
  if (plan_.layers.empty()) return;
  low_depths_ = &program(context, "low_depths.comp", tiles());
  march_ = &program(context, "march.comp", tiles(lit_.definitions()));
  first_ = &program(context, "history.comp", tiles({{"HISTORY", "0"}}));
  if (options.reproject) blend_ = &program(context, "history.comp", tiles({{"HISTORY", "1"}}));
  if (options.blur) blur_ = &program(context, "blur.comp", tiles());
  upsample_ = &program(context, "upsample.comp", tiles());
}

bool Passes::become(std::shared_ptr<const scene::Scene> scene, StageTimer& timer,
                    const std::function<bool(double)>& progress) {
  airlight::lit_media::Plan next = make_plan(std::move(scene), options_.media, &plan_);
  if (next.layers.empty() != plan_.layers.empty() || !lit_.is_like(next)) return false;
  if (!ends_.become(*plan_.scene, *next.scene) || !picture_.become(*next.scene)) return false;
  const bool same_media = scene::same_media(plan_.scene->media, next.scene->media);
  plan_ = std::move(next);
  lit_.become(same_media, timer, progress);
  return true;
}

std::size_t Passes::low_bytes(const scene::View& view) const {
  return sizeof(LowPixelData) * (plan_.layers.empty() ? 1 : blocks_of(options_, view));
}

void Passes::set_blocks(Program& p, const scene::View& view) const {
  p.set("divide", options_.divide);
  p.set("block_columns", columns_of(options_, view));
  p.set("block_rows", rows_of(options_, view));
  p.set("edge_share", options_.edge);
}

// Where blocks are marched through their middles, what ends the rays there is found first.
void Passes::find_depths(const scene::View& view, const Buffer* distances, const Buffer& blocks, Frame& frame) {
  const int columns = columns_of(options_, view), rows = rows_of(options_, view);
  const bool of_blocks = distances && !options_.min_max && options_.divide > 1;
  if (of_blocks) {
    const double side = options_.divide;
    const CellGrid middles{columns, rows, side, side, 0.5, 0.5, 0, true};
    distances = &frame.buffers.get("distances of blocks", 4 * blocks_of(options_, view));
    if (ends_.surfaces()) ends_.surfaces()->find(view, *distances, middles);
    if (ends_.backdrops()) ends_.backdrops()->find(view, *distances, ends_.surfaces() != nullptr, middles);
  }
  Program& p = *low_depths_;
  if (distances) distances->bind(ray_marcher::at::distances);
  blocks.bind(at::blocks);
  set_camera(p, view, lit_.media().middle());
  set_blocks(p, view);
  p.set("has_distances", distances != nullptr);
  p.set("of_blocks", of_blocks);
  p.dispatch(columns, rows);
}

void Passes::march(const scene::View& view, int first, const Buffer& blocks, Frame& frame) {
  const int columns = columns_of(options_, view), rows = rows_of(options_, view);
  Program& p = *march_;
  lit_.bind(p);
  blocks.bind(at::blocks);
  set_camera(p, view, lit_.media().middle());
  set_blocks(p, view);
  p.set("jitter", int(options_.jitter));
  p.set("steps", options_.steps);
  p.set("frames", options_.frames);
  p.set("first_frame", first);
  p.set("from_camera", options_.from_camera);
  p.set("analytic", options_.analytic);
  p.set("airlight_depth", options_.airlight_depth);
  p.set("horizon", airlight::half_resolution_march::horizon);
  const auto in_tiles = [](int n) { return (n + ray_marcher::Rounds::tile - 1) / ray_marcher::Rounds::tile; };
  p.set("tile_columns", in_tiles(columns));
  rounds_.run(p, frame.buffers, in_tiles(columns) * in_tiles(rows));
}

void Passes::blend(const scene::View& view, const History* last, const Buffer& blocks, const Buffer& low) {
  Program& p = last ? *blend_ : *first_;
  blocks.bind(at::blocks);
  low.bind(at::low);
  set_blocks(p, view);
  p.set("frames", options_.frames);
  if (last) {
    const Point3& middle = lit_.media().middle();
    last->film.bind(at::last);
    set_camera(p, view, middle);
    set_projection(p, 0, view, middle);
    set_projection(p, 1, last->view, middle);
    p.set("history_weight", options_.history_weight);
    p.set("clamps", options_.clamp);
  }
  p.dispatch(columns_of(options_, view), rows_of(options_, view));
}

const Buffer& Passes::blur(const scene::View& view, const Buffer& low, Frame& frame) {
  using namespace airlight::half_resolution_march;
  const Buffer& rows = frame.buffers.get("blurred along rows", low_bytes(view));
  const Buffer& both = frame.buffers.get("blurred", low_bytes(view));
  Program& p = *blur_;
  set_blocks(p, view);
  p.set("radius", blur_radius);
  p.set("over_variance", 1 / (2 * blur_sigma * blur_sigma));
  for (const bool columns : {false, true}) {
    (columns ? rows : low).bind(at::low);
    (columns ? both : rows).bind(at::blurred);
    p.set("along_columns", columns);
    p.dispatch(columns_of(options_, view), rows_of(options_, view));
  }
  return both;
}

void Passes::upsample(const scene::View& view, const Buffer* distances, const Buffer& blocks, const Buffer& low,
                      const ray_marcher::Band& band) {
  Program& p = *upsample_;
  blocks.bind(at::blocks);
  low.bind(at::low);
  band.pixels.bind(ray_marcher::at::pixels);
  if (distances) distances->bind(ray_marcher::at::distances);
  set_camera(p, view, lit_.media().middle());
  set_blocks(p, view);
  p.set("has_distances", distances != nullptr);
  p.set("rows", band.rows);
  p.set("first_row", band.first_row);
  p.set("nearest_depth", options_.nearest_depth);
  p.set("upsample_edges", airlight::half_resolution_march::upsample_edges);
  p.dispatch(view.width, band.rows);
}

void Passes::draw(const scene::View& view, int first, const History* last, const Buffer& low, Frame& frame, bool looks,
                  const std::function<bool(double)>& progress) {
  const Use use(context_);
  const ray_marcher::FilmOnDevice film = ends_.begin_film(view, frame);
  rounds_.begin(looks, progress);
  std::function<void(const ray_marcher::Band&)> fill;
  if (march_) {
    const Buffer& blocks =
        frame.buffers.get("blocks", sizeof(BlocksHead) + sizeof(BlockData) * blocks_of(options_, view));
    frame.timer.begin("march");
    find_depths(view, film.distances, blocks, frame);
    march(view, first, blocks, frame);
    if (last) frame.timer.begin("history");
    blend(view, last, blocks, low);
    if (blur_) frame.timer.begin("blur");
    const Buffer& seen = blur_ ? blur(view, low, frame) : low;
    fill = [&, distances = film.distances](const ray_marcher::Band& band) {
      frame.timer.begin("composition");
      upsample(view, distances, blocks, seen, band);
    };
    frame.download.add_values("history", blocks, sizeof(BlocksHead));
  }
  Buffer* const totals = frame.download.wants_any() ? &frame.buffers.get("totals", 8 * sizeof(unsigned)) : nullptr;
  if (totals) totals->clear();
  picture_.render(view, film, frame, fill, totals, looks, progress);
  if (totals) frame.download.add_values("totals", *totals, totals->bytes());
  rounds_.note(frame.download);
  picture_.note(frame.download);
}

bool Passes::finished(const Download& download) const {
  return !rounds_.unfinished(download) && !picture_.unfinished(download);
}

std::map<std::string, double> Passes::counters(const scene::View& view, const Download& download) const {
  const std::vector<double> totals = ray_marcher::totals_of(download, "totals");
  const std::vector<unsigned> history = download.values<unsigned>("history");
  std::map<std::string, double> counters;
  if (totals.empty()) return counters;
  counters = {{"rays", march_ ? double(blocks_of(options_, view)) * options_.frames : 0},
              {"points", totals[0]},
              {"look_ups", totals[1]},
              {"occlusion_rays", totals[3]}};
  if (options_.reproject) {
    counters["history_used"] = march_ ? history[1] : 0;
    counters["history_rejected"] = march_ ? history[2] : 0;
  }
  if (options_.clamp) counters["history_clamped"] = march_ ? history[3] : 0;
  return counters;
}

}  // namespace airlight::gpu::half_resolution_march
