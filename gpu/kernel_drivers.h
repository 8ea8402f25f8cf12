// Kernel drivers of graphics hardware that no EGL device serves: why a machine with a GPU may look like one without.
#pragma once
#include <string>
#include <vector>

#include "gpu/egl.h"

namespace airlight::gpu {

// A line for each kernel driver that is there although none of the attempts has reached its hardware, and what is most
// likely missing. `root` stands for "/".
std::vector<std::string> drivers_without_egl(const std::vector<Attempt>&, const std::string& root = "/");

}  // namespace airlight::gpu
