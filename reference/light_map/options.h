// Settings of a map of the light.
#pragma once
#include <string>

#include "scene/base/settings.h"

namespace airlight::light_map {

enum class Encoding { slices, avsm, fourier, beer };

struct Options {
  int size = 256;   // texels a side
  int steps = 128;  // along the ray of a texel
  Encoding encoding = Encoding::slices;
  int slices = 32;        // of `slices`: stored are the optical depths at so many + 1 distances
  int nodes = 8;          // of `avsm`
  int coefficients = 15;  // of `fourier`: odd, a_0 and pairs
};

constexpr int most_size = 4096, most_steps = 4096, most_slices = 1024, most_nodes = 64, most_coefficients = 63;

std::string encoding_name(Encoding);
// Number of floats that store one channel of optical depth.
int floats_per_texel(const Options&);
// Texels with the border of one texel that interpolation reads.
double bytes_per_plane(const Options&);

// Lists and reads the settings map_encoding, map_size, ... of a renderer, which reads them where `setting` is "map".
void bind(scene::SettingBinder&, Options&, const std::string& setting);

// Why a map with these options cannot be made; empty if it can.
std::string unsupported(const Options&);

}  // namespace airlight::light_map
