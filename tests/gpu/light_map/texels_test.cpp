// Maps of lights made on the device against those of the processor, texel by texel.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>

#include "gpu/light_map/light_maps.h"
#include "gpu/ray_marcher/scene_data.h"
#include "reference/ray_marcher/light_maps.h"
#include "tests/gpu/device.h"
#include "tests/reference/ray_marcher/march_scenes.h"

namespace texels_test {

using namespace airlight;
using namespace airlight::light_map;
using ray_marcher::make_medium;

namespace {

constexpr Encoding all_encodings[] = {Encoding::slices, Encoding::avsm, Encoding::fourier, Encoding::beer};

// One of each projection: parallel rays, the whole sphere, the cap that sees the box from near and from far away, a cone.
std::vector<scene::Light> lights() {
  return {scene::DirectionalLight{Vec3(1, 2, 0.5).normalized(), Rgb::Ones()},
          scene::PointLight{Point3(0.1, 0.3, -0.1), Rgb::Ones(), 0},
          scene::PointLight{Point3(1.8, 1, 1.3), Rgb::Ones(), 0},
          scene::PointLight{Point3(3000, 5000, -7000), Rgb::Ones(), 0},
          scene::SpotLight{Point3(0, 1.5, 0.5), Vec3(0.1, -1, -0.2).normalized(), 0.2, 0.35, Rgb::Ones(), 0}};
}

struct Maps {
  std::vector<std::shared_ptr<const LightMap>> processor;
  std::unique_ptr<gpu::light_map::LightMaps> device;
};

Maps make(gpu::Context& context, const std::vector<scene::Medium>& media, const Options& options,
          const std::function<bool(double)>& progress = {}) {
  const auto layers = ray_marcher::make_layers(media);
  const gpu::ray_marcher::MediaOnDevice on_device(context, layers, gpu::ray_marcher::middle_of(layers, Point3::Zero()),
                                                  gpu::ray_marcher::GridStorage::automatic);
  return {make_maps(lights(), media, options, ray_marcher::densities_by_kernels(layers, media), {1, {}}, "texels_test")
              .of_lights,
          std::make_unique<gpu::light_map::LightMaps>(context, on_device, media, layers, lights(), options, progress)};
}

// Greatest difference of two texels. Optical depths and series are relative to the greatest of the map. Curves of
// transmittance are compared without scale, since rounding may decide which nodes they keep.
double difference(const Options& o, const float* a, const float* b) {
  double most = 0;
  if (o.encoding != Encoding::avsm) {
    for (int k = 0; k < floats_per_texel(o); ++k) most = std::max(most, std::abs(double(a[k]) - b[k]));
    return most;
  }
  for (int k = 0; k <= 100; ++k)
    most = std::max(most, std::abs(std::exp(-decode(o, a, 0.01 * k)) - std::exp(-decode(o, b, 0.01 * k))));
  return most;
}

// The 99th percentile and the greatest of all texels and lights.
std::pair<double, double> differences(const Maps& maps, const Options& o) {
  std::vector<double> all;
  const int floats = floats_per_texel(o), side = o.size + 2;
  for (std::size_t l = 0; l < maps.processor.size(); ++l) {
    const LightMap& map = *maps.processor[l];
    for (int plane = 0; plane < maps.device->planes(); ++plane) {
      const std::vector<float> texels = maps.device->texels(int(l), plane);
      double scale = 1e-300;
      if (o.encoding == Encoding::avsm) scale = 1;
      for (int j = -1; j <= o.size && scale != 1; ++j)
        for (int i = -1; i <= o.size; ++i)
          for (int k = 0; k < floats; ++k) scale = std::max(scale, std::abs(double(map.texel(plane, i, j)[k])));
      for (int j = -1; j <= o.size; ++j)
        for (int i = -1; i <= o.size; ++i)
          all.push_back(difference(o, map.texel(plane, i, j), texels.data() + ((j + 1) * side + i + 1) * floats) /
                        scale);
    }
  }
  std::sort(all.begin(), all.end());
  return {all[std::size_t(0.99 * double(all.size() - 1))], all.back()};
}

Options options_for(Encoding encoding, int size = 21, int steps = 60) {
  Options o;
  o.encoding = encoding, o.size = size, o.steps = steps;
  return o;
}

void agree(gpu::Context& context, const std::string& name, const std::vector<scene::Medium>& media, const Options& o,
           double p99, double worst) {
  const auto [usual, most] = differences(make(context, media, o), o);
  if (std::getenv("AIRLIGHT_TEST_FIGURES"))
    fmt::print("{} {}: p99 {:.1e}, worst {:.1e}\n", name, encoding_name(o.encoding), usual, most);
  CAPTURE(name, encoding_name(o.encoding), usual, most);
  CHECK(usual < p99);
  CHECK(most < worst);
}

}  // namespace

DEVICE_TEST_CASE("light maps: texels of the device are those of the processor", "[gpu][light_map]") {
  for (const auto& [name, scene] : ray_marcher::assorted_scenes()) {
    if (name == "overlap with surfaces under the sky") continue;  // the media of another
    for (const Encoding encoding : all_encodings) {
      const Options o = options_for(encoding);
      const VariedMedia varied = varied_media(scene->media, o);
      if (varied.planes == 0) {
        CHECK(make(context, scene->media, o).device->planes() == 0);
        continue;
      }
      // Measured: 4.2e-7 and 7.5e-7 for slices and series. Rounding may decide which node avsm removes,
      // and which step of beer is empty.
      const bool avsm = encoding == Encoding::avsm, beer = encoding == Encoding::beer;
      agree(context, name, scene->media, o, beer ? 1.3e-5 : 1.3e-6, avsm ? 3e-3 : beer ? 1.6e-4 : 2.3e-6);
    }
  }
}

// More texels than one dispatch takes where somebody may stop it, and more steps of avsm than loops may have.
DEVICE_TEST_CASE("light maps: made in parts they are the same, and can be stopped", "[gpu][light_map]") {
  scene::GaussianSum sum;
  sum.gaussians = {{Point3(0.1, 0.2, 0), 0.3, 2.0}, {Point3(-0.4, 0, 0.3), 0.2, 3.0}};
  const std::vector<scene::Medium> media = {make_medium(sum, scene::Unbounded{}, Rgb(2, 3, 4), Rgb::Ones())};
  Options o = options_for(Encoding::avsm, 100, 300);
  o.nodes = 64;
  int looks = 0;
  const Maps whole = make(context, media, o), parts = make(context, media, o, [&](double) { return ++looks > 0; });
  CHECK(looks == 10);
  for (int l = 0; l < 5; ++l) CHECK(parts.device->texels(l, 2) == whole.device->texels(l, 2));
  CHECK(differences(whole, o).first < 1.3e-6);
  CHECK_THROWS_AS(make(context, media, o, [&](double) { return ++looks < 14; }), scene::Interrupted);
}

DEVICE_TEST_CASE("light maps: what the device has no room for is refused in one line", "[gpu][light_map]") {
  if (context.limits().storage_block > std::size_t(128) << 20) {
    WARN("test skipped: storage buffers of this device are larger");
    return;
  }
  const std::vector<scene::Medium> media = {make_medium(scene::GaussianSum{{{Point3::Zero(), 0.3, 1}}, 0, infinity},
                                                        scene::Unbounded{}, Rgb(2, 3, 4), Rgb::Ones())};
  const auto layers = ray_marcher::make_layers(media);
  const gpu::ray_marcher::MediaOnDevice on_device(context, layers, Point3::Zero(),
                                                  gpu::ray_marcher::GridStorage::automatic);
  CHECK_THROWS_WITH(gpu::light_map::LightMaps(context, on_device, media, layers, lights(),
                                              options_for(Encoding::slices, 1024, 16), {}),
                    Catch::Contains("buffer 'maps of 5 lights' needs"));
}

}  // namespace texels_test
