#include "gpu/froxel_fog/volume.h"

#include <algorithm>
#include <array>

#include "gpu/froxel_fog/interface.h"
#include "gpu/ray_marcher/interface.h"
#include "gpu/view_uniforms.h"

namespace airlight::gpu::froxel_fog {
namespace {

using airlight::froxel_fog::Distribution;
using airlight::froxel_fog::Filter;

constexpr int frames_at_once = 64;                        // of a batch
constexpr std::size_t end_bytes = std::size_t(16) << 20;  // of where the rays of a batch end
constexpr int line_group = 64;

std::map<std::string, std::string> tiled(std::map<std::string, std::string> definitions = {}) {
  definitions["LOCAL_SIZE_X"] = definitions["LOCAL_SIZE_Y"] = std::to_string(pixel_tile);
  return definitions;
}
std::map<std::string, std::string> in_line() { return {{"LOCAL_SIZE_X", std::to_string(line_group)}}; }

std::map<std::string, std::string> of_media(const lit_media::LitMedia& lit, bool history) {
  auto definitions = tiled(lit.definitions());
  definitions["HISTORY"] = history ? "1" : "0";
  return definitions;
}

}  // namespace

Volume::Volume(Context& context, const Options& options, const lit_media::LitMedia& lit, const Ends& ends,
               const std::vector<std::array<float, 4>>& frames, const Froxels* history)
    : context_(context),
      options_(options),
      lit_(lit),
      ends_(ends),
      frames_(frames),
      history_(history),
      frame_data_(context, "frames", frames),
      slices_(program(context, "froxel_fog/slices.comp", in_line())),
      inject_(program(context, "froxel_fog/inject.comp", of_media(lit, history != nullptr))),
      integrate_(program(context, "froxel_fog/integrate.comp", tiled())),
      picture_(program(context, "froxel_fog/picture.comp", tiled())),
      rounds_(context, "froxels") {
  if (options.far == 0) fit_ = &program(context, "froxel_fog/fit.comp", tiled(lit.media().definitions()));
  if (options.filter != Filter::none) filter_ = &program(context, "froxel_fog/filter.comp", in_line());
}

void Volume::set_slices(LinkedProgram& p) const {
  p.set("distribution", int(options_.depth));
  p.set("parameter", options_.depth == Distribution::log ? options_.log_c : options_.exponent);
}

void Volume::set_grid(LinkedProgram& p, const Froxels& froxels) const {
  p.set("columns", froxels.cells.columns);
  p.set("rows", froxels.cells.rows);
  p.set("slices", options_.slices);
  p.set("cell_width", froxels.cells.width);
  p.set("cell_height", froxels.cells.height);
  set_camera(p, froxels.view, lit_.media().middle());
  froxels.slices->bind(at::slices);
}

void Volume::fit(const scene::View& view, const Buffer* distances, Frame& frame) {
  Buffer& fitted = frame.buffers.get("range of media", 8);
  fitted.clear();
  lit_.media().bind(*fit_);
  set_camera(*fit_, view, lit_.media().middle());
  if (distances) distances->bind(at::distances);
  fitted.bind(at::fitted);
  fit_->set("has_distances", distances != nullptr);
  fit_->dispatch(view.width, view.height);
}

void Volume::lay_slices(Froxels& froxels, Frame& frame, int first_frame, int count) {
  set_grid(slices_, froxels);
  set_slices(slices_);
  frame.buffers.get("range of media", 8).bind(at::fitted);
  frame_data_.bind(at::frames);
  (history_ ? *history_ : froxels).slices->bind(at::history_slices);
  slices_.set("near", options_.near);
  slices_.set("far", options_.far);
  slices_.set("first_frame", first_frame);
  slices_.set("frame_count", count);
  slices_.set("has_history", history_ != nullptr);
  slices_.dispatch(options_.slices + 1);
}

void Volume::find_ends(const scene::View& view, const Froxels& froxels, const Buffer& ends, int first_frame,
                       int count) {
  const auto& cells = froxels.cells;
  const std::size_t rays = std::size_t(cells.columns) * cells.rows;
  for (int i = 0; i < count; ++i) {
    const auto& look = frames_[std::size_t(first_frame) + i];
    const CellGrid grid{cells.columns, cells.rows, cells.width, cells.height, look[0], look[1], std::size_t(i) * rays};
    if (ends_.surfaces) ends_.surfaces->find(view, ends, grid);
    if (ends_.backdrops) ends_.backdrops->find(view, ends, ends_.surfaces != nullptr, grid);
  }
}

void Volume::inject(const scene::View& view, Froxels& froxels, Frame& frame, int first_frame, int count, int batch,
                    bool counts) {
  const auto& cells = froxels.cells;
  const bool ends_rays = ends_.surfaces || ends_.backdrops;
  if (ends_rays) {
    const Buffer& ends =
        frame.buffers.get("ends of froxels' rays", 4 * std::size_t(cells.columns) * cells.rows * std::size_t(batch));
    find_ends(view, froxels, ends, first_frame, count);
    ends.bind(at::ends);
  }
  Program& p = inject_;
  lit_.bind(p);
  set_grid(p, froxels);
  if (history_) {
    const scene::Camera& camera = history_->view.camera;
    const HalfFilm half = half_film(history_->view);
    set_slices(p);
    p.set("history_perspective", camera.kind == scene::Camera::Kind::perspective);
    p.set("history_columns", history_->cells.columns);
    p.set("history_rows", history_->cells.rows);
    p.set("history_position", Vec3(camera.position - lit_.media().middle()));
    p.set("history_forward", camera.forward);
    p.set("history_right", Vec3(camera.right / half.x));
    p.set("history_up", Vec3(camera.up / half.y));
    p.set("history_film_width", history_->view.width / history_->cells.width);
    p.set("history_film_height", history_->view.height / history_->cells.height);
    p.set("history_weight", options_.history_weight);
    history_->light->bind(at::history_light);
    history_->media->bind(at::history_media);
  }
  froxels.light->bind(at::light);
  froxels.media->bind(at::media);
  frame_data_.bind(at::frames);
  frame.buffers.get("froxel totals", 32).bind(at::totals);
  p.set("first_frame", first_frame);
  p.set("frame_count", count);
  p.set("has_ends", ends_rays);
  p.set("counts", counts);
  const int across = (cells.columns + pixel_tile - 1) / pixel_tile, down = (cells.rows + pixel_tile - 1) / pixel_tile;
  p.set("tile_columns", across);
  p.set("tile_rows", down);
  const int at_once = std::clamp(context_.limits().groups[0] / (across * down), 1, options_.slices);
  for (int slice = 0; slice < options_.slices; slice += at_once) {
    p.set("first_slice", slice);
    rounds_.run(p, frame.buffers, across * down * std::min(at_once, options_.slices - slice));
  }
}

void Volume::make(const scene::View& view, const Buffer* distances, Froxels& froxels, Frame& frame, bool counts,
                  bool looks, const std::function<bool(double)>& progress) {
  froxels.cells = airlight::froxel_fog::cells_of(options_, view.width, view.height);
  froxels.view = view;
  const std::size_t cells = std::size_t(froxels.cells.columns) * froxels.cells.rows;
  const std::size_t bytes = 16 * cells * std::size_t(options_.slices);
  const int batch = std::clamp(int(end_bytes / (4 * cells)), 1, std::min(frames_at_once, int(frames_.size())));
  const std::size_t slice_bytes = 4 * std::size_t(options_.slices) * std::size_t(batch + 2) + 4 * 6;
  const auto require = [&](std::unique_ptr<Buffer>& buffer, const char* name, std::size_t size) {
    if (!buffer || buffer->bytes() != size)
      buffer = std::make_unique<Buffer>(context_, name, size, Contents::undefined);
    else if (poisoned())
      buffer->poison();
  };
  require(froxels.light, "light of froxels", bytes);
  require(froxels.media, "media of froxels", bytes);
  require(froxels.slices, "slices", slice_bytes);
  if (fit_) {
    frame.timer.begin("fit");
    fit(view, distances, frame);
  }
  frame.timer.begin("inject");
  frame.buffers.get("froxel totals", 32).clear();
  rounds_.begin(looks, progress);
  for (int first = 0; first < int(frames_.size()); first += batch) {
    const int count = std::min(batch, int(frames_.size()) - first);
    lay_slices(froxels, frame, first, count);
    inject(view, froxels, frame, first, count, batch, counts);
  }
  const Buffer *light = froxels.light.get(), *media = froxels.media.get();
  int written = 0;
  const auto next_pair = [&]() -> std::pair<Buffer*, Buffer*> {
    const std::string number = std::to_string(written++ % 2);
    return {&frame.buffers.get("light " + number, bytes), &frame.buffers.get("media " + number, bytes)};
  };
  if (filter_) {
    frame.timer.begin("filter");
    const std::vector<float> weights = airlight::froxel_fog::filter_weights(options_.filter);
    Vec3 outwards = Vec3::Zero();
    for (std::size_t r = 1; r < weights.size(); ++r) outwards[int(r) - 1] = weights[r];
    filter_->set("cells", int(cells));
    filter_->set("radius", int(weights.size()) - 1);
    filter_->set("weights", outwards);
    const int columns = froxels.cells.columns, rows = froxels.cells.rows;
    const std::array<int, 2> x{1, columns}, u{columns * rows, options_.slices}, y{columns, rows};  // stride, count
    for (const auto& [stride, count] : options_.filter == Filter::gauss7 ? std::vector{x, u, y} : std::vector{x, y}) {
      const auto [to_light, to_media] = next_pair();
      light->bind(at::light);
      media->bind(at::media);
      to_light->bind(at::filtered_light);
      to_media->bind(at::filtered_media);
      filter_->set("stride", stride);
      filter_->set("count", count);
      filter_->dispatch(int(cells), options_.slices);
      light = to_light, media = to_media;
    }
  }
  frame.timer.begin("integrate");
  set_grid(integrate_, froxels);
  light->bind(at::light);
  media->bind(at::media);
  const auto [airlight, transmittance] = next_pair();
  airlight->bind(at::airlight);
  transmittance->bind(at::transmittance);
  integrate_.dispatch(froxels.cells.columns, froxels.cells.rows);
  integrated_ = {airlight, transmittance};
}

void Volume::look_up(const scene::View& view, const Buffer* distances, const Froxels& froxels,
                     const ray_marcher::Band& band, Frame& frame) {
  frame.timer.begin("picture");
  set_grid(picture_, froxels);
  set_slices(picture_);
  if (distances) distances->bind(at::distances);
  band.pixels.bind(ray_marcher::at::pixels);
  integrated_.first->bind(at::airlight);
  integrated_.second->bind(at::transmittance);
  picture_.set("first_row", band.first_row);
  picture_.set("band_rows", band.rows);
  picture_.set("has_distances", distances != nullptr);
  picture_.dispatch(view.width, band.rows);
}

void Volume::note(Frame& frame, const Froxels& froxels) const {
  const Buffer& totals = frame.buffers.get("froxel totals", 32);
  frame.download.add_values("froxel totals", totals, totals.bytes());
  frame.download.add_values("range", *froxels.slices, 12);
  rounds_.note(frame.download);
}

}  // namespace airlight::gpu::froxel_fog
