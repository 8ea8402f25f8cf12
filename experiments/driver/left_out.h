#pragma once
#include <string>
#include <vector>

#include "scene/renderer.h"

namespace airlight::experiments {

// Parts of the light that the method leaves out by its own account, in short: "orders of scattering
// above one". Empty if it names none.
std::string left_out(const std::vector<scene::Stage>&);

}  // namespace airlight::experiments
