// Film to OpenEXR: encoded in memory, then put into place in one go.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>
#include <half.h>

#include <algorithm>
#include <list>

#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/film/exr_header.h"
#include "scene/film/exr_memory.h"
#include "scene/film/film_exr.h"

namespace airlight::scene {
namespace {

// OpenEXR stores names as zero-terminated text of at most 255 characters, the channel's letter included.
void check_name(const std::string& path, const std::string& what, const std::string& name) {
  const bool printable = std::all_of(name.begin(), name.end(), [](unsigned char c) { return c >= 32 && c != 127; });
  if (name.empty() || name.size() > 240 || !printable)
    throw Error(fmt::format("{}: the {} name '{}' cannot be stored in an EXR file", path, what, name.substr(0, 80)));
}

std::vector<half> halved(const std::string& path, const std::string& layer, const std::vector<float>& values) {
  std::vector<half> result(values.begin(), values.end());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (float(result[i]) != values[i])
      throw Error(fmt::format("{}: layer '{}': {} is no 16-bit float", path, layer, values[i]));
  return result;
}

void encode(const std::string& path, const Film& film, const std::set<std::string>& halves, MemoryStream& stream) {
  Imf::Header header(film.width, film.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer pixels;
  std::list<std::vector<half>> converted;  // until the pixels are written
  for (const auto& [name, values] : film.layers) {
    check_name(path, "layer", name);
    if (values.size() != 3 * film.pixels())
      throw Error(
          fmt::format("{}: layer '{}' has {} values, expected {}", path, name, values.size(), 3 * film.pixels()));
    const bool is_half = halves.count(name) != 0;
    if (is_half) converted.push_back(halved(path, name, values));
    const std::size_t size = is_half ? sizeof(half) : sizeof(float);
    char* base = is_half ? reinterpret_cast<char*>(converted.back().data())
                         : reinterpret_cast<char*>(const_cast<float*>(values.data()));
    for (int c = 0; c < 3; ++c) {
      const std::string channel = channel_name(name, "RGB"[c]);
      if (pixels.findSlice(channel)) throw Error(fmt::format("{}: two layers have a channel '{}'", path, channel));
      const Imf::PixelType type = is_half ? Imf::HALF : Imf::FLOAT;
      header.channels().insert(channel, Imf::Channel(type));
      pixels.insert(channel, Imf::Slice(type, base + std::size_t(c) * size, 3 * size, 3 * size * film.width));
    }
  }
  for (const auto& [key, value] : film.metadata) {
    check_name(path, "metadata", key);
    header.insert("airlight." + key, Imf::StringAttribute(value));
  }
  Imf::OutputFile file(stream, header, 1);
  file.setFrameBuffer(pixels);
  file.writePixels(film.height);
}  // the file is complete when it is closed

void encode_to_file(const std::string& path, const Film& film, bool any_value, const std::set<std::string>& halves) {
  if (film.width < 1 || film.height < 1 || film.layers.empty())
    throw Error(fmt::format("{}: a film of {} x {} pixels and {} layers cannot be written", path, film.width,
                            film.height, film.layers.size()));
  if (!any_value) require_finite(film, path);
  MemoryStream stream;
  try {
    encode(path, film, halves, stream);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(fmt::format("{}: cannot encode: {}", path, std::string(error.what()).substr(0, 200)));
  }
  write_file_atomically(path, stream.bytes());
}

}  // namespace

void write_exr(const std::string& path, const Film& film, bool any_value) { encode_to_file(path, film, any_value, {}); }

void write_exr_with_halves(const std::string& path, const Film& film, const std::set<std::string>& halves) {
  encode_to_file(path, film, false, halves);
}

}  // namespace airlight::scene
