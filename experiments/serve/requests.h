// What a browser asks for: JSON, checked strictly. Every function throws BadRequest, one line, for anything that is not as it must be.
#pragma once
#include <map>
#include <optional>
#include <string>

#include "experiments/serve/live_flow.h"
#include "scene/base/error.h"
#include "scene/scene.h"

namespace airlight::experiments::serve {

struct BadRequest : Error {
  using Error::Error;
};

// Which scene, and its changed values as TOML texts.
struct SceneRequest {
  std::string client;  // a name that the page makes up: 1 to 40 letters, digits, "-" and "_"
  int scene = 0;
  scene::Overrides values;
};

inline constexpr int least_side = 8, greatest_side = 2048;  // of a film [pixels]
inline constexpr int most_pixels = 1 << 20;

struct FrameRequest : SceneRequest {
  std::string pane;  // "left" or "right": a newer request of a client's pane replaces an older one
  std::string method;
  std::map<std::string, std::string> settings;
  int width = 0, height = 0;
  std::string layer = "mean";
};

struct ReferenceRequest : SceneRequest {
  int width = 0, height = 0;
  bool all_orders = true;  // else one
  long long known = -1;    // number of the picture that the browser has; it gets no other until there is one
};

struct FlowRequest {
  long long known = -1;  // number of the smoke that the browser has; the answer waits a while for another one
  std::optional<FlowOrder> order = {};
  std::optional<double> pace = {};
};

SceneRequest read_scene_request(const std::string& body, int scenes);
FrameRequest read_frame_request(const std::string& body, int scenes);
ReferenceRequest read_reference_request(const std::string& body, int scenes);
std::string read_client(const std::string& body);  // a request that names a client and nothing else
FlowRequest read_flow_request(const std::string& body);
Stroke read_stroke(const std::string& body);

}  // namespace airlight::experiments::serve
