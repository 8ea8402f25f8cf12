// An 8-bit preview of one layer.
#include <fmt/format.h>
#include <png.h>

#include <cmath>

#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/film/film.h"

namespace airlight::scene {
namespace {

// IEC 61966-2-1.
double srgb(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

}  // namespace

void write_png(const std::string& path, const Film& film, const std::string& layer, double exposure, Tone tone) {
  const std::vector<float>& values = film.layer(layer);
  if (film.width < 1 || film.height < 1 || values.size() != 3 * film.pixels())
    throw Error(fmt::format("{}: layer '{}' has {} values, which is no film of {} x {}", path, layer, values.size(),
                            film.width, film.height));
  const double factor = std::exp2(exposure);
  std::vector<png_byte> bytes(values.size());
  for (std::size_t i = 0; i < values.size(); i += 3) {
    // Magenta is seen at once, and no fog has it.
    const bool broken = std::isnan(values[i]) || std::isnan(values[i + 1]) || std::isnan(values[i + 2]);
    const Rgb shown = broken ? Rgb(1, 0, 1) : toned(tone, factor * Rgb(values[i], values[i + 1], values[i + 2]));
    for (std::size_t c = 0; c < 3; ++c) bytes[i + c] = png_byte(std::lround(255 * srgb(shown[long(c)])));
  }

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = png_uint_32(film.width);
  image.height = png_uint_32(film.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string file(size, '\0');
  if (!png_image_write_to_memory(&image, file.data(), &size, 0, bytes.data(), 0, nullptr))
    throw Error(fmt::format("{}: cannot encode: {}", path, image.message));
  write_file_atomically(path, std::string_view(file.data(), size));
}

}  // namespace airlight::scene
