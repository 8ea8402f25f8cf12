// OpenEXR to Film. A file may be damaged: nothing is allocated on the word of a header that has not been checked.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>

#include "scene/base/error.h"
#include "scene/base/limits.h"
#include "scene/base/printable.h"
#include "scene/film/exr_header.h"
#include "scene/film/film.h"

namespace airlight::scene {
namespace {

constexpr int max_side = 1 << 16;  // pixels; also bounds the library's table of scan lines

// Text from the file, fit for one line of a message.
std::string shown(const std::string& text) { return printable(text, 200); }

}  // namespace

void check_exr_attributes(const std::string& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) throw Error(fmt::format("{}: no such file", path));
  if (!std::filesystem::is_regular_file(status)) throw Error(fmt::format("{}: not a regular file", path));
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  std::ifstream file(path, std::ios::binary);
  if (failure || !file) throw Error(fmt::format("{}: cannot read", path));

  const auto truncated = [&] { return Error(fmt::format("{}: truncated inside the header ({} bytes)", path, size)); };
  const auto number = [&] {  // little-endian
    unsigned char b[4];
    if (!file.read(reinterpret_cast<char*>(b), 4)) throw truncated();
    return std::uint32_t(b[0]) | std::uint32_t(b[1]) << 8 | std::uint32_t(b[2]) << 16 | std::uint32_t(b[3]) << 24;
  };
  const auto word = [&] {
    std::string text;
    for (int c = file.get(); c != 0; c = file.get()) {
      if (c == std::ifstream::traits_type::eof()) throw truncated();
      if (text.size() >= 255) throw Error(fmt::format("{}: damaged header: a name of more than 255 characters", path));
      text += char(c);
    }
    return text;
  };

  if (size < 8 || number() != 20000630) throw Error(fmt::format("{}: not an OpenEXR file ({} bytes)", path, size));
  const std::uint32_t flags = number();
  if (flags & 0x1800) throw Error(fmt::format("{}: a deep or multi-part EXR file, expected a single flat image", path));
  for (std::string name = word(); !name.empty(); name = word()) {
    word();  // its type
    const std::uint32_t length = number();
    if (length > size - std::uintmax_t(file.tellg()))
      throw Error(fmt::format("{}: damaged header: attribute '{}' claims {} bytes of a file of {}", path, shown(name),
                              length, size));
    file.seekg(length, std::ios::cur);
  }
}

void check_windows(const std::string& path, const Imf::Header& header) {
  if (header.displayWindow() != header.dataWindow())
    throw Error(fmt::format("{}: a cropped or overscanned image (data and display window differ)", path));
}

bool is_cube_map(const std::string& path) {
  check_exr_attributes(path);
  const Imf::InputFile file(path.c_str(), 1);
  return Imf::hasEnvmap(file.header()) && Imf::envmap(file.header()) == Imf::ENVMAP_CUBE;
}

namespace {

struct Layout {
  Imath::Box2i window;
  int width;
  int height;
  std::set<std::string> layers;
};

// Numbers of other primaries are other colours.
void check_primaries(const std::string& path, const Imf::Header& header) {
  if (!Imf::hasChromaticities(header)) return;
  const Imf::Chromaticities found = Imf::chromaticities(header), expected;  // Rec. 709 with D65
  const auto differ = [](const Imath::V2f& a, const Imath::V2f& b) { return !((a - b).length() <= 0.002f); };
  if (differ(found.red, expected.red) || differ(found.green, expected.green) || differ(found.blue, expected.blue) ||
      differ(found.white, expected.white))
    throw Error(fmt::format(
        "{}: its colours have other primaries: found chromaticities red ({:.4g}, {:.4g}), green ({:.4g}, {:.4g}), blue "
        "({:.4g}, {:.4g}), white ({:.4g}, {:.4g}), expected those of Rec. 709 with D65",
        path, found.red.x, found.red.y, found.green.x, found.green.y, found.blue.x, found.blue.y, found.white.x,
        found.white.y));
}

Layout check_layout(const std::string& path, const Imf::Header& header, std::size_t max_bytes) {
  Layout layout;
  layout.window = header.dataWindow();
  const std::int64_t width = std::int64_t(layout.window.max.x) - layout.window.min.x + 1;
  const std::int64_t height = std::int64_t(layout.window.max.y) - layout.window.min.y + 1;
  if (width < 1 || height < 1 || width > max_side || height > max_side)
    throw Error(fmt::format("{}: {} x {} pixels, expected 1 to {} a side", path, width, height, max_side));
  check_windows(path, header);
  check_primaries(path, header);
  layout.width = int(width);
  layout.height = int(height);

  std::vector<std::string> channels;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    const std::string name = i.name();
    channels.push_back(shown(name));
    const std::size_t dot = name.rfind('.');
    const std::string letter = dot == std::string::npos ? name : name.substr(dot + 1);
    if (letter != "R" && letter != "G" && letter != "B") continue;
    if (i.channel().xSampling != 1 || i.channel().ySampling != 1)
      throw Error(fmt::format("{}: channel '{}' is subsampled", path, shown(name)));
    layout.layers.insert(dot == std::string::npos ? "mean" : name.substr(0, dot));
  }
  // Every channel costs memory while it is decoded, also one that is not kept.
  const double bytes = 4.0 * double(width) * double(height) * double(channels.size());
  if (bytes > double(max_bytes))
    throw Error(fmt::format("{}: {} x {} pixels and {} channels need {:.0f} bytes, allowed are {}", path, width, height,
                            channels.size(), bytes, max_bytes));
  require_memory(bytes, fmt::format("{}: {} x {} pixels", path, width, height));
  if (channels.size() > 40) channels.resize(40);
  if (layout.layers.empty())
    throw Error(fmt::format("{}: no channels R, G, B; it has: {}", path, fmt::join(channels, ", ")));
  // OpenEXR fills a channel that the file lacks with zeros, so the gap has to be found here.
  for (const std::string& layer : layout.layers)
    for (const char letter : {'R', 'G', 'B'})
      if (!header.channels().findChannel(channel_name(layer, letter)))
        throw Error(fmt::format("{}: layer '{}' lacks its channel '{}'; the file has: {}", path, shown(layer),
                                shown(channel_name(layer, letter)), fmt::join(channels, ", ")));
  if (layout.layers.count("mean") && header.channels().findChannel("mean.R"))
    throw Error(fmt::format("{}: both 'R' and 'mean.R'", path));
  return layout;
}

// A damaged width or height shows when the outermost rows are decoded into one row of memory, before all of it is
// allocated.
void probe(Imf::InputFile& file, const Layout& layout) {
  std::vector<float> row(std::size_t(layout.width));
  Imf::FrameBuffer pixels;
  const std::string channel = channel_name(*layout.layers.begin(), 'R');
  char* base =
      reinterpret_cast<char*>(row.data()) - std::ptrdiff_t(layout.window.min.x) * std::ptrdiff_t(sizeof(float));
  pixels.insert(channel, Imf::Slice(Imf::FLOAT, base, sizeof(float), 0));
  file.setFrameBuffer(pixels);
  file.readPixels(layout.window.min.y);
  file.readPixels(layout.window.max.y);
}

Film decode(const std::string& path, std::size_t max_bytes) {
  Imf::Header::setMaxImageSize(max_side, max_side);
  Imf::InputFile file(path.c_str(), 1);
  const Layout layout = check_layout(path, file.header(), max_bytes);
  if (!file.isComplete()) throw Error(fmt::format("{}: incomplete: pixels are missing", path));
  probe(file, layout);

  Film film(layout.width, layout.height);
  Imf::FrameBuffer pixels;
  for (const std::string& layer : layout.layers) {
    float* values = film.add(layer).data();
    for (int c = 0; c < 3; ++c)
      pixels.insert(channel_name(layer, "RGB"[c]),
                    Imf::Slice::Make(Imf::FLOAT, values + c, layout.window, 3 * sizeof(float),
                                     3 * sizeof(float) * std::size_t(layout.width)));
  }
  file.setFrameBuffer(pixels);
  file.readPixels(layout.window.min.y, layout.window.max.y);

  const std::string prefix = "airlight.";
  for (auto i = file.header().begin(); i != file.header().end(); ++i) {
    const std::string name = i.name();
    if (name.rfind(prefix, 0) != 0) continue;
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()))
      film.metadata[name.substr(prefix.size())] = text->value();
  }
  return film;
}

}  // namespace

Film read_exr(const std::string& path, std::size_t max_bytes) {
  check_exr_attributes(path);
  try {
    return decode(path, max_bytes);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(fmt::format("{}: damaged or unreadable EXR: {}", path, shown(error.what())));
  }
}

}  // namespace airlight::scene
