// Files that a fogmap may be read from, and files that are refused: each rule of input of the method's specification.
#include "scene/media/fogmap.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <half.h>
#include <png.h>

#include <cmath>

#include "scene/film/grey_image.h"
#include "scene/media/spline_map.h"
#include "tests/scene/load/message.h"
#include "tests/temporary_folder.h"

namespace fogmap_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

namespace {

// Six lines; what follows begins on line 7.
std::string fogmap(const std::string& rest, const std::string& sigma_t = "1") {
  return camera + "[[medium]]\ntype = 'fogmap'\nsigma_t = " + sigma_t + "\n" + rest;
}

const std::string whole = "region = { type = 'slab', lo = 0, hi = 10 }\ncell = 2\n";

std::string inline_map(const std::string& size, const std::string& values, const std::string& rest = "") {
  return fogmap(whole + "size = " + size + "\nvalues = " + values + "\n" + rest);
}

const scene::Fogmap& map_of(const scene::Scene& scene) {
  return *std::get<scene::FogmapPointer>(scene.media.at(0).field);
}

scene::Scene scene_of(const std::string& text, const std::string& folder = "") {
  return scene::parse_scene(text, "s.toml", folder);
}

void write_png(const std::string& file, int width, int height, std::uint32_t format, const std::vector<png_byte>& bytes,
               const std::vector<png_byte>& palette = {}) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = png_uint_32(width);
  image.height = png_uint_32(height);
  image.format = format;
  image.colormap_entries = png_uint_32(palette.size() / 3);
  REQUIRE(
      png_image_write_to_file(&image, file.c_str(), 0, bytes.data(), 0, palette.empty() ? nullptr : palette.data()));
}

// 2 x 1 pixels: in every channel 0.25 and its number.
void write_half_exr(const std::string& file, const std::vector<std::string>& channels) {
  Imf::Header header(2, 1);
  Imf::FrameBuffer buffer;
  std::vector<std::array<half, 2>> values;
  values.reserve(channels.size());
  for (const std::string& name : channels) {
    header.channels().insert(name, Imf::Channel(Imf::HALF));
    values.push_back({half(0.25f), half(float(values.size()))});
    buffer.insert(name, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values.back().data()), sizeof(half), 0));
  }
  Imf::OutputFile out(file.c_str(), header);
  out.setFrameBuffer(buffer);
  out.writePixels(1);
}

}  // namespace

TEST_CASE("fogmaps: numbers out of range are refused at their place", "[load][fogmap]") {
  CHECK(message(inline_map("[2, 2]", "[1, 0, 0.5, 2]")).empty());
  const std::string good = "size = [2, 2]\nvalues = [1, 0, 0.5, 2]\n";
  const auto with = [&](const std::string& line) { return message(fogmap(whole + good + line + "\n")); };
  // NaN and infinity: coefficient, extinction, height, place.
  CHECK_THAT(message(inline_map("[2, 2]", "[1, nan, 0.5, 2]")), Contains("s.toml:10:14: medium 0: values[1] = nan"));
  CHECK_THAT(message(inline_map("[2, 2]", "[1, 0, inf, 2]")), Contains("s.toml:10:17: medium 0: values[2] = inf"));
  CHECK_THAT(message(fogmap(whole + good, "nan")), Contains("s.toml:6:11: medium 0: sigma_t = nan"));
  CHECK_THAT(message(fogmap(whole + good, "-0.1")), Contains("s.toml:6:11: medium 0: sigma_t = -0.1"));
  CHECK_THAT(with("corner = [0, inf]"), Contains("s.toml:11:14: medium 0: corner[1] = inf"));
  const auto profile = [&](const std::string& rest) { return with("profile = { type = " + rest + " }"); };
  CHECK(profile("'exponential', scale_height = 2").empty());
  CHECK_THAT(profile("'exponential', scale_height = 0"), Contains("scale_height = 0"));
  CHECK_THAT(profile("'exponential', scale_height = -1"), Contains("scale_height = -1"));
  CHECK_THAT(profile("'exponential', base = nan, scale_height = 1"), Contains("base = nan"));
  CHECK_THAT(profile("'layers', heights = [0, 0], factors = [1, 0]"), Contains("heights: number 1 is 0, after 0"));
  CHECK_THAT(profile("'layers', heights = [2, 1], factors = [1, 0]"), Contains("heights: number 1 is 1, after 2"));
  CHECK_THAT(profile("'layers', heights = [0, 1], factors = [1, -1]"), Contains("factors[1] = -1"));
  CHECK_THAT(profile("'layers', heights = [0, 1], factors = [1]"), Contains("factors"));
  CHECK_THAT(profile("'layers', heights = [], factors = []"), Contains("heights has no numbers"));
  CHECK_THAT(message(fogmap("region = { type = 'slab', lo = 0, hi = 10 }\ncell = 0\n" + good)), Contains("cell = 0"));
  CHECK_THAT(message(fogmap("region = { type = 'slab', lo = 0, hi = 10 }\ncell = -1\n" + good)), Contains("cell = -1"));
  CHECK_THAT(with("degree = 4"), Contains("degree = 4"));
  CHECK_THAT(with("transform = { rotation = { axis = [1, 0, 0], angle = 0.1 } }"), Contains("out of the ground"));
}

TEST_CASE("fogmaps: negative pixels are refused, or clamped and counted", "[load][fogmap]") {
  const std::string values = "[1, 0, -0.5, 2, -1e-9, -0.0]";
  CHECK_THAT(message(inline_map("[3, 2]", values)), Contains("column 2, row 0: -0.5, expected a number >= 0"));
  const scene::Scene clamped = scene_of(inline_map("[3, 2]", values, "clamp_negative = true\n"));
  CHECK(map_of(clamped).map.coefficients() == std::vector<double>{1, 0, 0, 2, 0, 0});
  CHECK_THAT(map_of(clamped).note, Contains("2 negative pixels are taken as 0"));
  const TemporaryFolder folder;
  scene::write_grey_image(folder.file("map.exr"), {2, 2, {1, 0, 3, -2}, ""});
  const auto file = [&](const std::string& rest) { return fogmap(whole + "file = 'map.exr'\n" + rest); };
  CHECK_THAT(message(file(""), folder.path().string()), Contains("column 1, row 1: -2"));
  CHECK_THAT(map_of(scene_of(file("clamp_negative = true\n"), folder.path().string())).note,
             Contains("1 negative pixel"));
}

TEST_CASE("fogmaps: any size from one pixel on, and no other count of values", "[load][fogmap]") {
  for (const auto& [width, height] : {std::pair(1, 1), {1, 7}, {5, 1}, {3, 5}})
    for (int degree = 0; degree <= 3; ++degree) {
      std::string values = "[1";
      for (int i = 1; i < width * height; ++i) values += ", 1";
      const std::string size = "[" + std::to_string(width) + ", " + std::to_string(height) + "]";
      const scene::Scene scene = scene_of(inline_map(size, values + "]", "degree = " + std::to_string(degree) + "\n"));
      CHECK(map_of(scene).map.range().size[0] == width);  // no padding
      CHECK(map_of(scene).map.range().size[1] == height);
      // Through the middle, upright: the product of the splines there, and 10 m.
      CHECK(density_integral(scene.media[0], {{width * 1.0, -1, height * 1.0}, Vec3::UnitY()}, {0, 20}) > 3);
    }
  CHECK_THAT(message(inline_map("[0, 2]", "[]")), Contains("size[0] = 0"));
  CHECK_THAT(message(inline_map("[2, 2]", "[1, 2, 3]")), Contains("values has 3 numbers, expected 4 = 2 x 2"));
  CHECK_THAT(message(inline_map("[2, 2]", "[1, 2, 3, 4, 5]")), Contains("values has 5 numbers, expected 4 = 2 x 2"));
}

TEST_CASE("fogmaps: PNG of 8 and 16 bits, grey, or of colours that are grey", "[load][fogmap]") {
  const TemporaryFolder folder;
  const auto load = [&](const std::string& rest = "") {
    return scene_of(fogmap(whole + "file = 'map.png'\ndegree = 1\n" + rest), folder.path().string());
  };
  const auto refusal = [&](const std::string& rest = "") {
    return message(fogmap(whole + "file = 'map.png'\n" + rest), folder.path().string());
  };
  // The values are taken as they are (no sRGB), rows from the least z on; flip turns them.
  write_png(folder.file("map.png"), 2, 2, PNG_FORMAT_GRAY, {0, 51, 102, 255});
  CHECK(map_of(load()).map.coefficients() == std::vector<double>{0, 0.2, 0.4, 1});
  CHECK(map_of(load("flip = true\n")).map.coefficients() == std::vector<double>{0.4, 1, 0, 0.2});
  CHECK_THAT(refusal("most_pixels = 3\n"), Contains("2 x 2 pixels, expected 1 to 3"));
  write_png(folder.file("map.png"), 2, 1, PNG_FORMAT_RGB, {7, 7, 7, 9, 9, 8});
  CHECK_THAT(refusal(), Contains("column 1, row 0: colours differ"));
  write_png(folder.file("map.png"), 2, 1, PNG_FORMAT_GA, {51, 10, 102, 255});
  CHECK_THAT(map_of(load()).note, Contains("alpha"));
  write_png(folder.file("map.png"), 2, 1, PNG_FORMAT_RGB | PNG_FORMAT_FLAG_COLORMAP, {1, 0},
            {51, 51, 51, 255, 255, 255});
  CHECK(map_of(load()).map.coefficients() == std::vector<double>{1, 0.2});
  write_png(folder.file("map.png"), 2, 1, PNG_FORMAT_RGB | PNG_FORMAT_FLAG_COLORMAP, {1, 0},
            {51, 51, 50, 255, 255, 255});
  CHECK_THAT(refusal(), Contains("column 1, row 0: colours differ"));
  // A step of 8 bits costs at most sigma length / 510 of the optical depth.
  const int side = 16;
  std::vector<double> values;
  std::vector<png_byte> bytes;
  for (int i = 0; i < side * side; ++i) {
    values.push_back(0.5 + 0.5 * std::sin(1.7 * i * i));
    bytes.push_back(png_byte(std::lround(255 * values.back())));
  }
  write_png(folder.file("map.png"), side, side, PNG_FORMAT_GRAY, bytes);
  const scene::Scene coarse = load();
  auto fine = std::make_shared<scene::Fogmap>(map_of(coarse));
  fine->map = scene::SplineMap(1, fine->map.range(), values);
  double worst = 0;
  for (int i = 0; i < 64; ++i) {
    const Ray ray{{-1.0, 3, 0.5 * i}, Vec3(std::cos(0.02 * (32 - i)), 0, std::sin(0.02 * (32 - i)))};
    const double length = scene::extent(*fine, ray, {0, 100}).length();
    const double error =
        std::abs(density_integral(*fine, ray, {0, 100}) - density_integral(map_of(coarse), ray, {0, 100}));
    CHECK(error <= length / 510);
    worst = std::max(worst, error / (length / 510));
  }
  CHECK(worst > 0.01);
}

TEST_CASE("fogmaps: EXR of halfs and floats, channel Y, the only one, or named", "[load][fogmap]") {
  const TemporaryFolder folder;
  const auto text = [&](const std::string& rest) { return fogmap(whole + "file = 'map.exr'\n" + rest); };
  const auto values = [&](const std::string& rest = "") {
    return map_of(scene_of(text(rest), folder.path().string())).map.coefficients();
  };
  write_half_exr(folder.file("map.exr"), {"A", "Y"});
  CHECK(values() == std::vector<double>{0.25, 1});
  CHECK(values("channel = 'A'\n") == std::vector<double>{0.25, 0});
  write_half_exr(folder.file("map.exr"), {"fog"});
  CHECK(values() == std::vector<double>{0.25, 0});
  write_half_exr(folder.file("map.exr"), {"B", "G", "R"});
  CHECK_THAT(message(text(""), folder.path().string()), Contains("3 channels and none is Y"));
  CHECK(values("channel = 'R'\n") == std::vector<double>{0.25, 2});
  CHECK_THAT(message(text("channel = 'Q'\n"), folder.path().string()), Contains("no channel 'Q'"));
  scene::write_grey_image(folder.file("map.exr"), {2, 1, {1e-3, std::nan("")}, ""});
  CHECK_THAT(message(text(""), folder.path().string()), Contains("column 1, row 0: nan"));
}

}  // namespace fogmap_test
