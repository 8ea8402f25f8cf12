// Pictures in colour: what JPEG files and Radiance pictures say, and what is refused.
#include "scene/film/color_image.h"

#include <turbojpeg.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "scene/base/error.h"
#include "scene/light/environment.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace color_image_test {

using namespace airlight;
using namespace airlight::scene;
using Catch::Contains;

namespace {

double linear(double byte) {
  const double v = byte / 255;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// 16 x 8 pixels: red grows to the right, green downwards; CMYK where there are four channels.
std::string jpeg(TJPF format, int flags = 0) {
  const int channels = tjPixelSize[format];
  std::vector<unsigned char> pixels;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x)
      for (int c = 0; c < channels; ++c)
        pixels.push_back(static_cast<unsigned char>(c == 0 ? 16 * x : c == 1 ? 32 * y : 100));
  const tjhandle encoder = tjInitCompress();
  unsigned char* file = nullptr;
  unsigned long size = 0;
  REQUIRE(tjCompress2(encoder, pixels.data(), 16, 0, 8, format, &file, &size,
                      format == TJPF_GRAY ? TJSAMP_GRAY : TJSAMP_444, 100, flags) == 0);
  std::string bytes(reinterpret_cast<char*>(file), size);
  tjFree(file);
  tjDestroy(encoder);
  return bytes;
}

const std::string head = "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n";

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int v : values) text += char(v);
  return text;
}

struct Files {
  TemporaryFolder folder;
  ColorImage read(const std::string& name, const std::string& content) {
    folder.write(name, content);
    return read_color_image(folder.file(name));
  }
  std::string refusal(const std::string& name, const std::string& content) {
    folder.write(name, content);
    const std::string line = test::message_of([&] { read_color_image(folder.file(name)); });
    CHECK_THAT(line, Contains(name));
    CHECK(std::count(line.begin(), line.end(), '\n') == 0);
    return line;
  }
};

}  // namespace

TEST_CASE("a JPEG is sRGB", "[film][color_image]") {
  Files files;
  for (const int flags : {0, TJFLAG_PROGRESSIVE}) {
    const ColorImage image = files.read(flags ? "a.jpeg" : "a.JPG", jpeg(TJPF_RGB, flags));
    REQUIRE(image.width == 16);
    REQUIRE(image.height == 8);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x) {
        const double want[3] = {16.0 * x, 32.0 * y, 100};
        for (std::size_t c = 0; c < 3; ++c) {
          const float value = image.rgb[std::size_t(3 * (16 * y + x)) + c];
          CHECK(value >= linear(std::max(0.0, want[c] - 3)));  // quality 100 keeps colours to 3 of 255
          CHECK(value <= linear(std::min(255.0, want[c] + 3)));
        }
      }
  }
  const ColorImage grey = files.read("grey.jpg", jpeg(TJPF_GRAY));
  for (std::size_t i = 0; i < grey.rgb.size(); i += 3) CHECK(grey.rgb[i] == grey.rgb[i + 2]);
}

TEST_CASE("a JPEG that cannot be read is refused", "[film][color_image]") {
  Files files;
  const std::string good = jpeg(TJPF_RGB);
  CHECK_THAT(files.refusal("ink.jpg", jpeg(TJPF_CMYK)), Contains("printing inks"));
  CHECK_THAT(files.refusal("cut.jpg", good.substr(0, good.size() / 2)), Contains("damaged JPEG"));
  CHECK_THAT(files.refusal("short.jpg", good.substr(0, 20)), Contains("damaged JPEG"));
  CHECK_THAT(files.refusal("text.jpg", "no picture"), Contains("no JPEG file (10 bytes)"));
}

TEST_CASE("a Radiance picture is linear", "[film][color_image]") {
  Files files;
  // Flat: 2 x 1 pixels. 128 / 256 * 2^(129 - 128) = 1.
  const ColorImage flat = files.read("flat.hdr", head + "\n-Y 1 +X 2\n" + bytes({128, 64, 0, 129, 200, 100, 50, 0}));
  CHECK(flat.rgb == std::vector<float>{1, 0.5, 0, 0, 0, 0});
  // Radiance keeps pixels times the exposure; several multiply.
  const ColorImage exposed =
      files.read("exposed.hdr", head + "EXPOSURE=4\r\nEXPOSURE= 0.5\n\n-Y 1 +X 1\n" + bytes({128, 64, 32, 130}));
  CHECK(exposed.rgb == std::vector<float>{1, 0.5, 0.25});
  // Runs of pixels: (1, 1, 1, n) repeats the pixel before n times.
  const ColorImage runs = files.read("runs.hdr", head + "\n-Y 2 +X 4\n" + bytes({128, 64, 0, 129, 1, 1, 1, 3}) +
                                                     bytes({64, 0, 0, 129, 1, 1, 1, 1, 0, 64, 0, 129, 0, 0, 64, 129}));
  CHECK(runs.rgb ==
        std::vector<float>{1, 0.5, 0, 1, 0.5, 0, 1, 0.5, 0, 1, 0.5, 0, 0.5, 0, 0, 0.5, 0, 0, 0, 0.5, 0, 0, 0, 0.5});
  // Runs in planes: each channel of a row by itself.
  const ColorImage planes =
      files.read("planes.hdr", head + "\n-Y 1 +X 8\n" + bytes({2, 2, 0, 8}) + bytes({128 + 8, 128}) +
                                   bytes({4, 0, 64, 128, 192, 128 + 4, 64}) + bytes({128 + 8, 0}) +
                                   bytes({128 + 4, 129, 128 + 4, 130}));
  CHECK(planes.rgb == std::vector<float>{1, 0, 0, 1, 0.5, 0, 1, 1, 0, 1, 1.5, 0, 2, 1, 0, 2, 1, 0, 2, 1, 0, 2, 1, 0});
  const auto map = read_environment_map(files.folder.file("planes.hdr"));
  CHECK(map->width == 8);
  CHECK(map->rgb == planes.rgb);
}

TEST_CASE("a Radiance picture that cannot be read is refused", "[film][color_image]") {
  Files files;
  const auto refusal = [&](const std::string& content) { return files.refusal("a.hdr", content); };
  CHECK_THAT(refusal("P6 2 2"), Contains("no Radiance picture (6 bytes)"));
  CHECK_THAT(refusal("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n1234"),
             Contains("expected FORMAT=32-bit_rle_rgbe"));
  CHECK_THAT(refusal("#?RADIANCE\n\n-Y 1 +X 1\n1234"), Contains("no FORMAT"));
  CHECK_THAT(refusal(head), Contains("no end"));
  CHECK_THAT(refusal(head + "EXPOSURE=0\n\n-Y 1 +X 1\n1234"), Contains("found EXPOSURE=0, expected a number above 0"));
  CHECK_THAT(refusal(head + "\n+X 1 -Y 1\n1234"), Contains("found '+X 1 -Y 1', expected -Y HEIGHT +X WIDTH"));
  CHECK_THAT(refusal(head + "\n-Y 1 +X 99999\n1234"), Contains("expected 1 to 16384 a side"));
  CHECK_THAT(refusal(head + "\n-Y 2 +X 1\n1234"), Contains("it ends in row 1 of 2"));
  CHECK_THAT(refusal(head + "\n-Y 1 +X 2\n" + bytes({1, 1, 1, 2})), Contains("a run leaves row 0"));
  CHECK_THAT(refusal(head + "\n-Y 1 +X 2\n" + bytes({9, 9, 9, 129, 1, 1, 1, 2})), Contains("a run leaves row 0"));
  CHECK_THAT(refusal(head + "\n-Y 1 +X 8\n" + bytes({2, 2, 0, 9})), Contains("row 0 has 9 pixels, expected 8"));
  CHECK_THAT(refusal(head + "\n-Y 1 +X 8\n" + bytes({2, 2, 0, 8, 128 + 9, 1})), Contains("a run leaves row 0"));
  CHECK_THAT(refusal(head + "\n-Y 1 +X 8\n" + bytes({2, 2, 0, 8, 0})), Contains("a run leaves row 0"));
}

// Whatever stands in a file, a reader ends with a picture or with one line.
TEST_CASE("changed pictures are read or refused", "[film][color_image]") {
  Files files;
  std::mt19937 random(7);
  const std::string radiance = head + "EXPOSURE=2\n\n-Y 3 +X 8\n" + bytes({2, 2, 0, 8}) + bytes({128 + 8, 128}) +
                               bytes({128 + 8, 64}) + bytes({128 + 8, 32}) + bytes({128 + 8, 129}) +
                               std::string(64, '\x40');
  int read = 0, refused = 0;
  for (const auto& [name, good] : {std::pair<std::string, std::string>{"a.jpg", jpeg(TJPF_RGB)}, {"a.hdr", radiance}})
    for (int i = 0; i < 500; ++i) {
      std::string changed = good;
      for (unsigned n = 1 + random() % 3; n > 0; --n) changed[random() % changed.size()] = char(random());
      if (random() % 4 == 0) changed.resize(random() % changed.size() + 1);
      try {
        const ColorImage image = files.read(name, changed);
        CHECK(image.rgb.size() == std::size_t(image.width) * std::size_t(image.height) * 3);
        ++read;
      } catch (const Error&) {
        ++refused;
      }
    }
  CHECK(read > 100);
  CHECK(refused > 100);
}

}  // namespace color_image_test
