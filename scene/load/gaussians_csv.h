// Tables of Gaussians, as media of type "gaussians" name them.
#pragma once
#include <string>
#include <vector>

#include "scene/media/gaussian_sum.h"

namespace airlight::scene {

// No cutoff, no constant. Ids of the Gaussians into `ids`, if the table has some; else that is empty. Throws Error, with file, line and
// column.
GaussianSum read_gaussians_csv(const std::string& path, std::vector<int>* ids = nullptr);

}  // namespace airlight::scene
