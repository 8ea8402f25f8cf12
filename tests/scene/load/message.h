// Error message of loading a scene.
#pragma once
#include <catch2/catch.hpp>
#include <string>

#include "scene/base/error.h"
#include "scene/scene.h"
#include "tests/texts.h"

namespace airlight::test {

// Three lines: what follows begins on line 4.
inline const std::string camera = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";

// Empty if the text loads. Relative names of its files are those of `folder`.
inline std::string message(const std::string& text, const std::string& folder = "") {
  return test::message_of([&] { scene::parse_scene(text, "s.toml", folder); });
}

}  // namespace airlight::test
