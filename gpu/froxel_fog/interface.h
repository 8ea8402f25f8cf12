// Constants and layouts shared by host and shaders of froxel fog.
#pragma once
#include <map>
#include <string>

#include "gpu/program.h"

namespace airlight::gpu::froxel_fog {

// Storage blocks, AT_... in shaders, beside those of the media (0 to 4, 9, 14), of rounds (13) and of pixels (6), which
// ray_marcher/interface.h numbers. Blocks that no shader uses together share a number.
namespace at {
enum Binding {
  light = 5,
  media = 6,
  slices = 7,
  ends = 8,
  frames = 10,
  totals = 11,
  history_light = 12,
  history_media = 15,
  // fit.comp, slices.comp
  fitted = 8,
  history_slices = 12,
  // filter.comp
  filtered_light = 7,
  filtered_media = 8,
  // integrate.comp, picture.comp
  airlight = 8,
  transmittance = 10,
  distances = 5,
};
}  // namespace at

Program& program(Context&, const std::string& file, std::map<std::string, std::string> definitions);

}  // namespace airlight::gpu::froxel_fog
