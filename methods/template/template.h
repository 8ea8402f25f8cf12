#pragma once
#include "scene/renderer.h"

namespace airlight::template_method {

std::unique_ptr<scene::Renderer> make_renderer();

}  // namespace airlight::template_method
