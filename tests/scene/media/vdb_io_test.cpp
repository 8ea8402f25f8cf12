#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scene/base/error.h"
#include "scene/flow/flow.h"
#include "scene/media/start_grids.h"
#include "scene/media/voxel_grid.h"
#include "tests/scene/media/random_points.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace vdb_io_test {

using namespace airlight;
using namespace airlight::scene;
namespace fs = std::filesystem;

namespace {

struct Folder {
  airlight::TemporaryFolder own;
  fs::path path = own.path();
  std::string operator/(const std::string& name) const { return (path / name).string(); }
};

const std::string plume = std::string(AIRLIGHT_SOURCE_DIR) + "/experiments/data/plume_0024.vdb";

std::string read_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  REQUIRE(stream);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

void write_file(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

// The message of the Error that reading throws, checked for its form; empty if it reads.
std::string refusal(const std::string& path, const std::string& name = "density", std::size_t most = 1u << 30) {
  const std::string message = test::message_of([&] { read_vdb(path, name, most); });
  CHECK((message.empty() || message.find(path) == 0));
  CHECK(message.size() <= 200 + path.size() + 40);
  return message;
}

VoxelGrid some_grid(Eigen::Vector3i size) {
  RandomPoints random(1);
  VoxelGrid grid;
  grid.size = size;
  grid.origin_index = {-3, 5, 40};
  grid.voxel_size = 0.125;
  grid.translation = {1, -2, 3};
  grid.rotation = Eigen::AngleAxisd(0.3, Vec3(3, 1, 2).normalized()).toRotationMatrix();
  // A third of the samples, and all at two of the sides, are zero.
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j)
      for (int i = 0; i < size[0]; ++i)
        grid.values.push_back(i == 0 || k + 1 == size[2] ? 0.0f : float(std::max(0.0, random.uniform(-0.5, 1))));
  return grid;
}

bool same(const VoxelGrid& a, const VoxelGrid& b) {
  // Minus zero is not zero here.
  return a.size == b.size && a.origin_index == b.origin_index && a.values.size() == b.values.size() &&
         std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

}  // namespace

TEST_CASE("a grid written as OpenVDB comes back bit for bit", "[media][vdb]") {
  const Folder folder;
  const std::string path = folder / "grid.vdb";
  for (const Eigen::Vector3i& size : std::vector<Eigen::Vector3i>{{20, 17, 9}, {1, 1, 1}, {2, 1, 70}}) {
    VoxelGrid grid = some_grid(size);
    grid.values.front() = -0.0f;
    grid.values.back() = 1e-45f;
    write_vdb(path, grid);
    const VoxelGrid back = read_vdb(path);
    CHECK(same(back, grid));
    CHECK(back.voxel_size == Approx(grid.voxel_size).epsilon(1e-14));
    CHECK(back.rotation.isApprox(grid.rotation, 1e-14));
    CHECK(back.translation == grid.translation);
    // A rotated, shifted and scaled grid is read back at its place in the world.
    RandomPoints random(2);
    for (int i = 0; i < 100; ++i) {
      const Point3 x = random.in(support(grid));
      CHECK(density(back, x) == Approx(density(grid, x)).margin(1e-12));
    }
  }
  // A grid that is only scaled is read back exactly.
  VoxelGrid plain = some_grid({5, 5, 5});
  plain.rotation.setIdentity();
  write_vdb(path, plain, "smoke");
  CHECK(read_vdb(path, "smoke").rotation == Mat3::Identity());
  CHECK(read_vdb(path, "smoke").voxel_size == plain.voxel_size);
}

TEST_CASE("stress 19: an empty grid as OpenVDB", "[media][vdb]") {
  const Folder folder;
  const std::string path = folder / "empty.vdb";
  write_vdb(path, VoxelGrid{});
  CHECK(read_vdb(path).values.empty());
  VoxelGrid zeros = some_grid({3, 4, 5});
  std::fill(zeros.values.begin(), zeros.values.end(), 0.0f);
  write_vdb(path, zeros);
  CHECK(same(read_vdb(path), zeros));
}

// Its description: 128^3 cells of 1/64 m of which (10, 2, 11) to (107, 126, 105) are active; the box has its corner at
// (-1, 0, -1) with samples in the middle of cells; mean over 128^3 0.030, largest line integral along y 1.17 m.
TEST_CASE("real smoke is where it should be", "[media][vdb]") {
  const VoxelGrid grid = read_vdb(plume);
  CHECK(grid.size == Eigen::Vector3i(98, 125, 95));
  CHECK(grid.origin_index == Eigen::Vector3i(10, 2, 11));
  CHECK(grid.voxel_size == 0.015625);
  const Point3 first = sample_to_world(grid, -grid.origin_index.cast<double>());
  CHECK(first.isApprox(Point3(-1, 0, -1) + Point3::Constant(0.5 / 64), 1e-12));
  double sum = 0, greatest = 0;
  for (float value : grid.values) {
    sum += value;
    greatest = std::max(greatest, double(value));
  }
  CHECK(sum / (128 * 128 * 128) == Approx(0.0302).margin(5e-5));
  CHECK(greatest == Approx(0.9985).margin(5e-5));
  // Through samples along y the integral is the trapezium sum, which is the plain sum since both ends are zero.
  double largest = 0;
  for (int i = 0; i < grid.size[0]; ++i)
    for (int k = 0; k < grid.size[2]; ++k) {
      double column = 0;
      for (int j = 0; j < grid.size[1]; ++j) column += grid.at(i, j, k);
      const Ray ray{sample_to_world(grid, Point3(i, -5, k)), Vec3::UnitY()};
      const double integral = density_integral(grid, ray, {0, infinity});
      CHECK(integral == Approx(column / 64).epsilon(1e-12).margin(1e-12));
      largest = std::max(largest, integral);
    }
  CHECK(largest == Approx(1.172).margin(5e-4));
}

// Cut anywhere, also by one byte, where OpenVDB itself reads zeros without a word.
TEST_CASE("a truncated OpenVDB file is refused", "[media][vdb]") {
  const Folder folder;
  const std::string path = folder / "cut.vdb";
  const std::string whole = read_file(plume);
  RandomPoints random(3);
  std::vector<std::size_t> lengths{0, 1, 7, 8, 60, 130, whole.size() - 1, whole.size() - 2, whole.size() - 1000};
  for (int i = 0; i < 60; ++i) lengths.push_back(std::size_t(random.uniform(0, 1) * whole.size()));
  for (int i = 0; i < 40; ++i) lengths.push_back(std::size_t(std::pow(random.uniform(0, 1), 6) * whole.size()));
  for (std::size_t length : lengths) {
    write_file(path, whole.substr(0, length));
    INFO("cut to " << length);
    CHECK(!refusal(path).empty());
  }
  // Cut, and the end noted in its header (at byte 126) moved there: what follows within must still be whole.
  for (std::size_t length : {whole.size() - 1, whole.size() / 2}) {
    std::string cut = whole.substr(0, length);
    for (int i = 0; i < 8; ++i) cut[126 + i] = char(length >> (8 * i));
    write_file(path, cut);
    CHECK(refusal(path).find("truncated or damaged") != std::string::npos);
  }
}

// With the checksum that our writer puts into the file, three bytes changed anywhere are either without effect on the
// grid, or noticed.
TEST_CASE("three damaged bytes are noticed in a file of ours", "[media][vdb]") {
  const Folder folder;
  const std::string path = folder / "damaged.vdb";
  const VoxelGrid grid = some_grid({24, 30, 20});
  write_vdb(path, grid);
  const std::string whole = read_file(path);
  RandomPoints random(4);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string bytes = whole;
    const double part = i % 2 ? 1 : 0.1;  // half of them near the beginning, where lengths and types are
    for (int k = 0; k < 3; ++k)
      bytes[std::size_t(random.uniform(0, part) * bytes.size())] = char(int(random.uniform(0, 256)));
    write_file(path, bytes);
    const std::string message = refusal(path);
    refused += !message.empty();
    if (message.empty()) CHECK(same(read_vdb(path), grid));
  }
  CHECK(refused > 300);
}

// In files of other writers damaged samples can decode to other samples; a checksum beside the file tells.
TEST_CASE("three damaged bytes are noticed with a checksum beside the file", "[media][vdb]") {
  const Folder folder;
  const std::string path = folder / "plume.vdb";
  const std::string whole = read_file(plume);
  write_file(path + ".xxh128", read_file(plume + ".xxh128"));
  write_file(path, whole);
  CHECK(refusal(path).empty());
  RandomPoints random(5);
  for (int i = 0; i < 50; ++i) {
    std::string bytes = whole;
    for (int k = 0; k < 3; ++k) bytes[std::size_t(random.uniform(0, 1) * bytes.size())] ^= char(random.uniform(1, 256));
    if (bytes == whole) continue;
    write_file(path, bytes);
    CHECK(refusal(path).find("checksum") != std::string::npos);
  }
}

TEST_CASE("what is not a grid of densities is refused, and why is said", "[media][vdb]") {
  const Folder folder;
  const std::string path = folder / "bad.vdb";
  const auto says = [&](const std::string& words, const std::string& name = "density", std::size_t most = 1u << 30) {
    const std::string message = refusal(path, name, most);
    INFO(message);
    CHECK(message.find(words) != std::string::npos);
  };
  says("no such file");
  write_file(path, "");
  says("empty");
  write_file(path, "#usda 1.0\nnot a volume at all\n");
  says("not an OpenVDB file");
  CHECK(refusal(folder.path.string()).find("a folder") != std::string::npos);

  write_vdb(path, some_grid({9, 8, 7}));
  says("has no grid 'smoke', only: density", "smoke");
  says("spans 504 voxels, expected at most 503", "density", 503);
  std::string bytes = read_file(path);
  bytes.replace(bytes.find("Tree_float"), 10, "Tree_int32");
  write_file(path, bytes);
  says("is of type Tree_int32_5_4_3");

  // Values that are no densities, with the index in the grid: sample (2, 1, 3) of a grid that begins at (-3, 5, 40).
  for (const auto& [value, words] : std::vector<std::pair<float, std::string>>{{NAN, "voxel (-1, 6, 43) is nan"},
                                                                               {INFINITY, "voxel (-1, 6, 43) is inf"},
                                                                               {-1.5f, "voxel (-1, 6, 43) is -1.5"}}) {
    VoxelGrid grid = some_grid({9, 8, 7});
    grid.values[2 + 9 * (1 + 8 * 3)] = value;
    write_vdb(path, grid);
    says(words);
  }

  VoxelGrid stretched = some_grid({9, 8, 7});
  stretched.rotation = Vec3(1, 2, 1).asDiagonal();
  write_vdb(path, stretched);
  says("expected a uniform scale");
  VoxelGrid nowhere = some_grid({9, 8, 7});
  nowhere.translation[1] = infinity;
  write_vdb(path, nowhere);
  says("not finite");
}

// A file as OpenVDB's own writer makes it where two grids share a tree: "smoke" has no samples of its own. Its place is
// its own: voxels of 0.25 m like those of "density", moved by nothing.
TEST_CASE("grids that share samples are read", "[media][vdb]") {
  const std::string file = std::string(AIRLIGHT_SOURCE_DIR) + "/tests/scene/media/instance.vdb";
  const VoxelGrid own = read_vdb(file, "density"), shared = read_vdb(file, "smoke");
  CHECK(own.values.size() == 64);
  CHECK(same(own, shared));
  CHECK(shared.voxel_size == 0.25);
  // With a translation, which stands behind the name of the map.
  const Folder folder;
  const std::string path = folder / "moved.vdb", map = "UniformScaleTranslateMap";
  std::string bytes = read_file(file);
  REQUIRE(bytes.find(map) != std::string::npos);
  const Vec3 translation(3, -1, 0.5);
  std::memcpy(bytes.data() + bytes.find(map) + map.size(), translation.data(), 24);
  write_file(path, bytes);
  CHECK(read_vdb(path, "smoke").translation == translation);
  CHECK(read_vdb(path, "density").translation == own.translation);
  CHECK(same(own, read_vdb(path, "smoke")));
  // Its entry names a grid that is not there; it is cut short; the other's samples are damaged.
  const std::size_t entry = bytes.find("smoke"), parent = bytes.find("density", entry);
  std::string orphan = bytes;
  orphan.replace(parent, 7, "nothing");
  write_file(path, orphan);
  CHECK(refusal(path, "smoke").find("shares the samples of a grid 'nothing' that is not there") != std::string::npos);
  for (std::size_t length = entry; length < bytes.size(); length += 7) {
    write_file(path, bytes.substr(0, length));
    CHECK_FALSE(refusal(path, "smoke").empty());
  }
}

TEST_CASE("grids of one name are told apart by a number", "[media][vdb]") {
  const Folder folder;
  const std::string path = folder / "two.vdb";
  Frame frame;
  frame.size = {2, 1, 1};
  frame.density = {1, 2};
  frame.densities["colours"] = {3, 4};
  frame.velocity.assign(3 * 3 * 2 * 2, 0.0f);
  write_frame(path, frame, {});
  std::string bytes = read_file(path);
  for (std::size_t at; (at = bytes.find("colours")) != std::string::npos;) bytes.replace(at, 7, "density");
  write_file(path, bytes);
  CHECK(refusal(path).find("has 2 grids 'density', expected one of 'density[0]' to 'density[1]'") != std::string::npos);
  CHECK(read_vdb(path, "density[0]").values == std::vector<float>{1, 2});
  CHECK(read_vdb(path, "density[1]").values == std::vector<float>{3, 4});
  for (const std::string name : {"density[2]", "density[-1]", "density[]", "density[1", "smoke[0]"})
    CHECK(refusal(path, name).find("has no grid '" + name + "', only: density, density, velocity") !=
          std::string::npos);
  VoxelGrid grid = some_grid({3, 3, 3});
  write_vdb(path, grid, "");
  CHECK(refusal(path).find("only: one without a name, \"\"") != std::string::npos);
  CHECK(same(read_vdb(path, ""), grid));
}

// A map is stored as a matrix of 16 doubles behind its name: the first three are a row.
TEST_CASE("a singular transform is refused with file and grid, a very fine one is not", "[media][vdb]") {
  const Folder folder;
  const std::string path = folder / "singular.vdb";
  write_vdb(path, some_grid({4, 5, 3}));  // a rotation: stored as an AffineMap
  const std::string whole = read_file(path);
  const std::size_t at = whole.find("AffineMap") + 9;
  REQUIRE(at < whole.size());
  for (const double row : {0.0, 1e-200, 1e-30}) {
    std::string bytes = whole;
    for (int i = 0; i < 3; ++i) std::memcpy(bytes.data() + at + 8 * i, &row, 8);
    write_file(path, bytes);
    INFO(row << ": " << refusal(path));
    CHECK(refusal(path).find("grid 'density'") != std::string::npos);
  }
  // Without a rotation: behind the name the translation, then the scale and the size of a voxel, three doubles each.
  VoxelGrid plain = some_grid({4, 5, 3});
  plain.rotation = Mat3::Identity();
  write_vdb(path, plain);
  const std::string uniform = read_file(path), name = "UniformScaleTranslateMap";
  REQUIRE(uniform.find(name) != std::string::npos);
  for (const double size : {0.5, 1e-4, 1e-6, 1e-30}) {
    std::string bytes = uniform;
    for (int i = 3; i < 9; ++i) std::memcpy(bytes.data() + bytes.find(name) + name.size() + 8 * i, &size, 8);
    write_file(path, bytes);
    INFO(size << ": " << refusal(path));
    REQUIRE(refusal(path).empty());
    CHECK(read_vdb(path).voxel_size == size);
    CHECK(read_vdb(path).translation == plain.translation);
  }
}

TEST_CASE("writing OpenVDB leaves all or nothing", "[media][vdb]") {
  const Folder folder;
  CHECK_THROWS_AS(write_vdb(folder / "no/such/folder/grid.vdb", some_grid({3, 3, 3})), Error);
  const std::string path = folder / "grid.vdb";
  write_vdb(path, some_grid({3, 3, 3}));
  write_vdb(path, some_grid({4, 3, 3}));
  CHECK(read_vdb(path).size[0] == 4);
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator{}) == 1);
}

}  // namespace vdb_io_test
