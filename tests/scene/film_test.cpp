#include "scene/film/film.h"

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <png.h>
#include <signal.h>
#include <sys/resource.h>

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "scene/base/error.h"
#include "scene/film/film_exr.h"
#include "scene/film/grey_image.h"
#include "scene/light/environment.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace film_test {

using namespace airlight;
using namespace airlight::scene;
using Catch::Contains;

namespace {

// Noise, and the values that a careless copy changes: both zeros, subnormals, infinities, NaN with a payload.
Film sample_film(int width = 37, int height = 23) {
  Film film(width, height);
  std::mt19937 random(1);
  for (const char* name : {"mean", "se", "order.0", "batch.00"})
    for (float& value : film.add(name)) value = std::uniform_real_distribution<float>(-1, 1000)(random);
  std::vector<float>& odd = film.add("odd");
  const std::uint32_t bits[] = {0x80000000u, 1u, 0x807fffffu, 0x7f800000u, 0xff800000u, 0x7fc12345u, 0x00800000u};
  for (std::size_t i = 0; i < odd.size(); ++i) odd[i] = std::bit_cast<float>(bits[i % 7]);
  film.metadata = {{"scene", "0123456789abcdef"}, {"settings", "a=1 b=2\nc=3"}, {"note", "Nebel über dem Tal"}};
  film.metadata["long"] = std::string(100000, 'x');
  return film;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// A file with any channels, as another program might have written it.
void write_channels(const std::string& path, const std::vector<std::string>& names, Imf::PixelType type,
                    Imf::Compression compression, const Imath::Box2i& data, const Imath::Box2i& display,
                    int sampling = 1, const std::function<void(Imf::Header&)>& more = {}) {
  Imf::Header header(display, data);
  if (more) more(header);
  header.compression() = compression;
  const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
  std::vector<float> floats(std::size_t(width) * height, 0.5f);
  std::vector<half> halves(floats.size(), half(0.5f));
  Imf::FrameBuffer pixels;
  for (const std::string& name : names) {
    header.channels().insert(name, Imf::Channel(type, sampling, sampling));
    pixels.insert(name, type == Imf::HALF ? Imf::Slice::Make(type, halves.data(), data, 0, 0, sampling, sampling)
                                          : Imf::Slice::Make(type, floats.data(), data, 0, 0, sampling, sampling));
  }
  Imf::OutputFile file(path.c_str(), header, 1);
  file.setFrameBuffer(pixels);
  file.writePixels(height);
}

const Imath::Box2i small_window({0, 0}, {7, 3});

}  // namespace

TEST_CASE("a film comes back from OpenEXR bit for bit", "[film]") {
  const TemporaryFolder folder;
  const Film film = sample_film();
  const std::string path = folder.file("a.exr");
  write_exr(path, film, true);
  const Film back = read_exr(path);
  CHECK(back.width == film.width);
  CHECK(back.height == film.height);
  CHECK(back.metadata == film.metadata);
  REQUIRE(back.layers.size() == film.layers.size());
  for (const auto& [name, values] : film.layers) {
    CAPTURE(name);
    CHECK(same_bits(values, back.layer(name)));
  }
  CHECK(folder.entries() == 1);

  // Equal films give equal files, so that results can be compared by checksum.
  write_exr(folder.file("b.exr"), film, true);
  CHECK(read_bytes(path) == read_bytes(folder.file("b.exr")));
}

TEST_CASE("pixels of a film are addressed from the top left", "[film]") {
  Film film(3, 2);
  film.set("mean", 2, 1, Rgb(1, 2, 3));
  CHECK(film.layer("mean")[15] == 1);
  CHECK(film.layer("mean")[17] == 3);
  CHECK((film.get("mean", 2, 1) == Rgb(1, 2, 3)).all());
  CHECK_THROWS_AS(film.set("mean", 3, 0, Rgb::Zero()), Error);
  CHECK_THROWS_AS(film.get("mean", 0, -1), Error);
  CHECK_THROWS_WITH(film.layer("airlight"), "the film has no layer 'airlight'; it has: mean");
}

TEST_CASE("files of other programs are read", "[film]") {
  const TemporaryFolder folder;
  const std::string path = folder.file("other.exr");
  for (const auto compression :
       {Imf::NO_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::DWAB_COMPRESSION, Imf::RLE_COMPRESSION}) {
    const Imath::Box2i shifted({-5, 100}, {2, 103});
    write_channels(path, {"R", "G", "B", "A", "Z", "spec.R", "spec.G", "spec.B"}, Imf::HALF, compression, shifted,
                   shifted);
    const Film film = read_exr(path);
    CHECK(film.width == 8);
    CHECK(film.height == 4);
    CHECK(film.layers.size() == 2);
    // DWAB is lossy: 1 % at its default level on a constant.
    const double tolerance = compression == Imf::DWAB_COMPRESSION ? 0.005 : 0;
    CAPTURE(compression, film.get("mean", 7, 3), film.get("spec", 0, 0));
    CHECK((film.get("mean", 7, 3) - 0.5).abs().maxCoeff() <= tolerance);
    CHECK((film.get("spec", 0, 0) - 0.5).abs().maxCoeff() <= tolerance);
  }
}

TEST_CASE("files that are no film are refused in one line", "[film]") {
  const TemporaryFolder folder;
  const std::string path = folder.file("bad.exr");
  const auto message = [&] { return test::message_of([&] { read_exr(path); }); };
  const auto make = [&](const std::vector<std::string>& names, Imath::Box2i display = small_window, int sampling = 1) {
    write_channels(path, names, Imf::FLOAT, Imf::ZIP_COMPRESSION, small_window, display, sampling);
  };

  CHECK_THAT(message(), Contains("no such file") && Contains(path));
  write_bytes(path, "");
  CHECK_THAT(message(), Contains("not an OpenEXR file (0 bytes)"));
  write_bytes(path, "GIF89a of a kind");
  CHECK_THAT(message(), Contains("not an OpenEXR file"));
  make({"R", "G"});
  CHECK_THAT(message(), Contains("layer 'mean' lacks its channel 'B'") && Contains("the file has: G, R"));
  make({"R", "G", "B", "se.R"});
  CHECK_THAT(message(), Contains("layer 'se' lacks its channel 'se.G'"));
  make({"Y", "Z"});
  CHECK_THAT(message(), Contains("no channels R, G, B; it has: Y, Z"));
  make({"R", "G", "B"}, Imath::Box2i({0, 0}, {15, 15}));
  CHECK_THAT(message(), Contains("cropped"));
  make({"R", "G", "B"}, small_window, 2);
  CHECK_THAT(message(), Contains("subsampled"));
  make({"R", "G", "B"});
  CHECK(message() == "");
  CHECK_THAT(test::message_of([&] { read_exr(path, 8 * 4 * 12 - 1); }), Contains("need 384 bytes, allowed are 383"));
  CHECK_THAT(test::message_of([&] { read_exr(folder.file("")); }), Contains("not a regular file"));
}

// Green of ACES AP0 is no colour of Rec. 709: the same numbers would be another picture.
TEST_CASE("a picture with other primaries is refused", "[film]") {
  const TemporaryFolder folder;
  const std::string path = folder.file("colours.exr");
  const auto message = [&](const Imf::Chromaticities& primaries) {
    write_channels(path, {"R", "G", "B"}, Imf::FLOAT, Imf::ZIP_COMPRESSION, small_window, small_window, 1,
                   [&](Imf::Header& header) { Imf::addChromaticities(header, primaries); });
    return test::message_of([&] { read_exr(path); });
  };
  const Imath::V2f d65(0.3127f, 0.3290f);
  CHECK_THAT(message({{0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}}),
             Contains(path + ": its colours have other primaries: found chromaticities red (0.7347, 0.2653)") &&
                 Contains("expected those of Rec. 709"));
  CHECK_THAT(message({{0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f}, d65}), Contains("green (0.17, 0.797)"));
  // The primaries of Rec. 709 with another white, and a number that is none.
  CHECK_THAT(message({{0.64f, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {0.3457f, 0.3585f}}), Contains("white (0.3457"));
  CHECK_THAT(message({{std::nanf(""), 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, d65}), Contains("red (nan, 0.33)"));
  CHECK(message({{0.64f, 0.33f}, {0.3f, 0.6f}, {0.15f, 0.06f}, {0.31271f, 0.32902f}}) == "");
}

TEST_CASE("a cube map is no map of longitude and latitude", "[film][environment]") {
  const TemporaryFolder folder;
  const std::string path = folder.file("map.exr");
  const auto write = [&](Imf::Envmap kind) {
    write_channels(path, {"R", "G", "B"}, Imf::FLOAT, Imf::ZIP_COMPRESSION, small_window, small_window, 1,
                   [&](Imf::Header& header) { Imf::addEnvmap(header, kind); });
  };
  write(Imf::ENVMAP_CUBE);
  CHECK_THAT(test::message_of([&] { read_environment_map(path); }),
             Contains(path + ": found a cube map, expected a map of longitude and latitude"));
  CHECK(read_exr(path).width == 8);  // as a picture it is one
  write(Imf::ENVMAP_LATLONG);
  CHECK(read_environment_map(path)->width == 8);
}

// A part of a picture, or more than it: put at the corner it would be another map, or other depths.
TEST_CASE("a grey picture has all its pixels, and no more", "[film][grey_image]") {
  const TemporaryFolder folder;
  const std::string path = folder.file("grey.exr");
  const auto message = [&](const Imath::Box2i& data, const Imath::Box2i& display) {
    write_channels(path, {"Y"}, Imf::FLOAT, Imf::ZIP_COMPRESSION, data, display);
    return test::message_of([&] { read_grey_image(path, "", 1000); });
  };
  CHECK_THAT(message({{2, 1}, {3, 2}}, {{0, 0}, {3, 3}}), Contains(path + ": a cropped or overscanned image"));
  CHECK_THAT(message({{-1, -1}, {4, 4}}, {{0, 0}, {3, 3}}), Contains("cropped or overscanned"));
  CHECK(message({{5, 6}, {8, 9}}, {{5, 6}, {8, 9}}) == "");
}

TEST_CASE("a film cut short anywhere is refused", "[film]") {
  const TemporaryFolder folder;
  const std::string path = folder.file("cut.exr");
  Film film = sample_film();
  film.metadata.erase("long");
  write_exr(path, film, true);
  const std::string whole = read_bytes(path);
  for (std::size_t length = 0; length < whole.size(); length += 1 + whole.size() / 200) {
    write_bytes(path, whole.substr(0, length));
    CAPTURE(length, whole.size());
    CHECK_THROWS_AS(read_exr(path), Error);
  }
  write_bytes(path, whole.substr(0, whole.size() - 1));
  CHECK_THROWS_AS(read_exr(path), Error);
}

// A byte changed at random: pixel data are guarded by zlib's checksum, the header by our checks; what still loads may
// differ in metadata or names, or (a zero byte in padding) not at all, and never crashes or hangs.
TEST_CASE("a damaged film is refused or loads, and does no other harm", "[film]") {
  const TemporaryFolder folder;
  const std::string path = folder.file("damaged.exr");
  Film film = sample_film();
  film.metadata.erase("long");
  write_exr(path, film, true);
  const std::string whole = read_bytes(path);
  const std::size_t header = whole.find(std::string("screenWindowWidth")) + 34;
  std::mt19937 random(7);
  int refused = 0;
  const int trials = 400;
  for (int trial = 0; trial < trials; ++trial) {
    std::string bytes = whole;
    const std::size_t range = trial % 2 == 0 ? bytes.size() : header;
    for (int k = 0; k < 3; ++k) bytes[random() % range] = char(random());
    write_bytes(path, bytes);
    try {
      read_exr(path);
    } catch (const Error& error) {
      ++refused;
      CHECK(std::string(error.what()).find('\n') == std::string::npos);
      CHECK(std::string(error.what()).rfind(path, 0) == 0);
    }
  }
  // All of the 200 with damage anywhere (3 bytes in some 40 000) but the few that hit harmless bytes, and most of the
  // rest.
  CHECK(refused > trials / 2);
}

TEST_CASE("a write that fails leaves the old file and nothing else", "[film]") {
  const TemporaryFolder folder;
  const Film film = sample_film(200, 200);
  CHECK_THAT(test::message_of([&] { write_exr("/dev/full", film, true); }),
             Contains("/dev/full: cannot write: No space left"));
  CHECK_THAT(test::message_of([&] { write_png("/dev/full", film); }),
             Contains("/dev/full: cannot write: No space left"));
  CHECK(std::filesystem::is_character_file("/dev/full"));
  CHECK_THAT(test::message_of([&] { write_exr(folder.file("no/such/folder.exr"), film, true); }),
             Contains("No such file"));
  CHECK_THAT(test::message_of([&] { write_exr(folder.file(""), film, true); }), Contains("directory"));
  CHECK_THAT(test::message_of([&] { write_exr("/proc/airlight.exr", film, true); }),
             Contains("/proc/airlight.exr: cannot write"));

  // A limit on the file size stops the write half-way, as a full disk does.
  const std::string path = folder.file("film.exr");
  write_exr(path, film, true);
  const std::string before = read_bytes(path);
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  rlimit small = limit;
  small.rlim_cur = 10000;
  const auto previous = signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string exr = test::message_of([&] { write_exr(path, film, true); });
  const std::string png = test::message_of([&] { write_png(folder.file("film.png"), film, "mean", -10); });
  setrlimit(RLIMIT_FSIZE, &limit);
  signal(SIGXFSZ, previous);
  CHECK_THAT(exr, Contains("cannot write: File too large"));
  CHECK_THAT(png, Contains("cannot write: File too large"));
  CHECK(read_bytes(path) == before);
  CHECK(folder.entries() == 1);
}

TEST_CASE("films that cannot be stored are refused before anything is written", "[film]") {
  const TemporaryFolder folder;
  const std::string path = folder.file("film.exr");
  Film film(4, 4);
  CHECK_THROWS_AS(write_exr(path, film, true), Error);
  film.add("mean");
  film.layers["se"].resize(5);
  CHECK_THAT(test::message_of([&] { write_exr(path, film, true); }), Contains("layer 'se' has 5 values, expected 48"));
  film.layers.erase("se");
  film.add("two\nlines");
  CHECK_THROWS_WITH(write_exr(path, film, true), Contains("cannot be stored"));
  CHECK(folder.entries() == 0);
}

// sRGB of linear 0.5 is 255 * (1.055 * 0.5^(1/2.4) - 0.055) = 187.516, so 188; two stops up it is white.
TEST_CASE("previews are sRGB with an exposure", "[film]") {
  const TemporaryFolder folder;
  Film film(4, 1);
  film.set("mean", 0, 0, Rgb(0.5, 0.001, -1));
  film.set("mean", 1, 0, Rgb(2, infinity, 0.125));
  film.set("mean", 2, 0, Rgb(std::nan(""), 0.5, 0.5));
  const auto pixels_of = [&](double exposure) {
    const std::string path = folder.file("film.png");
    write_png(path, film, "mean", exposure);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&image, path.c_str()));
    CHECK(image.width == 4);
    CHECK(image.height == 1);
    image.format = PNG_FORMAT_RGB;
    std::vector<int> values;
    std::vector<png_byte> bytes(PNG_IMAGE_SIZE(image));
    REQUIRE(png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr));
    values.assign(bytes.begin(), bytes.end());
    return values;
  };
  CHECK(pixels_of(0) == std::vector<int>{188, 3, 0, 255, 255, 99, 255, 0, 255, 0, 0, 0});
  CHECK(pixels_of(2) == std::vector<int>{255, 13, 0, 255, 255, 188, 255, 0, 255, 0, 0, 0});
  CHECK_THROWS_AS(write_png(folder.file("x.png"), film, "airlight"), Error);
}

TEST_CASE("layers of 16-bit floats hold what such floats hold, and refuse the rest", "[film]") {
  const TemporaryFolder folder;
  Film film(3, 2);
  film.add("mean")[4] = 1.0f / 3;
  film.add("steps")[7] = -2047;
  write_exr_with_halves(folder.file("a.exr"), film, {"steps"});
  CHECK(read_exr(folder.file("a.exr")).layers == film.layers);
  for (const float value : {2049.0f, 1.0f / 3, 1e5f}) {
    film.layers["steps"][7] = value;
    CHECK_THROWS_WITH(write_exr_with_halves(folder.file("b.exr"), film, {"steps"}),
                      Contains("b.exr: layer 'steps'") && Contains("no 16-bit float"));
  }
  CHECK(folder.entries() == 1);
}

}  // namespace film_test
