#include <fmt/format.h>
#include <turbojpeg.h>

#include <memory>

#include "scene/base/error.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"
#include "scene/film/color_image_parts.h"

namespace airlight::scene {

ColorImage read_jpeg(const std::string& path) {
  const std::string file = read_whole_file(path, most_image_bytes);
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
  const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), tjDestroy);
  if (!decoder) throw Error(fmt::format("{}: libjpeg-turbo does not start: {}", path, tjGetErrorStr()));
  const auto damaged = [&] {
    return Error(fmt::format("{}: damaged JPEG: {}", path, printable(tjGetErrorStr2(decoder.get()), 200)));
  };
  if (file.size() < 3 || bytes[0] != 0xff || bytes[1] != 0xd8 || bytes[2] != 0xff)
    throw Error(fmt::format("{}: no JPEG file ({} bytes)", path, file.size()));
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (tjDecompressHeader3(decoder.get(), bytes, file.size(), &width, &height, &subsampling, &colours) != 0)
    throw damaged();
  // The library calls a file that ends in its header a table without a picture.
  if (width == 0 || height == 0) throw Error(fmt::format("{}: damaged JPEG: it has no picture", path));
  if (colours == TJCS_CMYK || colours == TJCS_YCCK)
    throw Error(fmt::format("{}: a JPEG of printing inks (CMYK), expected RGB or grey", path));
  require_size(path, width, height);
  std::vector<unsigned char> rgb(3 * std::size_t(width) * std::size_t(height));
  // A file that is cut off or wrong in its middle is a warning to the library, and grey to a reader.
  if (tjDecompress2(decoder.get(), bytes, file.size(), rgb.data(), width, 0, height, TJPF_RGB,
                    TJFLAG_STOPONWARNING | TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) != 0)
    throw damaged();
  ColorImage image{width, height, {}};
  image.rgb.reserve(rgb.size());
  const std::array<float, 256> linear = linear_of_srgb();
  for (const unsigned char byte : rgb) image.rgb.push_back(linear[byte]);
  return image;
}

}  // namespace airlight::scene
