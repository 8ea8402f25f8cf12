// The keys of a fitted grid: Gaussians and residual as files.
#include "scene/media/fitted.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/base/error.h"
#include "scene/convert/residual_file.h"
#include "scene/scene.h"
#include "tests/scene/load/message.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace fitted_test {

using namespace airlight;
using namespace airlight::scene;
using test::camera;

namespace {

const std::string medium = camera + "[[medium]]\ntype = 'fitted'\n";

VoxelGrid grid() {
  VoxelGrid g;
  g.size = {7, 9, 5};
  g.origin_index = {2, -4, 0};
  g.voxel_size = 0.2;
  g.translation = {-1, 0, 0.5};
  for (int i = 0; i < 315; ++i) g.values.push_back(float(std::max(0.0, 0.6 + 0.5 * std::sin(0.7 * i))));
  return g;
}

GaussianSum gaussians(double amplitude) {
  GaussianSum sum;
  sum.cutoff = 3;
  sum.gaussians = {{{0.1, 0.2, 0.9}, 0.5, amplitude}, {{-0.5, 0.1, 0.7}, 0.3, 0.25}};
  return sum;
}

void write_csv(const TemporaryFolder& folder, const std::string& name, const GaussianSum& sum) {
  std::string text = "center_x,center_y,center_z,width,amplitude\n";
  for (const Gaussian& g : sum.gaussians)
    text += fmt::format("{},{},{},{},{}\n", g.center[0], g.center[1], g.center[2], g.width, g.amplitude);
  folder.write(name, text);
}

// Frames 3 and 4 of a sequence.
struct Files {
  TemporaryFolder folder;
  Files() {
    for (const int frame : {3, 4}) {
      const GaussianSum sum = gaussians(0.1 * frame);
      write_csv(folder, fmt::format("g_{:04}.csv", frame), sum);
      write_residual(folder.file(fmt::format("r_{:04}.residual", frame)), residual_of(grid(), sum, {1, {}}));
    }
  }
  Scene scene(const std::string& keys) const { return parse_scene(medium + keys, "s.toml", folder.path().string()); }
  std::string message(const std::string& keys) const {
    return test::message_of([&] { scene(keys); });
  }
};

const Fitted& fitted_of(const Scene& scene) { return *std::get<FittedPointer>(scene.media.at(0).field); }

const std::string sequence = "gaussians = 'g_####.csv'\nresidual = 'r_####.residual'\n";

}  // namespace

TEST_CASE("a fitted grid is what its Gaussians and residual stand for", "[load][residual]") {
  const Files files;
  const Scene scene = files.scene(sequence + "frame = 4\n");
  const Fitted& fitted = fitted_of(scene);
  const VoxelGrid original = grid();
  REQUIRE(fitted.residual);
  CHECK(fitted.gaussians.gaussians.size() == 2);
  CHECK(fitted.gaussians.cutoff == 3);
  CHECK(fitted.grid.values == decoded(gaussians(0.1 * 4), residual_of(original, gaussians(0.1 * 4), {1, {}})).values);
  const Medium& m = scene.media[0];
  double worst = 0;
  for (std::size_t i = 0; i < original.values.size(); ++i)
    worst = std::max(worst, std::abs(double(fitted.grid.values[i]) - original.values[i]));
  CHECK(worst <= 1.5 * fitted.residual->step + 1e-6);
  CHECK(worst > 0);
  // Fitted smoke behaves like its grid in every respect.
  Medium other = m;
  other.field = std::make_shared<const VoxelGrid>(fitted.grid);
  const Ray ray{{-2, -0.4, 0.8}, Vec3(1, 0.1, 0.05).normalized()};
  CHECK(density(m, {0.05, -0.1, 0.77}) == density(other, {0.05, -0.1, 0.77}));
  CHECK(density(m, {0.05, -0.1, 0.77}) > 0);
  CHECK(density_integral(m, ray, {0, 10}) == density_integral(other, ray, {0, 10}));
  CHECK(density_integral(m, ray, {0, 10}) > 0);
  CHECK(extent(m, ray, {0, 10}).lo == extent(other, ray, {0, 10}).lo);
  CHECK(bounding_box(m).lo == bounding_box(other).lo);
  CHECK(bounding_box(m).hi == bounding_box(other).hi);
  const Box part{{-0.5, -0.5, 0.5}, {0, 0, 1}};
  CHECK(density_bounds(m, part).lo == density_bounds(other, part).lo);
  CHECK(density_bounds(m, part).hi == density_bounds(other, part).hi);
  CHECK(greatest_density(m.field) == greatest_density(other.field));
  CHECK(extinguishes(m));
  CHECK(constant_part(m.field) == 0);
  CHECK_FALSE(homogeneous_density(m.field));
  CHECK(grid_of(m.field) == &fitted.grid);
  CHECK(grid_of(other.field) != nullptr);
  CHECK(grid_of(Homogeneous{}) == nullptr);
}

TEST_CASE("without a residual a fitted grid is that of the Gaussians", "[load][residual]") {
  const Files files;
  const Scene off = files.scene(sequence + "frame = 3\nwith_residual = false\n");
  CHECK_FALSE(fitted_of(off).residual);
  VoxelGrid layout = grid();
  layout.values.clear();
  CHECK(fitted_of(off).grid.values == decoded(layout, gaussians(0.1 * 3), {}).values);
  const Scene alone = files.scene(
      "gaussians = 'g_0003.csv'\ncutoff = 3\nsize = [7, 9, 5]\nvoxel_size = 0.2\norigin = [-0.6, -0.8, 0.5]\n");
  CHECK_FALSE(fitted_of(alone).residual);
  const auto &a = fitted_of(alone).grid.values, &b = fitted_of(off).grid.values;
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(a[i] == Approx(b[i]).margin(1e-6));
}

TEST_CASE("the hash of a scene covers Gaussians and residual", "[load][residual]") {
  const Files files;
  const std::string three = files.scene(sequence + "frame = 3\n").hash;
  CHECK(files.scene("gaussians = 'g_0003.csv'\nresidual = 'r_0003.residual'\n").hash == three);
  CHECK(files.scene(sequence + "frame = 4\n").hash != three);
  CHECK(files.scene(sequence + "frame = 3\nwith_residual = false\n").hash != three);
  write_residual(files.folder.file("r_0003.residual"), residual_of(grid(), gaussians(0.1 * 3), {0, {}}));
  CHECK(files.scene(sequence + "frame = 3\n").hash != three);
}

TEST_CASE("bad fitted grids name their place", "[load][residual]") {
  const Files files;
  using Catch::Contains;
  CHECK_THAT(files.message("residual = 'r_0003.residual'\n"), Contains("gaussians"));
  CHECK_THAT(files.message("gaussians = 'g_0003.csv'\n"),
             Contains("medium 0: missing key, expected exactly one of residual, size"));
  CHECK_THAT(files.message(sequence),
             Contains("s.toml:6:13: medium 0: gaussians = \"g_####.csv\" is a sequence, expected a frame"));
  CHECK_THAT(files.message("gaussians = 'g_0003.csv'\nresidual = 'r_####.residual'\nframe = 3\n"),
             Contains("frame has no effect"));
  CHECK_THAT(files.message("gaussians = 'g_0003.csv'\nresidual = 'r_0004.residual'\n"),
             Contains("s.toml:7:12: medium 0: the residual is of other Gaussians than"));
  CHECK_THAT(files.message("gaussians = 'g_0003.csv'\nresidual = 'g_0003.csv'\n"),
             Contains("not a residual that can be read: it does not begin with \"airlight residual 1\""));
  CHECK_THAT(files.message("gaussians = 'g_0003.csv'\nresidual = 'none'\n"),
             Contains("residual = \"none\", expected a file"));
  CHECK_THAT(
      files.message("gaussians = 'g_0003.csv'\nsize = [100000, 100000, 100000]\nvoxel_size = 1\norigin = [0, 0, 0]\n"),
      Contains("expected 2^28 samples or fewer"));
  CHECK_THAT(
      files.message(
          "gaussians = 'g_0003.csv'\nsize = [2, 2, 2]\nvoxel_size = 1\norigin = [0, 0, 0]\nwith_residual = true\n"),
      Contains("with_residual"));
  CHECK_THAT(files.message(sequence + "frame = 5\n"), Contains("g_0005.csv"));
}

}  // namespace fitted_test
