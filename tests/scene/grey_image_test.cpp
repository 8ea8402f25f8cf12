// Grey images: what PNG and EXR files say, and what is refused.
#include "scene/film/grey_image.h"

#include <png.h>

#include <catch2/catch.hpp>
#include <limits>

#include "scene/base/error.h"
#include "scene/film/film.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace grey_image_test {

using namespace airlight;
using namespace airlight::scene;
using Catch::Contains;

namespace {

// 3 x 2 pixels of 8 bits a channel.
std::string png(std::uint32_t format, const std::vector<png_byte>& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 3;
  image.height = 2;
  image.format = format;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string file(size, 0);
  REQUIRE(png_image_write_to_memory(&image, file.data(), &size, 0, bytes.data(), 0, nullptr));
  file.resize(size);
  return file;
}

std::string refusal(const std::string& path, const std::string& channel = "", std::size_t most = 1000) {
  return test::message_of([&] { read_grey_image(path, channel, most); });
}

}  // namespace

TEST_CASE("grey images: 8 and 16 bits, colours that are grey", "[grey_image]") {
  const TemporaryFolder folder;
  folder.write("grey.png", png(PNG_FORMAT_GRAY, {0, 1, 51, 102, 204, 255}));
  const GreyImage grey = read_grey_image(folder.file("grey.png"), "", 6);
  CHECK(grey.width == 3);
  CHECK(grey.height == 2);
  CHECK(grey.values == std::vector<double>{0, 1 / 255.0, 0.2, 0.4, 0.8, 1});
  CHECK(grey.note.empty());
  folder.write("rgb.png",
               png(PNG_FORMAT_RGB, {0, 0, 0, 1, 1, 1, 51, 51, 51, 102, 102, 102, 204, 204, 204, 255, 255, 255}));
  CHECK(read_grey_image(folder.file("rgb.png"), "", 6).values == grey.values);
  folder.write("alpha.png", png(PNG_FORMAT_GA, {0, 9, 1, 255, 51, 200, 102, 0, 204, 3, 255, 4}));
  CHECK_THAT(read_grey_image(folder.file("alpha.png"), "", 6).note, Contains("alpha"));
  // 16 bits, big-endian in the file: v / 65535 comes back exactly.
  const GreyImage deep{3, 2, {0, 1 / 65535.0, 256 / 65535.0, 257 / 65535.0, 65534 / 65535.0, 1}, ""};
  write_grey_image(folder.file("deep.png"), deep);
  CHECK(read_grey_image(folder.file("deep.png"), "", 6).values == deep.values);
  write_grey_image(folder.file("deep.exr"), {3, 2, {0, -1.5, 1e6, 0.25, 3, 1}, ""});
  CHECK(read_grey_image(folder.file("deep.exr"), "", 6).values == std::vector<double>{0, -1.5, 1e6, 0.25, 3, 1});
}

TEST_CASE("grey images: what is wrong is named", "[grey_image]") {
  const TemporaryFolder folder;
  folder.write("rgb.png",
               png(PNG_FORMAT_RGB, {0, 0, 0, 1, 1, 1, 51, 51, 51, 102, 102, 102, 204, 205, 204, 255, 255, 255}));
  CHECK_THAT(refusal(folder.file("rgb.png")), Contains("column 1, row 1: colours differ"));
  const std::string whole = png(PNG_FORMAT_GRAY, {0, 1, 51, 102, 204, 255});
  folder.write("cut.png", whole.substr(0, whole.size() - 20));
  CHECK_THAT(refusal(folder.file("cut.png")), Contains("damaged PNG"));
  std::string changed = whole;
  changed[whole.size() - 30] = char(changed[whole.size() - 30] ^ 0x55);
  folder.write("changed.png", changed);
  CHECK_THAT(refusal(folder.file("changed.png")), Contains("damaged PNG"));
  folder.write("whole.png", whole);
  CHECK_THAT(refusal(folder.file("whole.png"), "", 5), Contains("3 x 2 pixels, expected 1 to 5"));
  CHECK_THAT(refusal(folder.file("whole.png"), "Y"), Contains("EXR files only"));
  folder.write("text.png", "hello, this is text");
  CHECK_THAT(refusal(folder.file("text.png")), Contains("no PNG file"));
  folder.write("empty.png", "");
  CHECK_THAT(refusal(folder.file("empty.png")), Contains("empty"));
  CHECK_THAT(refusal(folder.file("missing.exr")), Contains("no such file"));
  CHECK_THAT(refusal(folder.file("map.tif")), Contains(".png or .exr"));
  write_grey_image(folder.file("nan.exr"), {3, 2, {0, 1, 2, 3, std::numeric_limits<double>::quiet_NaN(), 5}, ""});
  CHECK_THAT(refusal(folder.file("nan.exr")), Contains("column 1, row 1: nan"));
  CHECK_THAT(refusal(folder.file("nan.exr"), "Z"), Contains("no channel 'Z'; it has: Y"));
  Film film(3, 2);
  film.add("mean");
  write_exr(folder.file("film.exr"), film);
  CHECK_THAT(refusal(folder.file("film.exr")), Contains("3 channels and none is Y"));
  CHECK(read_grey_image(folder.file("film.exr"), "G", 6).values == std::vector<double>(6, 0));
  CHECK_THROWS_AS(write_grey_image(folder.file("big.png"), {1, 1, {1.5}, ""}), Error);
}

}  // namespace grey_image_test
