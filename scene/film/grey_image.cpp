#include "scene/film/grey_image.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/file_ending.h"
#include "scene/base/limits.h"
#include "scene/base/printable.h"
#include "scene/film/exr_header.h"
#include "scene/film/exr_memory.h"
#include "scene/film/grey_image_parts.h"

namespace airlight::scene {
namespace {

std::string chosen_channel(const std::string& path, const Imf::Header& header, const std::string& wish) {
  std::vector<std::string> names;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) names.emplace_back(i.name());
  const auto has = [&](const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min<std::size_t>(40, names.size()); ++i) shown.push_back(printable(names[i], 60));
  if (!wish.empty() && !has(wish))
    throw Error(fmt::format("{}: no channel '{}'; it has: {}", path, wish, fmt::join(shown, ", ")));
  if (!wish.empty()) return wish;
  if (has("Y")) return "Y";
  if (names.size() == 1) return names.front();
  throw Error(fmt::format("{}: {} channels and none is Y, expected a channel by name; it has: {}", path, names.size(),
                          fmt::join(shown, ", ")));
}

GreyImage decode(const std::string& path, const std::string& wish, std::size_t most_pixels) {
  Imf::InputFile file(path.c_str(), 1);
  const Imath::Box2i window = file.header().dataWindow();
  const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
  const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
  require_pixels(path, std::size_t(std::max<std::int64_t>(0, width)), std::size_t(std::max<std::int64_t>(0, height)),
                 most_pixels);
  check_windows(path, file.header());
  const std::string name = chosen_channel(path, file.header(), wish);
  const Imf::Channel& channel = *file.header().channels().findChannel(name.c_str());
  if (channel.xSampling != 1 || channel.ySampling != 1)
    throw Error(fmt::format("{}: channel '{}' is subsampled", path, name));
  if (!file.isComplete()) throw Error(fmt::format("{}: incomplete: pixels are missing", path));
  require_memory(12.0 * double(width) * double(height), fmt::format("{}: {} x {} pixels", path, width, height));
  std::vector<float> values(std::size_t(width) * std::size_t(height));
  Imf::FrameBuffer pixels;
  pixels.insert(name,
                Imf::Slice::Make(Imf::FLOAT, values.data(), window, sizeof(float), sizeof(float) * std::size_t(width)));
  file.setFrameBuffer(pixels);
  file.readPixels(window.min.y, window.max.y);
  return {int(width), int(height), {values.begin(), values.end()}, ""};
}

}  // namespace

void require_pixels(const std::string& path, std::size_t width, std::size_t height, std::size_t most_pixels) {
  if (width < 1 || height < 1 || width > (1u << 20) || height > (1u << 20) || width * height > most_pixels)
    throw Error(fmt::format("{}: {} x {} pixels, expected 1 to {}", path, width, height, most_pixels));
}

GreyImage read_grey_exr(const std::string& path, const std::string& channel, std::size_t most_pixels) {
  check_exr_attributes(path);
  try {
    return decode(path, channel, most_pixels);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(fmt::format("{}: damaged or unreadable EXR: {}", path, printable(error.what(), 200)));
  }
}

GreyImage read_grey_image(const std::string& path, const std::string& channel, std::size_t most_pixels) {
  const std::string kind = file_ending(path);
  if (kind != ".png" && kind != ".exr") throw Error(fmt::format("{}: expected a name in .png or .exr", path));
  if (kind == ".png" && !channel.empty()) throw Error(fmt::format("{}: a channel is chosen of EXR files only", path));
  GreyImage image = kind == ".png" ? read_grey_png(path, most_pixels) : read_grey_exr(path, channel, most_pixels);
  for (std::size_t i = 0; i < image.values.size(); ++i)
    if (!std::isfinite(image.values[i]))
      throw Error(fmt::format("{}: column {}, row {}: {}, expected a finite number", path, i % image.width,
                              i / image.width, image.values[i]));
  return image;
}

void write_grey_image(const std::string& path, const GreyImage& image) {
  if (file_ending(path) == ".png") return write_grey_png(path, image);
  MemoryStream stream;
  {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    std::vector<float> values(image.values.begin(), image.values.end());
    Imf::FrameBuffer pixels;
    pixels.insert("Y", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float),
                                  sizeof(float) * std::size_t(image.width)));
    Imf::OutputFile file(stream, header, 1);
    file.setFrameBuffer(pixels);
    file.writePixels(image.height);
  }  // the file is complete when it is closed
  write_file_atomically(path, stream.bytes());
}

}  // namespace airlight::scene
