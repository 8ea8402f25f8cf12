// Everything that can render a scene: references and methods. A new method joins the list in renderers.cpp.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "scene/renderer.h"

namespace airlight::experiments {

const std::vector<std::unique_ptr<scene::Renderer>>& all_renderers();

// While it lives, the program has one renderer more: a method that is not in the list. Not thread safe.
class AddedRenderer {
 public:
  explicit AddedRenderer(std::unique_ptr<scene::Renderer>);
  ~AddedRenderer();
  AddedRenderer(const AddedRenderer&) = delete;
  AddedRenderer& operator=(const AddedRenderer&) = delete;

 private:
  const scene::Renderer* renderer_;
};

std::vector<std::string> renderer_names();

// Key of the program's own file if the renderer was added, since build_info.h does not know its sources; else empty.
std::string added_code(const std::string& renderer);

// Whether the renderer belongs to the folder reference/, which is built from scene/ and reference/ alone.
bool is_reference(const scene::Renderer&);

// Throws Error, beginning with `where`, that names the nearest renderer.
const scene::Renderer& find_renderer(const std::string& name, const std::string& where);

}  // namespace airlight::experiments
