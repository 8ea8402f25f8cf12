// [backdrop]: a picture with depth that ends rays of the scene's camera.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "scene/base/error.h"
#include "scene/base/file_ending.h"
#include "scene/film/color_image.h"
#include "scene/load/assets.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"

namespace airlight::scene::load {
namespace {

template <class Image>
Image read(const TableReader& reader, const std::string& key, const std::string& folder,
           const std::function<Image(const std::string& path)>& read_file) {
  const std::string path = find_asset(reader, key, folder);
  try {
    return read_file(path);
  } catch (const Error& e) {
    reader.fail(key, e.what());
  }
}

DepthImage read_depth(const TableReader& reader, const std::string& folder) {
  const std::string key = reader.has("depth") ? "depth" : "image";
  const std::string channel = reader.text("channel", "");
  if (key == "image" && (channel.empty() || file_ending(reader.text("image")) != ".exr"))
    reader.fail("", "missing key 'depth', expected a file, or the channel of an image in .exr that is the depth");
  return read<DepthImage>(reader, key, folder, [&](const auto& path) { return read_depth_image(path, channel); });
}

// Fills pixels that a stereo pair does not know (infinite, or no number) with the farther one of the nearest known
// pixels of the row. A row without known pixels has infinite depth.
void fill_unknown(DepthImage& depth) {
  for (int y = 0; y < depth.height; ++y) {
    float* row = &depth.values[std::size_t(y) * depth.width];
    for (int x = 0; x < depth.width;) {
      if (std::isfinite(row[x])) {
        ++x;
        continue;
      }
      int end = x;
      while (end < depth.width && !std::isfinite(row[end])) ++end;
      const float left = x > 0 ? row[x - 1] : 0, right = end < depth.width ? row[end] : 0;
      const float farther = std::max(left, right);
      std::fill(row + x, row + end, farther > 0 ? farther : float(infinity));
      x = end;
    }
  }
}

// Depth = factor / (disparity + offset).
void from_disparity(TableReader disparity, DepthImage& depth) {
  disparity.allow({"factor", "offset"});
  const double factor = disparity.number("factor", length), offset = disparity.number("offset", coordinate, 0);
  for (std::size_t i = 0; i < depth.values.size(); ++i) {
    float& value = depth.values[i];
    if (!std::isfinite(value)) continue;
    if (!(value + offset > 0))
      disparity.fail("", fmt::format("column {}, row {}: a disparity of {}, expected one above {}", i % depth.width,
                                     i / depth.width, value, -offset));
    value = float(factor / (value + offset));
  }
  fill_unknown(depth);
}

// [m] along the axis of view, of values in `unit` along it or along rays.
void to_view_axis(const TableReader& reader, const Camera& camera, double unit, bool along_rays, DepthImage& depth) {
  const bool slanted = along_rays && camera.kind == Camera::Kind::perspective;
  const double half = std::tan(0.5 * camera.vertical_fov);
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x) {
      float& value = depth.values[std::size_t(y) * depth.width + x];
      const double metres = value * unit;
      if (!(metres >= 0) || (metres > 0 && metres < least_length) || (metres > greatest_length && metres < infinity))
        reader.fail(reader.has("depth") ? "depth" : "image",
                    fmt::format("column {}, row {}: a depth of {} m, expected one in [{}, {}], or 0 or infinity where "
                                "there is no end",
                                x, y, metres, least_length, greatest_length));
      const double across = half * (2 * x + 1 - depth.width) / depth.height;
      const double up = half * (depth.height - 2 * y - 1) / depth.height;
      value = metres == 0 ? float(infinity) : float(metres / (slanted ? std::sqrt(1 + across * across + up * up) : 1));
    }
}

}  // namespace

std::shared_ptr<const Backdrop> read_backdrop(TableReader reader, const std::string& folder, const Camera& camera) {
  reader.allow({"image", "layer", "depth", "channel", "along", "depth_scale", "disparity", "scale"});
  const std::string layer = reader.text("layer", "mean");
  ColorImage image =
      read<ColorImage>(reader, "image", folder, [&](const auto& path) { return read_color_image(path, layer); });
  DepthImage depth = read_depth(reader, folder);
  if (depth.width != image.width || depth.height != image.height)
    reader.fail(reader.has("depth") ? "depth" : "image",
                fmt::format("the depth has {} x {} pixels, expected {} x {} as the image", depth.width, depth.height,
                            image.width, image.height));
  if (const auto disparity = reader.table("disparity")) from_disparity(*disparity, depth);
  to_view_axis(reader, camera, reader.number("depth_scale", length, 1),
               reader.choice("along", {"view", "ray"}, "view") == "ray", depth);
  const Rgb scale = reader.color("scale", amount, Rgb::Ones());
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const double radiance = image.rgb[i] * scale[i % 3];
    if (!(radiance <= amount.greatest))
      reader.fail(reader.has("scale") ? "scale" : "image",
                  fmt::format("column {}, row {}: a radiance of {}, expected at most {}", i / 3 % image.width,
                              i / 3 / image.width, radiance, amount.greatest));
    image.rgb[i] = float(radiance);
  }
  return std::make_shared<const Backdrop>(
      Backdrop{image.width, image.height, std::move(image.rgb), std::move(depth.values), true});
}

}  // namespace airlight::scene::load
