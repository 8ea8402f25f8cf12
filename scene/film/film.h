// A picture: RGB float layers of one size, with metadata. OpenEXR in and out, PNG previews.
//
// Row 0 is the top. Linear RGB. Layer names that everything agrees on (order m = medium scatterings, s = surface
// reflections):
//   mean           all orders together; written as plain R, G, B so that any viewer shows it
//   airlight       (m, s) = (1, 0): light scattered once by the medium and by nothing else
//   surface        (0, s), s >= 0: surfaces and background seen through the medium
//   ambient        ambient_in_scatter of the scene times 1 - transmittance, where a method has it
//   transmittance  of the camera ray, from the camera to what ends it
//   distance       [m] of what ends the ray of a pixel's centre, 0 where nothing does (airlight render --distance)
//   se             standard error of `mean` (references only)
#pragma once
#include <map>
#include <string>
#include <vector>

#include "scene/film/tone_curve.h"
#include "scene/math/types.h"

namespace airlight::scene {

struct Film {
  int width = 0;
  int height = 0;
  std::map<std::string, std::vector<float>> layers;  // 3 floats per pixel, x fastest
  std::map<std::string, std::string> metadata;       // scene hash, seed, settings, samples, ...

  Film() = default;
  Film(int w, int h) : width(w), height(h) {}
  std::size_t pixels() const { return std::size_t(width) * height; }
  std::vector<float>& add(const std::string& layer);          // zero-filled if new
  const std::vector<float>& layer(const std::string&) const;  // throws Error naming the layers there are
  bool has(const std::string& layer) const { return layers.count(layer) != 0; }
  void set(const std::string& layer, int x, int y, const Rgb&);
  Rgb get(const std::string& layer, int x, int y) const;
};

// Throws Error that begins with `what` and names the first pixel, layer and channel whose value is NaN or infinite.
void require_finite(const Film&, const std::string& what);

// Writes all layers and metadata, ZIP-compressed floats, to a temporary name and renames it: never half a file. Throws
// Error, also for a value that is not finite (require_finite) unless `any_value`: every picture that is kept passes
// through here.
void write_exr(const std::string& path, const Film&, bool any_value = false);

// Reads every RGB layer, whatever the channels' type and the compression; other channels (alpha, depth) are left out.
// Error (file, what was found) on anything missing, damaged, cropped, deep or multi-part, larger than max_bytes once
// decoded or than 65536 pixels a side, and on a layer that lacks a channel.
Film read_exr(const std::string& path, std::size_t max_bytes = std::size_t(4) << 30);

// 8-bit sRGB preview of a layer times 2^exposure through a tone curve, NaN in magenta; atomic.
void write_png(const std::string& path, const Film&, const std::string& layer = "mean", double exposure = 0,
               Tone = Tone::clamp);

}  // namespace airlight::scene
