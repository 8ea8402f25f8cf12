#include "experiments/authoring/fogmap_script.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <optional>

#include "experiments/authoring/operation.h"
#include "experiments/authoring/write_scene.h"
#include "scene/base/error.h"
#include "scene/base/printable.h"
#include "scene/film/grey_image.h"
#include "scene/load/parse_toml.h"
#include "scene/load/ranges.h"
#include "scene/media/voxel_grid.h"

namespace airlight::experiments::authoring {
namespace {

namespace fs = std::filesystem;
using namespace scene::load;  // ranges of numbers
using wavelet_fog::authoring::Canvas;
using wavelet_fog::authoring::MapPlace;

constexpr long long most_side = 8192;

std::string profile_of(const Operation& op) {
  const auto profile = op.table("profile");
  if (!profile) return "";
  const std::string type = profile->choice("type", {"none", "layers", "exponential"});
  if (type == "none") {
    profile->allow({"type"});
    return "profile = { type = \"none\" }\n";
  }
  if (type == "exponential") {
    profile->allow({"type", "base", "scale_height"});
    return fmt::format("profile = {{ type = \"exponential\", base = {}, scale_height = {} }}\n",
                       profile->number("base", coordinate, 0), profile->number("scale_height", length));
  }
  profile->allow({"type", "knots"});
  std::vector<double> heights, factors;
  for (const auto& knot : profile->points("knots", 2)) {
    heights.push_back(knot[0]);
    factors.push_back(knot[1]);
  }
  return fmt::format("profile = {{ type = \"layers\", heights = {}, factors = {} }}\n", heights, factors);
}

std::string point(const Vec3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

class MapRun {
 public:
  explicit MapRun(const std::string& path) : folder_(fs::path(path).parent_path()) {}

  // Reads an operation; what is taken back is never done.
  void line(Operation op, int number) {
    const std::string name = op.name({"fogmap", "view", "stroke", "noise", "blur", "columns", "undo"});
    if (!canvas_ && name != "fogmap") op.fail("found before 'fogmap', expected that as the first operation");
    if (name == "fogmap") return fogmap(op);
    if (name == "view") return view(op);
    if (name == "undo") return undo(op);
    changes_.push_back({std::move(op), number, name});
  }

  void draw(const std::function<void()>& check) {
    for (const Change& c : changes_) {
      check();
      at_operation(c.op.where(), [&] { change(c.name, c.op); });
      const auto& values = canvas_->values();
      done_.push_back({c.line, c.name, std::accumulate(values.begin(), values.end(), 0.0),
                       *std::max_element(values.begin(), values.end())});
    }
  }

  DrawnFogmap result(const std::string& path) {
    if (view_.empty()) throw Error(fmt::format("{}: found no camera, expected a 'view' operation", path));
    return {std::move(*canvas_), medium_, scene_ + view_, std::move(done_)};
  }

 private:
  void fogmap(const Operation& op) {
    op.allow({"width", "height", "cell", "corner", "degree", "sigma_t", "albedo", "profile", "top", "ambient"});
    if (canvas_) op.fail("found again, expected it once, as the first operation");
    const double cell = op.number("cell", length, 1);
    const int width = int(op.integer("width", 1, most_side)), height = int(op.integer("height", 1, most_side));
    corner_ =
        op.has("corner") ? op.numbers("corner", 2) : std::vector<double>{-0.5 * cell * width, -0.5 * cell * height};
    canvas_.emplace(width, height, cell);
    medium_ = fmt::format("cell = {}\ncorner = [{}, {}]\ndegree = {}\nsigma_t = {}\n", cell, corner_[0], corner_[1],
                          op.integer("degree", 0, 3, 1), op.number("sigma_t", amount, 1));
    if (op.has("albedo")) medium_ += fmt::format("albedo = {}\n", op.number("albedo", share));
    medium_ += profile_of(op);
    medium_ += fmt::format("region = {{ type = \"slab\", lo = {}, hi = {} }}\n", -op.number("top", length, 100),
                           op.number("top", length, 100));
    scene_ = fmt::format("ambient_in_scatter = {}\n", op.number("ambient", amount, 0.8));
  }

  void view(const Operation& op) {
    op.allow({"position", "look_at", "up", "vertical_fov", "width", "height"});
    view_ = fmt::format(
        "\n[film]\nwidth = {}\nheight = {}\n\n[camera]\nposition = {}\nlook_at = {}\nup = {}\nvertical_fov = {}\n",
        op.integer("width", 1, 16384, 800), op.integer("height", 1, 16384, 600), point(op.vector("position")),
        point(op.vector("look_at")), point(op.direction("up", Vec3(Vec3::UnitY()))),
        op.number("vertical_fov", {0, pi, true, true}, 0.7));
  }

  void change(const std::string& name, const Operation& op) {
    if (name == "stroke") {
      op.allow({"points", "radius", "hardness", "opacity", "value", "mode"});
      Canvas::Brush brush{op.number("radius", positive)};
      brush.hardness = op.number("hardness", share, 0.5);
      brush.opacity = op.number("opacity", share, 1);
      brush.value = op.number("value", not_negative, 1);
      const std::string mode = op.choice("mode", {"add", "paint", "erase"}, "paint");
      brush.mode = mode == "add"     ? Canvas::Brush::Mode::add
                   : mode == "paint" ? Canvas::Brush::Mode::paint
                                     : Canvas::Brush::Mode::erase;
      std::vector<MapPlace> places;
      for (const auto& p : op.points("points", 2)) places.push_back({p[0] - corner_[0], p[1] - corner_[1]});
      canvas_->stroke(places, brush);
    } else if (name == "noise") {
      op.allow({"seed", "size", "octaves", "gain", "low", "high", "mode"});
      Canvas::Noise noise;
      noise.seed = std::uint32_t(op.integer("seed", 0, 0xFFFFFFFFll, 0));
      noise.size = op.number("size", positive);
      noise.octaves = int(op.integer("octaves", 1, 16, 4));
      noise.gain = op.number("gain", share, 0.5);
      noise.low = op.number("low", any_number, 0);
      noise.high = op.number("high", {noise.low, infinity}, 1);
      noise.mode = op.choice("mode", {"add", "multiply"}, "add") == "add" ? Canvas::Noise::Mode::add
                                                                          : Canvas::Noise::Mode::multiply;
      canvas_->noise(noise);
    } else if (name == "blur") {
      op.allow({"deviation"});
      canvas_->blur(op.number("deviation", not_negative));
    } else {
      op.allow({"file", "grid", "samples", "height", "moved"});
      const fs::path file = op.text("file");
      auto grid = scene::read_vdb((file.is_absolute() ? file : folder_ / file).string(), op.text("grid", "density"));
      grid.translation += op.vector("moved", Vec3(Vec3::Zero()));
      canvas_->columns(std::make_shared<const scene::VoxelGrid>(std::move(grid)), corner_[0], corner_[1],
                       int(op.integer("samples", 1, 64, 2)), op.number("height", positive));
    }
  }

  void undo(const Operation& op) {
    op.allow({"count"});
    const long long count = op.integer("count", 1, 1'000'000, 1);
    if (count > (long long)(changes_.size()))
      op.fail(
          fmt::format("count = {}, expected at most {}, the operations that change the map", count, changes_.size()));
    changes_.erase(changes_.end() - count, changes_.end());
  }

  struct Change {
    Operation op;
    int line;
    std::string name;
  };
  fs::path folder_;
  std::vector<double> corner_;
  std::optional<Canvas> canvas_;
  std::vector<Change> changes_;
  std::string medium_, scene_, view_;
  std::vector<DrawnFogmap::Done> done_;
};

}  // namespace

bool draws_fogmap(const std::string& path) {
  bool drawn = false;
  for_each_operation(
      path, [] {},
      [&](const Operation& op, int) {
        drawn = op.text("op", "") == "fogmap";
        return false;
      });
  return drawn;
}

DrawnFogmap run_fogmap_script(const std::string& path, const std::function<void()>& check) {
  MapRun run(path);
  for_each_operation(path, check, [&](Operation op, int line) {
    run.line(std::move(op), line);
    return true;
  });
  run.draw(check);
  return run.result(path);
}

std::string write(const DrawnFogmap& drawn, const std::string& script, const std::string& out) {
  const Canvas& canvas = drawn.canvas;
  const auto& values = canvas.values();
  const bool fits = *std::max_element(values.begin(), values.end()) <= 1;
  std::string name = fs::path(out).stem().string() + (fits ? ".png" : ".exr");
  const std::string path = (fs::path(out).parent_path() / name).string();
  scene::write_grey_image(path, {canvas.width(), canvas.height(), values, ""});
  write_checked(
      fmt::format(
          "# Made by `airlight author {}`: change that and not this.\n{}\n[[medium]]\ntype = \"fogmap\"\nfile = {}\n{}",
          scene::printable(fs::path(script).filename().string(), 200), drawn.scene, scene::load::toml_string(name),
          drawn.medium),
      out, {name});
  return name;
}

}  // namespace airlight::experiments::authoring
