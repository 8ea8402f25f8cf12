// Pictures with depth behind a medium: where rays meet them, who sees them, and what is refused when one is read.
#include "scene/backdrop.h"

#include <png.h>

#include <bit>
#include <cmath>
#include <fstream>

#include "scene/film/film.h"
#include "scene/light/background.h"
#include "scene/renderer.h"
#include "tests/scene/load/message.h"
#include "tests/temporary_folder.h"

namespace backdrop_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

namespace {

const std::string perspective = "[film]\nwidth = 4\nheight = 2\n" + camera;

// 4 x 2 pixels: of pixel i R = i / 10, depth 3 + i, but the last has no end.
void write_inputs(const std::filesystem::path& folder) {
  scene::Film film(4, 2);
  film.add("mean");
  film.add("distance");
  for (int i = 0; i < 8; ++i) {
    film.set("mean", i % 4, i / 4, Rgb(0.1 * i, 0.5, 0.25));
    film.set("distance", i % 4, i / 4, Rgb::Constant(i < 7 ? 3 + i : 0));
  }
  scene::write_exr((folder / "film.exr").string(), film);
  std::ofstream pfm(folder / "depth.pfm", std::ios::binary);
  pfm << "Pf\n4 2\n-1.0\n";
  for (const int row : {1, 0})
    for (int x = 0; x < 4; ++x) {
      const float value = row * 4 + x < 7 ? float(3 + row * 4 + x) : float(infinity);
      pfm.write(reinterpret_cast<const char*>(&value), 4);
    }
}

std::string backdrop(const std::string& rest) { return perspective + "[backdrop]\n" + rest; }

void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string png_of(int width, int height, std::uint32_t format, const std::vector<png_byte>& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = png_uint_32(width);
  image.height = png_uint_32(height);
  image.format = format;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string file(size, '\0');
  REQUIRE(png_image_write_to_memory(&image, file.data(), &size, 0, bytes.data(), 0, nullptr));
  return file.substr(0, size);
}

std::string pfm_of(const std::string& header, const std::vector<float>& values) {
  return header + std::string(reinterpret_cast<const char*>(values.data()), 4 * values.size());
}

}  // namespace

TEST_CASE("each camera ray ends at the pixel of the backdrop that it goes through", "[backdrop]") {
  const TemporaryFolder folder;
  write_inputs(folder.path());
  for (const bool along_ray : {false, true})
    for (const bool pfm : {false, true}) {
      CAPTURE(along_ray, pfm);
      const auto scene = scene::parse_scene(
          backdrop(std::string("image = 'film.exr'\nscale = 2\ndepth_scale = 0.5\nalong = '") +
                   (along_ray ? "ray" : "view") + (pfm ? "'\ndepth = 'depth.pfm'\n" : "'\nchannel = 'distance.R'\n")),
          "s.toml", folder.path().string());
      // On a film of another size the nearest pixel; a narrower film sees the middle columns.
      for (const auto& [width, height] : {std::pair(4, 2), std::pair(8, 4), std::pair(2, 2), std::pair(12, 4)})
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x) {
            CAPTURE(width, height, x, y);
            const Ray ray = camera_ray(scene.camera, x + 0.5, y + 0.5, width, height);
            const double column = (x + 0.5 - 0.5 * width) * 2 / height + 2;
            const int i = y * 2 / height * 4 + std::clamp(int(std::floor(column)), 0, 3);
            const scene::RayEnd end = camera_end(scene, ray);
            REQUIRE(end.seen);
            CHECK(!end.hit);
            CHECK(end.seen->isApprox(Rgb(0.2 * i, 1, 0.5), 1e-6));
            const double ahead = ray.direction.dot(scene.camera.forward);
            if (i == 7)
              CHECK(end.t == infinity);
            else if (!along_ray)
              CHECK(end.t * ahead == Approx(0.5 * (3 + i)).epsilon(1e-6));
            else if (width == 4)
              CHECK(end.t == Approx(0.5 * (3 + i)).epsilon(1e-6));
            // Nothing but the camera's own rays meets it.
            CHECK(ray_end(scene, ray).t == infinity);
          }
    }
}

TEST_CASE("a nearer surface hides the backdrop, and the backdrop a farther one", "[backdrop]") {
  const TemporaryFolder folder;
  write_inputs(folder.path());
  const std::string wall = "[[surface]]\ntype = 'plane'\nnormal = [0, 0, 1]\npoint = [0, 0, ";
  const auto with_wall = [&](const std::string& z) {
    return scene::parse_scene(backdrop("image = 'film.exr'\nchannel = 'distance.R'\n") + wall + z + "]\n", "s.toml",
                              folder.path().string());
  };
  const scene::Scene near = with_wall("3"), far = with_wall("-9");
  const Ray ray = camera_ray(near.camera, 1.5, 0.5, 4, 2);
  CHECK(camera_end(near, ray).hit);
  CHECK(!camera_end(near, ray).seen);
  CHECK(!camera_end(far, ray).hit);
  CHECK(camera_end(far, ray).seen);
  CHECK(ray_end(far, ray).hit);
  // A pixel with infinite depth is behind every surface, and in front of environments.
  CHECK(camera_end(far, camera_ray(far.camera, 3.5, 1.5, 4, 2)).hit);
}

TEST_CASE("a picture in 8 bits is sRGB, a PNG of depths is linear", "[backdrop]") {
  const TemporaryFolder folder;
  write_bytes(folder.path() / "p.png", png_of(2, 1, PNG_FORMAT_RGB, {0, 128, 255, 10, 188, 64}));
  write_bytes(folder.path() / "z.png", png_of(2, 1, PNG_FORMAT_GRAY, {51, 0}));
  const auto scene = scene::parse_scene(backdrop("image = 'p.png'\ndepth = 'z.png'\ndepth_scale = 10\n"), "s.toml",
                                        folder.path().string());
  const scene::Backdrop& read = *scene.backdrops.at(0);
  const auto linear = [](int v) {
    return v / 255.0 <= 0.04045 ? v / 255.0 / 12.92 : std::pow((v / 255.0 + 0.055) / 1.055, 2.4);
  };
  const int bytes[] = {0, 128, 255, 10, 188, 64};
  for (int i = 0; i < 6; ++i) CHECK(read.radiance[i] == Approx(linear(bytes[i])).epsilon(1e-6));
  CHECK(read.depth[0] == Approx(2).epsilon(1e-6));
  CHECK(read.depth[1] == float(infinity));
}

TEST_CASE("what a stereo pair does not know lies behind what it knows", "[backdrop]") {
  const TemporaryFolder folder;
  write_bytes(folder.path() / "p.png", png_of(4, 1, PNG_FORMAT_RGB, std::vector<png_byte>(12, 100)));
  const float unknown = float(infinity);
  write_bytes(folder.path() / "d.pfm", pfm_of("Pf\n4 1\n-1\n", {1, unknown, unknown, 4}));
  const std::string text = backdrop("image = 'p.png'\ndepth = 'd.pfm'\ndisparity = { factor = 10, offset = 1 }\n");
  const auto scene = scene::parse_scene(text, "s.toml", folder.path().string());
  CHECK(scene.backdrops.at(0)->depth == std::vector<float>{5, 5, 5, 2});
}

TEST_CASE("the content of a backdrop is part of the scene's hash", "[backdrop]") {
  const TemporaryFolder folder;
  write_inputs(folder.path());
  const auto hash = [&](const std::string& text) {
    return scene::parse_scene(text, "s.toml", folder.path().string()).hash;
  };
  const std::string film = "image = 'film.exr'\n";
  const std::string one = hash(backdrop(film + "channel = 'distance.R'\n"));
  CHECK(one == hash(backdrop(film + "depth = 'depth.pfm'\n")));  // an equal backdrop, written in another way
  CHECK(one != hash(backdrop(film + "channel = 'distance.R'\nscale = 2\n")));
  CHECK(one != hash(backdrop(film + "channel = 'distance.R'\ndepth_scale = 2\n")));
  CHECK(one != hash(perspective));
}

TEST_CASE("another camera than the scene's sees no backdrop", "[backdrop]") {
  const TemporaryFolder folder;
  write_inputs(folder.path());
  const auto scene =
      scene::parse_scene(backdrop("image = 'film.exr'\nchannel = 'distance.R'\n"), "s.toml", folder.path().string());
  scene::View view = view_of(scene);
  view.width = 100;
  CHECK_NOTHROW(require_own_camera(scene, view));
  view.camera.position += Vec3(0, 0, 1e-9);
  CHECK_THROWS_WITH(require_own_camera(scene, view), Contains("belongs to the scene's own camera"));
}

TEST_CASE("a backdrop that cannot be read is refused in one line", "[backdrop][load]") {
  const TemporaryFolder folder;
  write_inputs(folder.path());
  const auto file = [&](const char* name) { return folder.path() / name; };
  const std::string png = png_of(4, 2, PNG_FORMAT_RGB, std::vector<png_byte>(24, 100));
  write_bytes(file("p.png"), png);
  write_bytes(file("cut.png"), png.substr(0, png.size() - 20));
  write_bytes(file("alpha.png"), png_of(4, 2, PNG_FORMAT_RGBA, std::vector<png_byte>(32, 100)));
  write_bytes(file("small.pfm"), pfm_of("Pf\n2 2\n-1\n", {1, 2, 3, 4}));
  write_bytes(file("cut.pfm"), pfm_of("Pf\n4 2\n-1\n", {1, 2, 3, 4}));
  write_bytes(file("colour.pfm"), pfm_of("PF\n4 2\n-1\n", std::vector<float>(24, 1)));
  write_bytes(file("huge.pfm"), "Pf\n99999999 99999999\n-1\n");
  write_bytes(file("nan.pfm"), pfm_of("Pf\n4 2\n-1\n", {1, 1, 1, 1, 1, std::nanf(""), 1, 1}));
  write_bytes(file("minus.pfm"), pfm_of("Pf\n4 2\n-1\n", {1, 1, 1, 1, 1, -2, 1, 1}));
  write_bytes(file("no.pfm"), "hello");
  scene::Film bad(4, 2);
  bad.add("mean")[5] = std::nanf("");
  scene::write_exr(file("nan.exr").string(), bad, true);
  bad.add("mean")[5] = -1;
  scene::write_exr(file("minus.exr").string(), bad);
  const auto said = [&](const std::string& image, const std::string& rest) {
    const std::string line = message(backdrop("image = '" + image + "'\n" + rest), folder.path().string());
    CHECK(std::count(line.begin(), line.end(), '\n') == 0);
    return line;
  };
  const std::string depth = "depth = 'depth.pfm'\n";
  CHECK_THAT(said("none.png", depth), Contains("s.toml:8:") && Contains("none.png"));
  CHECK_THAT(said("cut.png", depth), Contains("cut.png") && Contains("damaged PNG"));
  CHECK_THAT(said("alpha.png", depth), Contains("alpha channel"));
  CHECK_THAT(said("depth.pfm", depth), Contains("expected a name in .png, .jpg, .hdr or .exr"));
  CHECK_THAT(said("nan.exr", depth), Contains("column 1, row 0: nan"));
  CHECK_THAT(said("minus.exr", depth), Contains("column 1, row 0: -1"));
  CHECK_THAT(said("film.exr", depth + "layer = 'no'\n"), Contains("no"));
  CHECK_THAT(said("p.png", ""), Contains("missing key 'depth'"));
  CHECK_THAT(said("film.exr", ""), Contains("missing key 'depth'"));
  CHECK_THAT(said("p.png", "depth = 'none.pfm'\n"), Contains("none.pfm"));
  CHECK_THAT(said("p.png", "depth = 'small.pfm'\n"), Contains("2 x 2 pixels, expected 4 x 2"));
  CHECK_THAT(said("p.png", "depth = 'cut.pfm'\n"), Contains("16 bytes of pixels, expected 32"));
  CHECK_THAT(said("p.png", "depth = 'colour.pfm'\n"), Contains("expected one channel"));
  CHECK_THAT(said("p.png", "depth = 'huge.pfm'\n"), Contains("expected 1 to 16384 a side"));
  CHECK_THAT(said("p.png", "depth = 'no.pfm'\n"), Contains("no PFM file"));
  CHECK_THAT(said("p.png", "depth = 'nan.pfm'\n"), Contains("column 1, row 0: a depth of nan m"));
  CHECK_THAT(said("p.png", "depth = 'minus.pfm'\n"), Contains("column 1, row 0: a depth of -2 m"));
  CHECK_THAT(said("p.png", depth + "scale = -1\n"), Contains("scale = -1"));
  CHECK_THAT(said("p.png", depth + "along = 'z'\n"), Contains("along"));
  CHECK_THAT(said("p.png", "depth = 'film.exr'\nchannel = 'Z'\n"), Contains("no channel 'Z'"));
}

}  // namespace backdrop_test
