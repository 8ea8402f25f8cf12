// What tests of `airlight serve` ask for, and how they read what they get.
#pragma once
#include <cmath>
#include <cstring>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/application/renderers.h"
#include "experiments/serve/requests.h"
#include "tests/texts.h"

namespace airlight::test {

using experiments::serve::FrameRequest;
using nlohmann::json;

struct Answer {
  json head;
  int width = 0, height = 0;
  std::vector<float> values;
};

inline float from_half(std::uint16_t h) {
  const int exponent = (h >> 10) & 31, fraction = h & 1023;
  const float size =
      exponent == 0 ? std::ldexp(float(fraction), -24) : std::ldexp(1 + fraction / 1024.0f, exponent - 15);
  return h & 0x8000 ? -size : size;
}

inline Answer unpacked(const std::string& bytes) {
  std::uint32_t length = 0;
  REQUIRE(bytes.size() >= 4);
  std::memcpy(&length, bytes.data(), 4);
  REQUIRE(length % 2 == 0);
  Answer answer;
  answer.head = experiments::parse_json(bytes.substr(4, length), "answer");
  if (!answer.head.contains("width")) return answer;
  answer.width = answer.head["width"];
  answer.height = answer.head["height"];
  for (std::size_t at = 4 + length; at < bytes.size(); at += 2) {
    std::uint16_t half = 0;
    std::memcpy(&half, &bytes[at], 2);
    answer.values.push_back(from_half(half) * answer.head["scale"].get<float>());
  }
  REQUIRE(answer.values.size() == 3u * unsigned(answer.width * answer.height));
  return answer;
}

inline FrameRequest request_of(const std::string& method, int width = 24, int height = 18) {
  FrameRequest request;
  request.client = "c";
  request.pane = "left";
  request.method = method;
  request.width = width;
  request.height = height;
  return request;
}

inline json body_of(const FrameRequest& r) {
  return {{"client", r.client}, {"scene", r.scene},   {"values", json::object()},
          {"pane", r.pane},     {"method", r.method}, {"settings", r.settings},
          {"width", r.width},   {"height", r.height}, {"layer", r.layer}};
}

inline scene::Film rendered(const std::string& file, const FrameRequest& r, const scene::Overrides& more = {}) {
  scene::Overrides all = r.values;
  all.insert(more.begin(), more.end());
  all["film.width"] = std::to_string(r.width);
  all["film.height"] = std::to_string(r.height);
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(file, all));
  const scene::Renderer& renderer = experiments::find_renderer(r.method, "test");
  return renderer.prepare(scene, scene::Settings(renderer.settings(), r.settings, "test"), {})
      ->render(scene::view_of(*scene), {})
      .film;
}

// Greatest difference, relative to the greatest value.
inline double difference(const std::vector<float>& a, const std::vector<float>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0, scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(double(a[i]) - b[i]));
    scale = std::max(scale, std::abs(double(b[i])));
  }
  return most / scale;
}

}  // namespace airlight::test
