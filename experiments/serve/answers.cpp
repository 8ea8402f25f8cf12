#include "experiments/serve/answers.h"

#include <fmt/format.h>
#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "experiments/application/json_value.h"
#include "experiments/application/renderers.h"
#include "gpu/context.h"
#include "scene/base/printable.h"
#include "scene/base/settings.h"

namespace airlight::experiments::serve {
namespace {

using nlohmann::json;

json list(const Rgb& c) { return {c[0], c[1], c[2]}; }
json list(const Vec3& v) { return {v[0], v[1], v[2]}; }

json bound(double value) { return std::abs(value) < 1e300 ? json(value) : json(nullptr); }

json setting_json(const scene::SettingSpec& spec) {
  using Type = scene::SettingSpec::Type;
  json j{{"name", spec.name}, {"default", spec.fallback}, {"help", spec.doc}};
  switch (spec.type) {
    case Type::integer:
    case Type::real:
      j["type"] = spec.type == Type::integer ? "integer" : "real";
      j["least"] = bound(spec.least);
      j["greatest"] = bound(spec.greatest);
      break;
    case Type::flag:
      j["type"] = "flag";
      break;
    case Type::choice:
      j["type"] = "choice";
      j["choices"] = spec.choices;
      break;
  }
  if (const std::string condition = scene::read_condition(spec); !condition.empty()) {
    j["condition"] = condition;
    j["read_where"] = spec.read_where;
  }
  return j;
}

// Empty: the renderer can render the scene, with its defaults.
std::string refusal(const scene::Renderer& renderer, const scene::Scene& scene) {
  try {
    if (!renderer.device().empty()) gpu::Context::get();  // throws where there is none
    const auto reasons = renderer.supports(scene, scene::Settings(renderer.settings(), {}, renderer.name()));
    return reasons.empty() ? "" : reasons.front();
  } catch (const Unavailable& error) {
    return fmt::format("not available on this machine: {}", error.what());
  }
}

json light_json(const scene::Light& light) {
  json j{{"type", scene::light_name(light)}};
  scene::match(
      light,
      [&](const scene::PointLight& point) {
        j["position"] = list(point.position);
        j["intensity"] = list(point.intensity);
      },
      [&](const scene::SpotLight& spot) {
        j["position"] = list(spot.position);
        j["intensity"] = list(spot.intensity);
      },
      [&](const scene::DirectionalLight& sun) {
        j["to_light"] = list(sun.to_light);
        j["irradiance"] = list(sun.irradiance);
      },
      [&](const scene::EnvironmentLight& sky) {
        const bool constant = !sky.map && sky.sh.empty();
        j[constant ? "radiance" : "scale"] = list(sky.scale);
        const Mat3 turned = sky.to_map.transpose();
        if (!constant && turned(1, 1) > 1 - 1e-12) j["turn"] = std::atan2(turned(0, 2), turned(2, 2));
      });
  return j;
}

json medium_json(const std::vector<scene::Medium>& media, std::size_t i) {
  const scene::Medium& medium = media[i];
  json j{{"label", scene::printable(scene::label(media, i))},
         {"type", scene::field_name(medium.field)},
         {"sigma_t", list(medium.sigma_t)},
         {"albedo", list(medium.albedo)},
         {"phase", scene::phase_name(medium.phase)}};
  if (const auto* hg = std::get_if<scene::HenyeyGreenstein>(&medium.phase)) j["g"] = hg->g;
  if (std::holds_alternative<scene::Isotropic>(medium.phase)) j["g"] = 0;
  return j;
}

json times_json(const std::vector<scene::StageTime>& times) {
  json j = json::array();
  for (const auto& [name, seconds] : times) j.push_back({{"name", name}, {"seconds", seconds}});
  return j;
}

// Invalid UTF-8 in names of files becomes a mark instead of an exception.
std::string text_of(const json& j) { return j.dump(-1, ' ', false, json::error_handler_t::replace); }

}  // namespace

namespace {

std::string without_picture(const json& j) {
  scene::Film empty;
  empty.add("mean");
  return picture_bytes(text_of(j), empty, "mean", 1);
}

}  // namespace

double scale_of(const scene::Film& film, const std::string& layer) {
  float greatest = 0;
  for (const float value : film.layer(layer))
    if (std::isfinite(value)) greatest = std::max(greatest, std::abs(value));
  if (greatest == 0) return 1;
  return std::exp2(std::clamp(std::ilogb(greatest) - 14, -120, 120));
}

std::string picture_bytes(const std::string& json_text, const scene::Film& film, const std::string& layer,
                          double scale) {
  const std::vector<float>& values = film.layer(layer);
  const std::string head = json_text.size() % 2 == 0 ? json_text : json_text + " ";
  const auto length = std::uint32_t(head.size());
  std::string bytes(4 + head.size() + 2 * values.size(), '\0');
  for (int i = 0; i < 4; ++i) bytes[std::size_t(i)] = char(length >> (8 * i) & 255);
  std::memcpy(&bytes[4], head.data(), head.size());
  char* out = bytes.data() + 4 + head.size();
  const auto factor = float(1 / scale);
  for (std::size_t i = 0; i < values.size(); i += 8) {
    float eight[8] = {};
    const std::size_t count = std::min<std::size_t>(8, values.size() - i);
    for (std::size_t k = 0; k < count; ++k) eight[k] = values[i + k] * factor;
    alignas(16) std::uint16_t halves[8];
    _mm_store_si128(reinterpret_cast<__m128i*>(halves), _mm256_cvtps_ph(_mm256_loadu_ps(eight), 0));
    std::memcpy(out + 2 * i, halves, 2 * count);
  }
  return bytes;
}

std::string list_of_scenes(Studio& studio) {
  json j{{"scenes", json::array()}};
  for (const std::string& file : studio.files()) j["scenes"].push_back(scene::printable(file));
  if (studio.has_flow()) {
    const LiveFlow& flow = studio.flow();
    const scene::FlowProblem& problem = flow.problem();
    j["flow"] = {{"name", scene::printable(problem.name)},
                 {"method", flow.choice().method},
                 {"lo", list(problem.box.lo)},
                 {"hi", list(problem.box.hi)},
                 {"duration", problem.duration},
                 {"dt", flow.dt()}};
  }
  return text_of(j);
}

std::string scene_answer(const SceneSource& source, const scene::Scene& scene, bool flows) {
  const scene::Camera& camera = scene.camera;
  json j{{"name", scene::printable(scene.name)},
         {"file", scene::printable(source.file())},
         {"film", {{"width", scene.width}, {"height", scene.height}}},
         {"lights", json::array()},
         {"media", json::array()},
         {"methods", json::array()}};
  const bool perspective = camera.kind == scene::Camera::Kind::perspective;
  j["camera"] = {{"position", list(camera.position)},
                 {"look_at", list(source.look_at())},
                 {"up", list(source.up())},
                 {"type", perspective ? "perspective" : "orthographic"},
                 {perspective ? "vertical_fov" : "height", perspective ? camera.vertical_fov : camera.height}};
  if (!scene.backdrops.empty()) j["camera"]["fixed"] = "a backdrop or particles are drawn for this camera alone";
  for (const scene::Light& light : scene.lights) j["lights"].push_back(light_json(light));
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    j["media"].push_back(medium_json(scene.media, i));
    if (const auto frames = source.frames(i); frames && !flows)
      j["media"].back()["frames"] = {frames->first, frames->second, source.frame(i)};
  }
  for (const auto& renderer : all_renderers()) {
    json method{{"name", renderer->name()},
                {"about", renderer->about()},
                {"refused", refusal(*renderer, scene)},
                {"monte_carlo", renderer->monte_carlo()},
                {"settings", json::array()}};
    for (const scene::SettingSpec& spec : renderer->settings()) method["settings"].push_back(setting_json(spec));
    j["methods"].push_back(std::move(method));
  }
  return text_of(j);
}

std::string frame_answer(const std::optional<Frame>& frame, const FrameRequest& request) {
  if (!frame) return without_picture({{"dropped", true}});
  json j{{"method", request.method}, {"layer", request.layer}};
  if (!frame->film) {
    j["refused"] = scene::printable(frame->refused);
    return without_picture(j);
  }
  const double scale = scale_of(*frame->film, request.layer);
  j["width"] = frame->film->width;
  j["height"] = frame->film->height;
  j["scale"] = scale;
  if (frame->smoke_time) j["smoke_time"] = *frame->smoke_time;
  j["waited"] = frame->waited;
  j["seconds"] = frame->seconds;
  j["prepared"] = frame->prepared;
  j["median"] = {{"seconds", frame->median}, {"frames", frame->median_frames}};
  j["times"] = times_json(frame->times);
  j["stages"] = json::array();
  for (const scene::Stage& stage : frame->stages)
    j["stages"].push_back({{"name", stage.name}, {"kept", stage.kept}, {"reason", stage.reason}});
  j["counters"] = frame->counters;
  if (const auto warning = frame->film->metadata.find("warning"); warning != frame->film->metadata.end())
    j["warning"] = scene::printable(warning->second);
  return picture_bytes(text_of(j), *frame->film, request.layer, scale);
}

std::string reference_answer(const ReferenceState& state) {
  json j{{"number", state.number},
         {"samples", state.samples},
         {"growing", state.growing},
         {"about", state.about},
         {"errors", json::object()}};
  if (!state.missing.empty()) j["missing"] = scene::printable(state.missing);
  if (state.progress >= 0) j["progress"] = state.progress;
  for (const auto& [pane, error] : state.errors) {
    if (!error.missing.empty()) {
      j["errors"][pane] = {{"missing", error.missing}};
      continue;
    }
    const Measure& m = error.measure;
    j["errors"][pane] = {
        {"value", m.value}, {"low", m.low}, {"high", m.high}, {"floor", m.floor}, {"below_floor", m.below_floor}};
  }
  if (!state.film) return without_picture(j);
  const double scale = scale_of(*state.film, "mean");
  j["width"] = state.film->width;
  j["height"] = state.film->height;
  j["scale"] = scale;
  return picture_bytes(text_of(j), *state.film, "mean", scale);
}

std::string flow_answer(const FlowState& state) {
  json j{{"number", state.number},   {"steps", state.steps}, {"time", state.time},
         {"playing", state.playing}, {"pace", state.pace},   {"step_seconds", state.step_seconds},
         {"strokes", state.strokes}};
  if (!state.message.empty()) j["message"] = scene::printable(state.message);
  return text_of(j);
}

}  // namespace airlight::experiments::serve
