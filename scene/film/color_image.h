// Pictures of linear RGB, and maps of depth that go with them.
#pragma once
#include <string>
#include <vector>

namespace airlight::scene {

struct ColorImage {
  int width = 0, height = 0;
  std::vector<float> rgb;  // x fastest, row 0 the top; linear light
};

// PNG and JPEG: sRGB, 8 bits a channel (the higher ones of 16), turned into linear light; no alpha. Radiance picture (.hdr): linear, divided
// by its exposure. EXR: the layer's R, G, B as they are ("mean": the file's own). Throws Error, one line that names file, and column and
// row where a pixel is to blame: another kind of file, damaged, truncated, NaN, infinity or below 0, more than 16384 pixels a side.
ColorImage read_color_image(const std::string& path, const std::string& layer = "mean");

struct DepthImage {
  int width = 0, height = 0;
  std::vector<float> values;  // as they are in the file; row 0 the top; may be NaN or infinite
};

// PFM of one channel ("Pf"); one channel of an EXR file (empty: Y, or the only one); a grey PNG, v / 65535 or v / 255. Throws Error as above, but takes any value.
DepthImage read_depth_image(const std::string& path, const std::string& channel);

}  // namespace airlight::scene
