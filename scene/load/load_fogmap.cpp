// A fogmap: from a grey image, or a small one written in the scene file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/film/grey_image.h"
#include "scene/load/assets.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/load/transform.h"
#include "scene/media/fogmap.h"
#include "scene/media/spline_map.h"

namespace airlight::scene::load {
namespace {

HeightProfile read_profile(TableReader reader) {
  const HeightProfile kind = read_kind(reader, profile_name);
  return match(
      kind,
      [&](const SameAtAllHeights&) -> HeightProfile {
        reader.allow({"type"});
        return SameAtAllHeights{};
      },
      [&](const Layers&) -> HeightProfile {
        reader.allow({"type", "heights", "factors"});
        Layers layers;
        layers.heights = reader.numbers("heights", coordinate);
        if (layers.heights.empty()) reader.fail("heights", "heights has no numbers, expected at least one");
        for (std::size_t k = 1; k < layers.heights.size(); ++k)
          if (!(layers.heights[k] - layers.heights[k - 1] >= least_length))
            reader.fail("heights", fmt::format("heights: number {} is {}, after {}, expected one {} m or more above", k,
                                               layers.heights[k], layers.heights[k - 1], least_length));
        layers.factors = reader.numbers("factors", density_range, layers.heights.size());
        return layers;
      },
      [&](const ExponentialFall&) -> HeightProfile {
        reader.allow({"type", "base", "scale_height"});
        return ExponentialFall{reader.number("base", coordinate, 0), reader.number("scale_height", length)};
      });
}

GreyImage read_file(const TableReader& reader, const std::string& folder) {
  const auto most = std::size_t(reader.integer("most_pixels", 1, 1LL << 40, 1LL << 26));
  const std::string path = find_asset(reader, "file", folder), channel = reader.text("channel", "");
  try {
    return read_grey_image(path, channel, most);
  } catch (const Error& e) {
    reader.fail("file", e.what());
  }
}

GreyImage read_inline(const TableReader& reader) {
  const auto size = reader.integers("size", 2, 1, 1 << 20);
  GreyImage image{int(size[0]), int(size[1]), reader.numbers("values", either_sign(density_range)), ""};
  if (double(image.values.size()) != double(size[0]) * double(size[1]))
    reader.fail("values", fmt::format("values has {} numbers, expected {} = {} x {}, x fastest", image.values.size(),
                                      size[0] * size[1], size[0], size[1]));
  return image;
}

// Negative pixels are refused, or clamped and counted.
void require_no_negative(const TableReader& reader, const std::string& key, GreyImage& image) {
  const bool clamp = reader.flag("clamp_negative", false);
  std::size_t clamped = 0;
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    double& value = image.values[i];
    if (value > density_range.greatest)
      reader.fail(key, fmt::format("column {}, row {}: {}, expected at most {}", i % image.width, i / image.width,
                                   value, density_range.greatest));
    if (value >= 0) continue;
    if (!clamp)
      reader.fail(key, fmt::format("column {}, row {}: {}, expected a number >= 0, or clamp_negative = true",
                                   i % image.width, i / image.width, value));
    value = 0;
    ++clamped;
  }
  if (clamped > 0)
    image.note += fmt::format("{}{} negative pixels are taken as 0", image.note.empty() ? "" : ", ", clamped);
}

void flip(GreyImage& image) {
  for (int j = 0; j < image.height / 2; ++j)
    std::swap_ranges(image.values.begin() + std::ptrdiff_t(j) * image.width,
                     image.values.begin() + std::ptrdiff_t(j + 1) * image.width,
                     image.values.begin() + std::ptrdiff_t(image.height - 1 - j) * image.width);
}

HeightProfile moved(const HeightProfile& profile, double scale, double up) {
  return match(
      profile, [](const SameAtAllHeights& same) -> HeightProfile { return same; },
      [&](Layers layers) -> HeightProfile {
        for (double& height : layers.heights) height = scale * height + up;
        return layers;
      },
      [&](const ExponentialFall& fall) -> HeightProfile {
        return ExponentialFall{scale * fall.base + up, scale * fall.scale_height};
      });
}

}  // namespace

FogmapPointer read_fogmap(TableReader& reader, const std::string& folder) {
  const std::vector<std::string> both = {"cell", "corner", "degree", "profile", "flip", "clamp_negative", "transform"};
  const auto allowed = [&](std::vector<std::string> keys) {
    keys.insert(keys.end(), both.begin(), both.end());
    reader.allow(medium_keys_and(keys));
  };
  allowed({"file", "channel", "most_pixels", "size", "values"});
  const std::string source = reader.one_of({"file", "values"});
  if (source == "file")
    allowed({"file", "channel", "most_pixels"});
  else
    allowed({"size", "values"});
  GreyImage image = source == "file" ? read_file(reader, folder) : read_inline(reader);
  require_no_negative(reader, source, image);
  if (reader.flag("flip", false)) flip(image);

  auto fog = std::make_shared<Fogmap>();
  const int degree = int(reader.integer("degree", 0, most_spline_degree, 1));
  fog->map = SplineMap(degree, {{0, 0}, {image.width, image.height}}, image.values);
  fog->note = image.note;
  const double cell = reader.number("cell", length);
  const std::vector<double> corner =
      reader.has("corner") ? reader.numbers("corner", coordinate, 2) : std::vector<double>{0, 0};
  const auto profile = reader.table("profile");
  const Similarity outer = read_transform(reader, "transform");
  if ((outer.rotation * Vec3::UnitY() - Vec3::UnitY()).norm() > 1e-12)
    reader.fail("transform", "transform turns the map out of the ground, expected a rotation about [0, 1, 0]");
  const Point3 start = outer(Point3(corner[0] - 0.5 * cell * degree, 0, corner[1] - 0.5 * cell * degree));
  fog->x0 = start[0];
  fog->z0 = start[2];
  fog->cell = outer.scale * cell;
  fog->cos_turn = outer.rotation(0, 0);
  fog->sin_turn = outer.rotation(0, 2);
  fog->profile = moved(profile ? read_profile(*profile) : HeightProfile{}, outer.scale, outer.translation[1]);
  require_near(reader, source, *fog);
  return fog;
}

}  // namespace airlight::scene::load
