// What browsers get: JSON, and pictures as half floats behind it.
#pragma once
#include <string>

#include "experiments/serve/studio.h"

namespace airlight::experiments::serve {

// A picture is a 32-bit length (little-endian), that many bytes of JSON (of even length), and RGB half floats, row 0 at the top. Its JSON has
// the film's `width`, `height` and a `scale`: a value is the half float times the scale, a power of two, so that no value overflows.
std::string picture_bytes(const std::string& json, const scene::Film&, const std::string& layer, double scale);
// The power of two that brings the greatest finite value of a layer to [2^14, 2^15).
double scale_of(const scene::Film&, const std::string& layer);

// The files, by name, and the flow, if there is one.
std::string list_of_scenes(Studio&);
// The camera, lights and media of a scene, and what can render it: settings, or the reason why not. `flows`: a flow gives the smoke.
std::string scene_answer(const SceneSource&, const scene::Scene&, bool flows = false);
// With its picture, if there is one.
std::string frame_answer(const std::optional<Frame>&, const FrameRequest&);
std::string reference_answer(const ReferenceState&);
std::string flow_answer(const FlowState&);

}  // namespace airlight::experiments::serve
