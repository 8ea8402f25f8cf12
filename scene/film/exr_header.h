// The header of an OpenEXR file before OpenEXR reads it, and the names of its channels.
#pragma once
#include <OpenEXR/ImfForward.h>

#include <string>

namespace airlight::scene {

// Walks the attributes (name, type, size, value): OpenEXR would allocate any size it is told. Throws Error, one line: no
// such file, no EXR, truncated, damaged, deep or multi-part.
void check_exr_attributes(const std::string& path);

// Throws Error where the file holds a part of the picture only, or more than it: rows and columns would be others.
void check_windows(const std::string& path, const Imf::Header&);

// Six faces below one another; a file that read_exr can read.
bool is_cube_map(const std::string& path);

// Channel 'R', 'G' or 'B' of a layer: "R" for the layer mean, "LAYER.R" for any other.
inline std::string channel_name(const std::string& layer, char letter) {
  return layer == "mean" ? std::string(1, letter) : layer + "." + letter;
}

}  // namespace airlight::scene
