// Images of one number per pixel: maps of fog, of heights.
#pragma once
#include <string>
#include <vector>

namespace airlight::scene {

struct GreyImage {
  int width = 0, height = 0;
  std::vector<double>
      values;        // row 0 is the file's first; linear: v / 255 or v / 65535 of a PNG, as they are of an EXR
  std::string note;  // what was passed over, one line: "its alpha channel is ignored"; empty if nothing
};

// PNG: grey, 8 or 16 bits (fewer are spread to 8), or colour where R = G = B in every pixel. EXR: channel Y, or the only
// one, or `channel`. Throws Error, one line that names file, and column and row where a pixel is to blame: another kind of
// file, damaged, colours that differ, NaN or infinity, more than most_pixels.
GreyImage read_grey_image(const std::string& path, const std::string& channel, std::size_t most_pixels);

// Writes the format that the file name asks for, atomically. PNG: 16 bits, values in [0, 1] rounded to v / 65535;
// throws Error for other values. EXR: floats in channel Y.
void write_grey_image(const std::string& path, const GreyImage&);

}  // namespace airlight::scene
