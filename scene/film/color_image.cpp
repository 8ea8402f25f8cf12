#include "scene/film/color_image.h"

#include <fmt/format.h>
#include <png.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "scene/base/error.h"
#include "scene/base/file_ending.h"
#include "scene/base/limits.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"
#include "scene/film/color_image_parts.h"
#include "scene/film/film.h"
#include "scene/film/grey_image_parts.h"

namespace airlight::scene {
namespace {

constexpr int most_side = 16384;  // as of films

struct PngReader {
  png_image image{};
  PngReader() { image.version = PNG_IMAGE_VERSION; }
  ~PngReader() { png_image_free(&image); }
};

ColorImage read_png(const std::string& path) {
  const std::string file = read_whole_file(path, most_image_bytes);
  PngReader reader;
  png_image& png = reader.image;
  const auto damaged = [&] { return Error(fmt::format("{}: damaged PNG: {}", path, printable(png.message, 200))); };
  if (file.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, 8) != 0)
    throw Error(fmt::format("{}: no PNG file ({} bytes)", path, file.size()));
  if (!png_image_begin_read_from_memory(&png, file.data(), file.size())) throw damaged();
  require_size(path, png.width, png.height);
  if (png.format & PNG_FORMAT_FLAG_ALPHA)
    throw Error(fmt::format("{}: has an alpha channel, expected a picture without", path));
  png.format = PNG_FORMAT_RGB;
  png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  std::vector<png_byte> bytes(PNG_IMAGE_SIZE(png));
  ColorImage image{int(png.width), int(png.height), {}};
  image.rgb.reserve(bytes.size());
  if (!png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr)) throw damaged();
  const std::array<float, 256> linear = linear_of_srgb();
  for (const png_byte byte : bytes) image.rgb.push_back(linear[byte]);
  return image;
}

DepthImage read_pfm(const std::string& path) {
  const std::string file = read_whole_file(path, most_image_bytes);
  std::istringstream in(file.substr(0, 200));
  std::string kind, scale;
  long long width = 0, height = 0;
  if (!(in >> kind) || (kind != "Pf" && kind != "PF"))
    throw Error(fmt::format("{}: no PFM file ({} bytes)", path, file.size()));
  if (kind == "PF") throw Error(fmt::format("{}: a PFM file of colours, expected one channel (Pf)", path));
  double order = 0;
  if (!(in >> width >> height >> order) || order == 0)
    throw Error(fmt::format("{}: damaged PFM: expected width, height and a byte order in its header", path));
  require_size(path, width, height);
  const std::size_t begin = std::size_t(in.tellg()) + 1, pixels = std::size_t(width) * std::size_t(height);
  if (file.size() != begin + 4 * pixels)
    throw Error(fmt::format("{}: {} bytes of pixels, expected {} for {} x {}", path,
                            file.size() - std::min(begin, file.size()), 4 * pixels, width, height));
  DepthImage image{int(width), int(height), std::vector<float>(pixels)};
  for (std::size_t y = 0; y < std::size_t(height); ++y)  // rows go from the bottom up
    for (std::size_t x = 0; x < std::size_t(width); ++x) {
      std::uint32_t word;
      std::memcpy(&word, file.data() + begin + 4 * ((std::size_t(height) - 1 - y) * std::size_t(width) + x), 4);
      if (order > 0) word = __builtin_bswap32(word);
      image.values[y * std::size_t(width) + x] = std::bit_cast<float>(word);
    }
  return image;
}

ColorImage read_layer(const std::string& path, const std::string& layer) {
  Film film = read_exr(path, most_image_bytes);
  require_size(path, film.width, film.height);
  film.layer(layer);
  return {film.width, film.height, std::move(film.layers[layer])};
}

}  // namespace

void require_size(const std::string& path, long long width, long long height) {
  if (width < 1 || height < 1 || width > most_side || height > most_side)
    throw Error(fmt::format("{}: {} x {} pixels, expected 1 to {} a side", path, width, height, most_side));
  require_memory(3.0 * double(width) * double(height) * (1 + sizeof(float)),
                 fmt::format("{}: {} x {} pixels", path, width, height));
}

std::array<float, 256> linear_of_srgb() {
  std::array<float, 256> table;
  for (int v = 0; v < 256; ++v)
    table[v] = float(v / 255.0 <= 0.04045 ? v / 255.0 / 12.92 : std::pow((v / 255.0 + 0.055) / 1.055, 2.4));
  return table;
}

ColorImage read_color_image(const std::string& path, const std::string& layer) {
  const std::string kind = file_ending(path);
  ColorImage image;
  if (kind == ".png")
    image = read_png(path);
  else if (kind == ".jpg" || kind == ".jpeg")
    image = read_jpeg(path);
  else if (kind == ".hdr")
    image = read_radiance(path);
  else if (kind == ".exr")
    image = read_layer(path, layer);
  else
    throw Error(fmt::format("{}: expected a name in .png, .jpg, .hdr or .exr", path));
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    if (!(image.rgb[i] >= 0 && std::isfinite(image.rgb[i])))
      throw Error(fmt::format("{}: column {}, row {}: {}, expected a finite number >= 0", path, i / 3 % image.width,
                              i / 3 / image.width, image.rgb[i]));
  return image;
}

DepthImage read_depth_image(const std::string& path, const std::string& channel) {
  const std::string kind = file_ending(path);
  if (kind == ".pfm") return read_pfm(path);
  if (kind != ".exr" && kind != ".png") throw Error(fmt::format("{}: expected a name in .pfm, .exr or .png", path));
  const GreyImage grey =
      kind == ".png" ? read_grey_png(path, std::size_t(1) << 28) : read_grey_exr(path, channel, std::size_t(1) << 28);
  require_size(path, grey.width, grey.height);
  return {grey.width, grey.height, {grey.values.begin(), grey.values.end()}};
}

}  // namespace airlight::scene
