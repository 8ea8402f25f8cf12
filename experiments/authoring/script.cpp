#include "experiments/authoring/script.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "experiments/authoring/operation.h"
#include "methods/fogshop/authoring/airbrush.h"
#include "methods/fogshop/authoring/edit.h"
#include "methods/fogshop/authoring/emit.h"
#include "methods/fogshop/authoring/frames.h"
#include "methods/fogshop/authoring/paint.h"
#include "scene/base/error.h"

namespace airlight::experiments::authoring {
namespace {

using namespace fogshop::authoring;
using namespace scene::load;  // ranges of numbers

using Ids = std::vector<Id>;

std::uint32_t seed_of(const Operation& op) { return std::uint32_t(op.integer("seed", 0, 0xFFFFFFFFll, 0)); }

Gaussian brush_of(const Operation& op) {
  Gaussian brush;
  brush.a = op.number("a", positive);
  brush.c = op.number("c", positive);
  brush.color = op.color("color");
  brush.tag = op.text("tag", "");
  return brush;
}

std::vector<ScreenPoint> screen_points(const Operation& op, const std::string& key) {
  std::vector<ScreenPoint> points;
  for (const auto& p : op.points(key, 2)) points.emplace_back(p[0], p[1]);
  return points;
}

std::vector<Point3> world_points(const Operation& op, const std::string& key) {
  std::vector<Point3> points;
  for (const auto& p : op.points(key, 3)) points.emplace_back(p[0], p[1], p[2]);
  return points;
}

Placement placement_of(const Operation& op) {
  Placement placement;
  placement.keep =
      op.choice("keep", {"depth", "density"}, "depth") == "depth" ? Placement::Keep::depth : Placement::Keep::density;
  const auto transform = op.table("transform");
  if (!transform) op.fail("missing key 'transform', expected an object of rotation, scale, translation");
  transform->allow({"rotation", "scale", "translation"});
  placement.scale = transform->number("scale", positive, 1);
  placement.translation = transform->vector("translation", Vec3(Vec3::Zero()));
  if (const auto rotation = transform->table("rotation")) {
    rotation->allow({"axis", "angle"});
    placement.rotation =
        Eigen::AngleAxisd(rotation->number("angle", any_number), rotation->direction("axis")).toRotationMatrix();
  }
  return placement;
}

// The script while it runs.
class Run {
 public:
  Run(const std::string& path, const std::function<void()>& check, double later)
      : folder_(std::filesystem::path(path).parent_path()), check_(check), later_(later) {}

  void line(Operation op, int number) {
    const std::string name = op.name(
        {"scene", "view", "paint", "erase", "select", "copy", "move", "emit", "airbrush", "freeze", "import", "undo"});
    const bool first = number_of_operations_++ == 0;
    if (name == "scene") return scene(op, number, first);
    if (name == "view") return view(op);
    if (name == "undo") return undo(op);
    // A selection is no change of the list: there is nothing to undo.
    if (name != "select") out_.list.begin();
    out_.done.push_back({number, name, ids(name, op)});
  }

  Authored result() { return std::move(out_); }

 private:
  Ids ids(const std::string& name, const Operation& op) {
    if (name == "paint") return paint(op);
    if (name == "erase") return erase(op);
    if (name == "select") return select(op);
    if (name == "copy" || name == "move") {
      op.allow({"ids", "tag", "transform", "keep"});
      const Ids chosen = chosen_ids(op);
      return name == "copy" ? copy(out_.list, chosen, placement_of(op)) : move(out_.list, chosen, placement_of(op));
    }
    if (name == "emit") return emit(op);
    if (name == "airbrush") return airbrush(op);
    if (name == "freeze") {
      op.allow({});
      return freeze(out_.list);
    }
    return import(op);
  }

  std::string found(const Operation& op, const std::string& key) const {
    const std::filesystem::path name = op.text(key);
    return (name.is_absolute() ? name : folder_ / name).string();
  }

  void scene(const Operation& op, int number, bool first) {
    op.allow({"base"});
    if (!first) op.fail(fmt::format("found at line {}, expected it once, as the first operation", number));
    out_.base = found(op, "base");
    out_.scene = airlight::scene::load_scene(out_.base);
  }

  void view(const Operation& op) {
    op.allow({"position", "look_at", "up", "vertical_fov", "width", "height"});
    View view;
    view.camera =
        airlight::scene::look_at(op.vector("position"), op.vector("look_at"), op.direction("up", Vec3(Vec3::UnitY())));
    view.camera.vertical_fov = op.number("vertical_fov", {0, pi, true, true}, view.camera.vertical_fov);
    view.width = int(op.integer("width", 1, 16384, 800));
    view.height = int(op.integer("height", 1, 16384, 600));
    out_.view = view;
  }

  View view_for(const Operation& op) const {
    if (out_.view) return *out_.view;
    if (!out_.scene) op.fail("there is no camera, expected a 'scene' or a 'view' operation before it");
    return {out_.scene->camera, out_.scene->width, out_.scene->height};
  }

  Ids paint(const Operation& op) {
    op.allow({"stroke", "screen", "plane", "a", "c", "spacing", "jitter", "seed", "color", "tag"});
    Paint brush;
    brush.brush = brush_of(op);
    brush.seed = seed_of(op);
    if (op.has("spacing")) brush.spacing = op.number("spacing", positive);
    if (op.has("jitter")) brush.jitter = op.number("jitter", not_negative);
    if (op.one_of({"stroke", "screen"}) == "stroke") {
      if (op.has("plane")) op.fail("found 'plane' beside 'stroke', expected it beside 'screen' only");
      brush.stroke = world_points(op, "stroke");
    } else {
      const View view = view_for(op);
      const auto plane = op.table("plane");
      if (!plane) op.fail("missing key 'plane', expected an object of normal and d");
      plane->allow({"normal", "d"});
      const fogshop::authoring::Canvas canvas{plane->direction("normal"), plane->number("d", any_number)};
      for (const ScreenPoint& p : screen_points(op, "screen"))
        if (const auto point = unproject(view, p, canvas)) brush.stroke.push_back(*point);
      if (brush.stroke.empty()) op.fail("no point of 'screen' meets the plane, expected at least one");
    }
    return fogshop::authoring::paint(out_.list, brush);
  }

  Ids erase(const Operation& op) {
    op.allow({"path", "screen", "radius", "strength"});
    const Eraser eraser{op.number("radius", positive), op.number("strength", share, 1)};
    if (op.one_of({"path", "screen"}) == "path")
      return fogshop::authoring::erase(out_.list, world_points(op, "path"), eraser);
    return fogshop::authoring::erase(out_.list, view_for(op), screen_points(op, "screen"), eraser);
  }

  Ids select(const Operation& op) {
    op.allow({"rect", "near"});
    const auto r = op.numbers("rect", 4);
    if (!(r[0] < r[2] && r[1] < r[3])) op.expected("rect", "[x0, y0, x1, y1] with x0 < x1 and y0 < y1");
    selection_ = fogshop::authoring::select(out_.list, view_for(op), {r[0], r[1]}, {r[2], r[3]},
                                            op.number("near", not_negative, 0));
    return selection_;
  }

  // The Gaussians that "ids" or "tag" name; else the last selection.
  Ids chosen_ids(const Operation& op) const {
    if (!op.has("ids") && !op.has("tag")) return selection_;
    if (op.one_of({"ids", "tag"}) == "ids") {
      const auto ids = op.integers("ids");
      return {ids.begin(), ids.end()};
    }
    const std::string tag = op.text("tag");
    Ids ids;
    for (const Gaussian& gaussian : out_.list.all())
      if (gaussian.tag == tag) ids.push_back(gaussian.id);
    if (ids.empty()) op.expected("tag", "the tag of a Gaussian");
    return ids;
  }

  Ids emit(const Operation& op) {
    op.allow({"pos", "rate", "v0", "spread", "accel", "life", "a0", "a1", "c0", "c1", "color", "tag", "t0", "t1",
              "time", "seed"});
    Emitter emitter;
    emitter.position = op.vector("pos");
    emitter.rate = op.number("rate", positive);
    emitter.velocity = op.vector("v0");
    emitter.spread = op.number("spread", not_negative, 0);
    emitter.acceleration = op.vector("accel", Vec3(Vec3::Zero()));
    emitter.life = op.number("life", positive);
    emitter.a0 = op.number("a0", positive);
    emitter.a1 = op.number("a1", positive, emitter.a0);
    emitter.c0 = op.number("c0", positive);
    emitter.c1 = op.number("c1", {0, emitter.c0}, 0);
    emitter.t0 = op.number("t0", any_number, 0);
    emitter.t1 = op.number("t1", {emitter.t0, infinity});
    emitter.color = op.color("color");
    emitter.tag = op.text("tag", "");
    emitter.seed = seed_of(op);
    Ids ids;
    const double time = op.number("time", any_number) + later_;
    for (Gaussian& gaussian : particles(emitter, time)) ids.push_back(out_.list.add(gaussian));
    return ids;
  }

  Ids airbrush(const Operation& op) {
    op.allow({"pos", "rate", "speed", "diffusion", "dt", "steps", "a", "c", "color", "tag", "seed"});
    Airbrush brush;
    brush.position = op.vector("pos");
    brush.rate = op.number("rate", positive);
    brush.speed = op.number("speed", not_negative);
    brush.diffusion = op.number("diffusion", not_negative);
    brush.dt = op.number("dt", positive);
    brush.steps = int(op.integer("steps", 0, 1'000'000'000));
    brush.brush = brush_of(op);
    brush.seed = seed_of(op);
    return fogshop::authoring::airbrush(out_.list, brush, out_.scene ? out_.scene->geometry.get() : nullptr, check_);
  }

  Ids import(const Operation& op) {
    op.allow({"file", "frame", "color", "tag"});
    Gaussian gaussian;
    gaussian.color = op.color("color");
    gaussian.tag = op.text("tag", "");
    Ids ids;
    const std::string file = found(op, "file");
    const double frame = op.number("frame", any_number);
    const bool fitted = std::filesystem::path(file).filename().string().find('#') != std::string::npos;
    for (const auto& [id, particle] :
         interpolate(fitted ? read_frames_around(file, frame) : read_frames(file), frame)) {
      if (!(particle.density > 0)) continue;  // nothing is there
      gaussian.a = 1 / particle.radius;
      gaussian.c = particle.density;
      gaussian.b = particle.position;
      ids.push_back(out_.list.add(gaussian));
    }
    return ids;
  }

  void undo(const Operation& op) {
    op.allow({"count"});
    const long long count = op.integer("count", 1, 1'000'000, 1);
    if (count > out_.list.steps())
      op.fail(fmt::format("count = {}, expected at most {}, the operations that changed the list", count,
                          out_.list.steps()));
    for (long long i = 0; i < count; ++i) out_.list.undo();
  }

  std::filesystem::path folder_;
  const std::function<void()>& check_;
  double later_;
  Authored out_;
  Ids selection_;
  int number_of_operations_ = 0;
};

}  // namespace

Authored run_script(const std::string& path, const std::function<void()>& check, double later) {
  Run run(path, check, later);
  for_each_operation(path, check, [&](Operation op, int line) {
    run.line(std::move(op), line);
    return true;
  });
  return run.result();
}

}  // namespace airlight::experiments::authoring
