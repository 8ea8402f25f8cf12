// Constants and layouts shared by host and shaders of light maps.
#pragma once
#include <map>
#include <string>

#include "gpu/program.h"

namespace airlight::gpu::light_map {

// Storage blocks of what makes a map, AT_... in shaders, beside those of the media (ray_marcher/interface.h); `parts` is a uniform
// block. Where look-ups find the maps is the matter of ray_marcher/interface.h.
namespace at {
enum Binding { parts = 1, steps = 4, texels = 5, nodes = 6, waves = 7 };
}  // namespace at

// A program with these bindings and those of the media defined.
Program& program(Context&, const std::string& file, std::map<std::string, std::string> definitions);

}  // namespace airlight::gpu::light_map
