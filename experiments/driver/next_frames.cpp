#include "experiments/driver/next_frames.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "experiments/driver/timing.h"
#include "scene/base/settings.h"
#include "scene/media/fogmap.h"
#include "scene/media/spline_map.h"

namespace airlight::experiments {
namespace {

using scene::Fogmap;
using scene::Scene;

bool move_lights(Scene& scene) {
  for (scene::Light& light : scene.lights) light = scene::moved(light, {1e-3, 0, 0});
  turn_lights(scene, 1e-3);
  return !scene.lights.empty();
}

template <class Change>
bool change_fogmaps(Scene& scene, const Change& change) {
  bool any = false;
  for (scene::Medium& medium : scene.media)
    if (auto* fog = std::get_if<scene::FogmapPointer>(&medium.field)) {
      auto changed = std::make_shared<Fogmap>(**fog);
      change(*changed);
      *fog = std::move(changed);
      any = true;
    }
  return any;
}

bool move_fog(Scene& scene) {
  return change_fogmaps(scene, [](Fogmap& fog) {
    constexpr double turn = 1e-4;
    const double c = fog.cos_turn, s = fog.sin_turn;
    fog.x0 += 1e-3;
    fog.cos_turn = c * std::cos(turn) - s * std::sin(turn);
    fog.sin_turn = s * std::cos(turn) + c * std::sin(turn);
  });
}

bool thin_fog(Scene& scene) {
  return change_fogmaps(scene, [](Fogmap& fog) {
    std::vector<double> coefficients = fog.map.coefficients();
    for (double& c : coefficients) c *= 0.999;
    fog.map = scene::SplineMap(fog.map.degree(), fog.map.range(), coefficients);
  });
}

void shift(scene::Region& region, const Vec3& by) {
  scene::match(
      region, [](scene::Unbounded&) {}, [&](Box& box) { box.lo += by, box.hi += by; },
      [&](scene::Sphere& ball) { ball.center += by; },
      [&](scene::Slab& slab) { slab.lo += slab.normal.dot(by), slab.hi += slab.normal.dot(by); });
}

bool move_media(Scene& scene) {
  const Vec3 by(1e-3, 0, 0);
  for (scene::Medium& medium : scene.media) {
    const bool has_place = bounding_box(medium).size().allFinite();
    medium.field = moved(medium.field, by);
    shift(medium.region, by);
    if (!has_place) medium.sigma_t *= 1.001;
  }
  return !scene.media.empty();
}

// About the film's upward direction, around `pivot`.
void turn(scene::Camera& camera, const Point3& pivot, double angle) {
  const Mat3 turned = Eigen::AngleAxisd(angle, camera.up).toRotationMatrix();
  camera.position = pivot + turned * (camera.position - pivot);
  camera.forward = turned * camera.forward;
  camera.right = turned * camera.right;
}

bool move_camera(Scene& scene, double angle) {
  if (!scene.backdrops.empty()) return false;  // they are for one camera
  Box media;
  for (const scene::Medium& medium : scene.media) {
    const Box box = bounding_box(medium);
    if (!box.empty()) media = unite(media, box);
  }
  const bool finite = !media.empty() && media.size().allFinite();
  turn(scene.camera, finite ? media.center() : scene.camera.position, angle);
  return true;
}

const scene::Choices<Moving::What> kinds = {{"camera", Moving::What::camera},
                                            {"lights", Moving::What::lights},
                                            {"media", Moving::What::media},
                                            {"fog", Moving::What::fog},
                                            {"coefficients", Moving::What::coefficients}};

void bind(scene::SettingBinder& b, Moving& m) {
  b.choice("what", m.what, kinds, "what differs from frame to frame");
  b.integer("frames", m.frames, 2, 1000, "frames, of which the last is judged");
  b.real("turn", m.turn, 0, 1, "angle by which a camera turns from frame to frame [rad]").where("what", {"camera"});
}

// One frame back. False if the scene has nothing that moves so.
bool move(Scene& scene, const Moving& moving) {
  switch (moving.what) {
    case Moving::What::camera:
      return move_camera(scene, -moving.turn);
    case Moving::What::lights:
      return move_lights(scene);
    case Moving::What::media:
      return move_media(scene);
    case Moving::What::fog:
      return move_fog(scene);
    case Moving::What::coefficients:
      return thin_fog(scene);
  }
  return false;
}

}  // namespace

void turn_lights(Scene& scene, double angle) {
  for (scene::Light& light : scene.lights) {
    light = scene::turned(light, angle);
    if (auto* sun = std::get_if<scene::DirectionalLight>(&light))
      sun->to_light = Eigen::AngleAxisd(angle, Vec3::UnitY()) * sun->to_light;
  }
}

std::string name_of(Moving::What what) {
  for (const auto& [name, kind] : kinds)
    if (kind == what) return name;
  return "";
}

Moving read_moving(const std::map<std::string, std::string>& given, const std::string& where) {
  return scene::read_settings(bind, scene::Settings(scene::list_settings(bind), given, where));
}

std::string canonical(const Moving& m) {
  return fmt::format("{} {}{}", name_of(m.what), m.frames,
                     m.what == Moving::What::camera ? fmt::format(" {}", m.turn) : "");
}

namespace {

std::shared_ptr<const Scene> moved_by_all(const Scene& scene, const std::vector<Moving>& all) {
  auto before = std::make_shared<Scene>(scene);
  for (const Moving& moving : all)
    if (!move(*before, moving)) return nullptr;
  finish(*before);
  before->geometry = scene.geometry;  // surfaces stay, and preparations tell them by it
  return before;
}

}  // namespace

std::shared_ptr<const Scene> moved_back(const Scene& scene, const Moving& moving) {
  return moved_by_all(scene, {moving});
}

std::shared_ptr<const Scene> all_moved_back(const Scene& scene, const std::vector<Moving::What>& what) {
  std::vector<Moving> all;
  for (const Moving::What each : what) all.push_back({each});
  return moved_by_all(scene, all);
}

NextFrames::NextFrames(std::shared_ptr<scene::Prepared> prepared, SharedScene here, const Moving& moving)
    : prepared_(std::move(prepared)), moving_(moving), path_{std::move(here)} {
  while (path_.size() < std::size_t(moving.frames)) {
    path_.push_back(moved_back(*path_.back(), moving));
    if (!path_.back())
      throw scene::NotSupported("", fmt::format("the scene has no {} that could move", name_of(moving.what)));
  }
  std::reverse(path_.begin(), path_.end());
  here_ = path_.size() - 1;
}

scene::Rendering NextFrames::render(const scene::View& view, const scene::Execution& execution) {
  scene::Rendering last;
  for (here_ = 0; here_ < path_.size(); ++here_) last = one(path_[here_], view, execution);
  --here_;
  return last;
}

std::vector<scene::StageTime> NextFrames::again(const scene::View& view, const scene::Execution& execution) {
  here_ = here_ + 1 < path_.size() ? here_ + 1 : here_ - 1;
  return one(path_[here_], view, execution).times;
}

scene::Rendering NextFrames::one(const SharedScene& at, scene::View view, const scene::Execution& execution) {
  const bool camera = moving_.what == Moving::What::camera;
  auto times = prepared_->next(at, execution);
  if (!times && !camera)
    throw scene::NotSupported("",
                              fmt::format("its {} cannot move: every frame is prepared anew", name_of(moving_.what)));
  if (camera) view.camera = at->camera;
  scene::Rendering rendering = prepared_->render(view, execution);
  if (!times) return rendering;
  times->insert(times->end(), rendering.times.begin(), rendering.times.end());
  rendering.times = std::move(*times);
  return rendering;
}

FramesAfter::FramesAfter(const scene::Renderer& renderer, scene::Settings settings, std::shared_ptr<const Scene> here,
                         std::unique_ptr<scene::Prepared> prepared)
    : renderer_(renderer),
      settings_(std::move(settings)),
      here_(std::move(here)),
      now_(here_),
      other_(here_),
      prepared_(std::move(prepared)) {}

void FramesAfter::go_to(std::shared_ptr<const Scene> other, const scene::View& view,
                        const scene::Execution& execution) {
  if (now_ != here_) one(view, execution);
  other_ = std::move(other);
  anew_ = false;
}

double FramesAfter::one(scene::View view, const scene::Execution& execution) {
  std::swap(now_, other_);
  const double start = steady_seconds();
  // A preparation without next() is equal for every camera.
  const bool camera_alone = now_->matter_hash == other_->matter_hash && now_->light_hash == other_->light_hash;
  if (!prepared_->next(now_, execution) && !camera_alone) {
    prepared_ = renderer_.prepare(now_, settings_, execution);
    anew_ = true;
  }
  view.camera.position = now_->camera.position;
  view.camera.forward = now_->camera.forward;
  view.camera.right = now_->camera.right;
  view.camera.up = now_->camera.up;
  prepared_->render(view, execution);
  return steady_seconds() - start;
}

std::vector<double> FramesAfter::some(const scene::View& view, const scene::Execution& execution, double budget,
                                      std::size_t least) {
  std::vector<double> times;
  for (double spent = 0; times.size() < least + 1 || (times.size() < 6 && spent + times.back() < budget);
       spent += times.back())
    times.push_back(one(view, execution));
  times.erase(times.begin());
  return times;
}

std::optional<FrameAfter> frame_after(Moving::What what, const scene::Renderer& renderer,
                                      const scene::Settings& settings, const std::shared_ptr<const Scene>& here,
                                      const scene::View& view, const scene::Execution& execution, double budget) {
  const std::shared_ptr<const Scene> other = moved_back(*here, {what});
  if (!other || !renderer.supports(*other, settings).empty()) return {};
  std::unique_ptr<scene::Prepared> prepared = renderer.prepare(here, settings, execution);
  prepared->render(view, execution);
  FramesAfter frames(renderer, settings, here, std::move(prepared));
  frames.go_to(other, view, execution);
  const double seconds = median(frames.some(view, execution, budget));
  return FrameAfter{seconds, frames.anew()};
}

}  // namespace airlight::experiments
