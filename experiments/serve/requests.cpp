#include "experiments/serve/requests.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/serve/scene_source.h"
#include "scene/base/nearest.h"
#include "scene/base/printable.h"

namespace airlight::experiments::serve {
namespace {

using nlohmann::json;

constexpr std::size_t most_values = 200, most_text = 100;

// An object of which every key must be read.
class Fields {
 public:
  explicit Fields(const std::string& body) {
    try {
      object_ = parse_json(body, "request");
    } catch (const Error& error) {
      throw BadRequest(error.what());
    }
    if (!object_.is_object()) throw BadRequest("request: expected an object");
  }

  bool has(const std::string& key) {
    keys_.push_back(key);
    return object_.contains(key);
  }
  const json& at(const std::string& key) {
    if (!has(key)) throw BadRequest(fmt::format("request: '{}' is missing", key));
    return object_[key];
  }
  std::string word(const std::string& key, const std::string& extra, std::size_t most) {
    const json& value = at(key);
    const auto fits = [&](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             extra.find(c) != std::string::npos;
    };
    if (value.is_string()) {
      const std::string& text = value.get_ref<const std::string&>();
      if (!text.empty() && text.size() <= most && std::all_of(text.begin(), text.end(), fits)) return text;
    }
    throw BadRequest(fmt::format("request: {} = {}, expected 1 to {} letters or digits", key, shown(value), most));
  }
  std::string one_of(const std::string& key, const std::vector<std::string>& choices) {
    const json& value = at(key);
    for (const std::string& choice : choices)
      if (value == choice) return choice;
    throw BadRequest(fmt::format("request: {} = {}, expected one of {}", key, shown(value), fmt::join(choices, ", ")));
  }
  long long integer(const std::string& key, long long least, long long greatest) {
    const json& value = at(key);
    if (value.is_number_unsigned() ? value.get<std::uint64_t>() <= std::uint64_t(std::max(greatest, 0LL))
                                   : value.is_number_integer())
      if (const auto number = value.get<long long>(); number >= least && number <= greatest) return number;
    throw BadRequest(
        fmt::format("request: {} = {}, expected an integer from {} to {}", key, shown(value), least, greatest));
  }
  double number(const std::string& key, double least, double greatest) {
    const json& value = at(key);
    if (value.is_number())
      if (const double number = value.get<double>(); number >= least && number <= greatest) return number;
    throw BadRequest(
        fmt::format("request: {} = {}, expected a number from {:g} to {:g}", key, shown(value), least, greatest));
  }
  Point3 point(const std::string& key) {
    const json& value = at(key);
    Point3 point;
    bool good = value.is_array() && value.size() == 3;
    for (int i = 0; good && i < 3; ++i) {
      good = value[std::size_t(i)].is_number();
      if (good) point[i] = value[std::size_t(i)].get<double>();
    }
    if (!good || !point.allFinite())
      throw BadRequest(fmt::format("request: {} = {}, expected three numbers", key, shown(value)));
    return point;
  }
  // An object of few values.
  const json& table(const std::string& key) {
    const json& value = at(key);
    if (!value.is_object() || value.size() > most_values)
      throw BadRequest(fmt::format("request: {} = {}, expected an object", key, shown(value)));
    return value;
  }
  // At the end: every key was asked for.
  void done() const {
    for (const auto& [key, value] : object_.items())
      if (std::find(keys_.begin(), keys_.end(), key) == keys_.end())
        throw BadRequest(fmt::format("request: unknown key '{}'{}", scene::printable(key, most_text),
                                     scene::nearest_hint(scene::printable(key, most_text), keys_)));
  }

  static std::string shown(const json& value) {
    return scene::printable(value.dump(-1, ' ', false, json::error_handler_t::replace), most_text);
  }

 private:
  json object_;
  std::vector<std::string> keys_;
};

std::string number_text(const json& value, const std::string& path) {
  if (value.is_number_integer()) return value.dump();
  if (value.is_number_float() && std::isfinite(value.get<double>())) return fmt::format("{}", value.get<double>());
  throw BadRequest(fmt::format("request: {} = {}, expected numbers", path, Fields::shown(value)));
}

// A number, a list of three, or { type = "hg", g = 0.5 } and { axis = [0, 1, 0], angle = 1 }.
std::string toml_text(const json& value, const std::string& path) {
  if (value.is_array()) {
    if (value.size() != 3)
      throw BadRequest(fmt::format("request: {} = {}, expected three numbers", path, Fields::shown(value)));
    return fmt::format("[{}, {}, {}]", number_text(value[0], path), number_text(value[1], path),
                       number_text(value[2], path));
  }
  if (!value.is_object()) return number_text(value, path);
  std::vector<std::string> parts;
  for (const auto& [key, part] : value.items()) {
    if (key == "type") {
      if (part != "hg" && part != "isotropic" && part != "rayleigh")
        throw BadRequest(
            fmt::format("request: {}.type = {}, expected hg, isotropic or rayleigh", path, Fields::shown(part)));
      parts.push_back(fmt::format("type = \"{}\"", part.get<std::string>()));
    } else if ((key == "g" || key == "angle" || key == "axis") && !part.is_object()) {
      parts.push_back(fmt::format("{} = {}", key, toml_text(part, path + "." + key)));
    } else {
      throw BadRequest(
          fmt::format("request: {} has '{}', expected type, g, axis or angle", path, scene::printable(key, most_text)));
    }
  }
  return fmt::format("{{ {} }}", fmt::join(parts, ", "));
}

void read_scene(Fields& fields, int scenes, SceneRequest& request) {
  request.client = fields.word("client", "-_", 40);
  request.scene = int(fields.integer("scene", 0, scenes - 1));
  for (const auto& [path, value] : fields.table("values").items()) {
    if (!may_change(path))
      throw BadRequest(fmt::format("request: '{}' cannot be changed, expected a value of camera, light or medium",
                                   scene::printable(path, most_text)));
    request.values[path] = toml_text(value, path);
  }
}

std::pair<int, int> read_film(Fields& fields) {
  const int width = int(fields.integer("width", least_side, greatest_side));
  const int height = int(fields.integer("height", least_side, greatest_side));
  if (width * height > most_pixels)
    throw BadRequest(
        fmt::format("request: a film of {} x {} pixels, expected at most {} of them", width, height, most_pixels));
  return {width, height};
}

}  // namespace

SceneRequest read_scene_request(const std::string& body, int scenes) {
  Fields fields(body);
  SceneRequest request;
  read_scene(fields, scenes, request);
  fields.done();
  return request;
}

FrameRequest read_frame_request(const std::string& body, int scenes) {
  Fields fields(body);
  FrameRequest request;
  read_scene(fields, scenes, request);
  request.pane = fields.one_of("pane", {"left", "right"});
  request.method = fields.word("method", "_", 60);
  for (const auto& [name, value] : fields.table("settings").items()) {
    const std::string where = "settings." + scene::printable(name, most_text);
    if (value.is_boolean())
      request.settings[name] = value.get<bool>() ? "true" : "false";
    else if (value.is_string() && value.get_ref<const std::string&>().size() <= most_text)
      request.settings[name] = value.get<std::string>();
    else
      request.settings[name] = number_text(value, where);
  }
  std::tie(request.width, request.height) = read_film(fields);
  request.layer = fields.one_of("layer", {"mean", "airlight", "surface", "ambient", "transmittance"});
  fields.done();
  return request;
}

ReferenceRequest read_reference_request(const std::string& body, int scenes) {
  Fields fields(body);
  ReferenceRequest request;
  read_scene(fields, scenes, request);
  std::tie(request.width, request.height) = read_film(fields);
  request.all_orders = fields.one_of("orders", {"all", "one"}) == "all";
  request.known = fields.integer("known", -1, 1LL << 50);
  fields.done();
  return request;
}

std::string read_client(const std::string& body) {
  Fields fields(body);
  std::string client = fields.word("client", "-_", 40);
  fields.done();
  return client;
}

FlowRequest read_flow_request(const std::string& body) {
  static const std::vector<std::string> orders{"play", "pause", "step", "reset", "replay"};  // as FlowOrder
  Fields fields(body);
  FlowRequest request;
  fields.word("client", "-_", 40);
  request.known = fields.integer("known", -1, 1LL << 50);
  if (fields.has("order")) {
    const std::string order = fields.one_of("order", orders);
    request.order = FlowOrder(std::find(orders.begin(), orders.end(), order) - orders.begin());
  }
  if (fields.has("pace")) request.pace = fields.number("pace", 0, 1e6);
  fields.done();
  return request;
}

Stroke read_stroke(const std::string& body) {
  Fields fields(body);
  Stroke stroke;
  fields.word("client", "-_", 40);
  stroke.from = fields.point("from");
  stroke.to = fields.point("to");
  stroke.radius = fields.number("radius", 0, 1e9);
  stroke.speed = fields.number("speed", 0, 1e6);
  fields.done();
  return stroke;
}

}  // namespace airlight::experiments::serve
