// The probes of residuals: every store gives back what was put in, and pictures are the nearer the more of the residual is kept.
#include "experiments/compensated_ray_marching/residual_probe.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/compensated_ray_marching/fitted_picture_probe.h"
#include "experiments/compensated_ray_marching/fitted_smoke.h"
#include "experiments/compensated_ray_marching/gaussian_fit_probe.h"
#include "experiments/compensated_ray_marching/nano_grid.h"
#include "experiments/compensated_ray_marching/residual_decode_probe.h"
#include "scene/base/data_folder.h"
#include "scene/base/error.h"
#include "tests/gpu/device.h"
#include "tests/temporary_folder.h"

namespace residual_probe_test {

using namespace airlight;
using namespace airlight::experiments;

namespace {

std::map<std::string, double> figures(const Probe& probe, const ProbeInput& input,
                                      const std::map<std::string, std::string>& given) {
  std::map<std::string, double> values;
  for (const Measure& m : probe.run(input, scene::Settings(probe.settings(), given), {}).figures)
    values[m.name] = m.value;
  return values;
}

std::map<std::string, std::string> small_noise(const std::string& store) {
  return {{"store", store},    {"smoke", "noise"},  {"size", "24"},
          {"gaussians", "20"}, {"lookups", "2000"}, {"runs", "1"}};
}

}  // namespace

TEST_CASE("every store of a residual holds it and says how large it is", "[residual]") {
  const ResidualStores probe;
  std::map<std::string, double> kB;
  for (const char* const store :
       {"raw", "bricks", "apron", "hash_tags", "hash_domain", "hash_sequence", "nano_floats", "nano_eight_bits"}) {
    INFO(store);
    const auto found = figures(probe, {}, small_noise(store));
    kB[store] = found.at("kB");
    CHECK(found.at("of_raw") == Approx(1e3 * kB[store] / (24 * 24 * 24)));
    CHECK(found.at("nonzero_percent") > 1);
    CHECK(found.at("error_percent") < 1);
    CHECK(found.at("fit_percent") > 5);
    CHECK(found.count("retries") == (std::string(store).starts_with("hash") ? 1 : 0));
  }
  CHECK(kB["raw"] == Approx(13.824));
  CHECK(kB["bricks"] <= kB["raw"] + 0.108);
  CHECK(kB["apron"] > kB["bricks"]);
  CHECK(kB["hash_tags"] > kB["hash_domain"]);
  CHECK(kB["nano_floats"] > kB["nano_eight_bits"]);
}

DEVICE_TEST_CASE("look-ups in a residual on the device are the processor's", "[residual][gpu]") {
  const ResidualDecode probe;
  std::map<std::string, double> kB;
  for (const char* const store : {"bricks", "hash_tags", "hash_domain"}) {
    INFO(store);
    const auto found = figures(probe, {}, small_noise(store));
    kB[store] = found.at("device_kB");
    CHECK(found.at("worst_between") <= 3 * 254 * 32 * std::exp2(-23));
    for (const char* const time : {"level_ns", "between_ns", "between_random_ns"}) CHECK(found.at(time) > 0);
  }
  CHECK(kB["bricks"] > 0);
  CHECK(kB["hash_tags"] > kB["hash_domain"]);
}

TEST_CASE("frames of a data folder as Gaussians, and their residuals' sizes", "[residual][gaussian_fit]") {
  const GaussianFitProbe probe;
  TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "volumes/plume");
  const std::map<std::string, std::string> settings = {{"smoke", "data"}, {"first", "10"},     {"step", "2"},
                                                       {"frames", "2"},   {"gaussians", "20"}, {"stores", "true"}};
  scene::set_data_folder(folder.path().string());
  CHECK_THROWS_AS(figures(probe, {}, settings), Unavailable);
  for (const int frame : {10, 12}) {
    scene::VoxelGrid grid = noise_smoke(16, 0.02 * frame);
    grid.translation.setZero();
    scene::write_vdb(folder.file("volumes/plume/plume_00" + std::to_string(frame) + ".vdb"), grid);
  }
  const auto found = figures(probe, {}, settings);
  CHECK(found.at("squared_percent") > 0);
  CHECK(found.at("squared_percent") < 20);
  CHECK(found.at("relative_l2_percent") == Approx(10 * std::sqrt(found.at("squared_percent"))));
  CHECK(found.at("hash_kB") > found.at("bricks_kB"));
  CHECK(found.at("bricks_kB") > 0.5);
  CHECK(found.at("bricks_kB") <= 1e-3 * (16 * 16 * 16 + 4 * 8));
  scene::set_data_folder(AIRLIGHT_SOURCE_DIR "/experiments");  // for the tests that follow, a folder that stays
}

TEST_CASE("NanoVDB gives back the floats it was given, and eight bits nearly", "[residual]") {
  const Eigen::Vector3i size(17, 9, 11);
  std::vector<float> values(std::size_t(size.prod()));
  for (std::size_t i = 0; i < values.size(); i += 3) values[i] = float(i % 251) - 100;
  const NanoGrid exact(size, values, NanoGrid::Values::floats), coarse(size, values, NanoGrid::Values::eight_bits);
  double worst = 0;
  std::size_t i = 0, wrong = 0;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x, ++i) {
        wrong += exact.at({x, y, z}) != values[i];
        worst = std::max(worst, double(std::abs(coarse.at({x, y, z}) - values[i])));
      }
  CHECK(wrong == 0);
  CHECK(worst > 0);
  CHECK(worst <= 0.51 * 250 / 255);
}

TEST_CASE("pictures of fitted smoke are nearer with the residual", "[residual]") {
  const FittedPicture probe;
  const ProbeInput input{
      AIRLIGHT_SOURCE_DIR "/experiments/scenes/constant_grid.toml", {{"film.width", "8"}, {"film.height", "6"}}, true};
  const auto picture = [&](const char* residual, const char* renderer) {
    return figures(probe, input,
                   {{"residual", residual}, {"renderer", renderer}, {"gaussians", "4"}, {"samples", "4"}});
  };
  const auto without = picture("left_out", "ray_marcher"), with = picture("kept", "ray_marcher");
  CHECK(without.at("rel_l2") > 0.01);
  CHECK(without.at("residual_kB") == 0);
  CHECK(with.at("rel_l2") < 0.1 * without.at("rel_l2"));
  CHECK(with.at("residual_kB") > 0);
  CHECK(with.at("noise") == 0);
  CHECK(picture("within_support", "ray_marcher").at("density_percent") >= with.at("density_percent"));
  CHECK(picture("kept", "path_tracer").at("noise") > 0);
  CHECK_THROWS_WITH(figures(probe, {}, {}), "fitted_picture: a [[scene]] with voxels is needed");
}

}  // namespace residual_probe_test
