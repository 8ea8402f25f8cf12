// airlight fit: a folder of frames that a kill does not change, and one line for what is no good.
#include "experiments/application/fit_sequence.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/base/error.h"
#include "scene/base/read_file.h"
#include "scene/convert/residual_file.h"
#include "scene/load/parts.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace fit_sequence_test {

using namespace airlight;
using namespace airlight::experiments;
using scene::VoxelGrid;

namespace {

VoxelGrid puff(int n, double time) {
  VoxelGrid grid;
  grid.size = {n, n, n};
  grid.voxel_size = 0.1;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double x = i - 0.5 * n, y = j - (0.3 + 0.05 * time) * n, z = k - 0.5 * n;
        const double r = std::sqrt(x * x + y * y + z * z) / n, waves = std::sin(0.9 * i) * std::sin(0.8 * j + 0.5 * k);
        grid.values.push_back(time < 0 ? 0.0f : float(std::max(0.0, 1 - 4 * r + 0.3 * waves)));
      }
  return grid;
}

struct Smoke {
  TemporaryFolder folder;
  FitSequence sequence;
  Smoke(const std::vector<double>& times) {
    for (std::size_t i = 0; i < times.size(); ++i) {
      sequence.files.push_back(folder.file("puff_" + std::to_string(i) + ".vdb"));
      scene::write_vdb(sequence.files.back(), puff(16, times[i]));
    }
    sequence.options.gaussians = 30;
    sequence.folder = folder.path() / "fit";
  }
  std::map<std::string, std::string> results() const {
    std::map<std::string, std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(sequence.folder))
      if (entry.path().extension() != ".json")  // holds times
        found[entry.path().filename()] = scene::read_whole_file(entry.path());
    return found;
  }
};

FitReport run(const FitSequence& s) { return fit_sequence(s, {}); }

}  // namespace

TEST_CASE("frames of a fit, and what an empty one leaves", "[fit_sequence]") {
  const Smoke smoke({0, 1, -1, 3});
  int done = 0;
  const FitReport report = fit_sequence(smoke.sequence, {}, [&](const FittedFrame&) { ++done; });
  CHECK(done == 4);
  CHECK(report.resumed == 0);
  REQUIRE(report.frames.size() == 4);
  CHECK(report.unit == Approx(1.6));
  CHECK(report.frames[2].gaussians == 0);
  CHECK(report.frames[2].errors.squared_ratio == 0);
  for (const int i : {0, 1, 3}) {
    CAPTURE(i, report.frames[std::size_t(i)].errors.squared_ratio);
    CHECK(report.frames[std::size_t(i)].errors.squared_ratio < 0.05);
    CHECK(report.frames[std::size_t(i)].residual_bytes > 0);
    std::vector<int> ids;
    const auto gaussians = scene::load::read_gaussians_csv(
        (smoke.sequence.folder / ("puff_" + std::to_string(i) + ".csv")).string(), &ids);
    CHECK(gaussians.size() == report.frames[std::size_t(i)].gaussians);
    CHECK(ids.size() == gaussians.size());
    // With the residual it is the frame again, to a level or two.
    const auto residual =
        scene::read_residual((smoke.sequence.folder / ("puff_" + std::to_string(i) + ".residual")).string());
    const VoxelGrid again = scene::decoded({gaussians, 0, 3}, residual), wanted = puff(16, i);
    REQUIRE(again.values.size() == wanted.values.size());
    double worst = 0;
    for (std::size_t v = 0; v < wanted.values.size(); ++v)
      worst = std::max(worst, std::abs(double(again.values[v]) - double(wanted.values[v])));
    CHECK(worst < 1.6 * residual.step);
  }
  CHECK(smoke.results().size() == 8);
}

TEST_CASE("a fit that was stopped after any frame, or goes on with more of them, is the same", "[fit_sequence]") {
  const Smoke whole({0, 1, -1, 2, 3});
  run(whole.sequence);
  const auto expected = whole.results();
  REQUIRE(expected.size() == 10);
  for (int frames = 1; frames < 5; ++frames) {
    Smoke parts({0, 1, -1, 2, 3});
    FitSequence some = parts.sequence;
    some.files.resize(std::size_t(frames));
    some.options.unit = 1.6;
    run(some);
    // A stop between two files leaves a frame that the record does not know.
    parts.folder.write("fit/puff_" + std::to_string(frames) + ".csv", "half a fra");
    FitSequence all = parts.sequence;
    all.options.unit = 1.6;
    CHECK(run(all).resumed == frames);
    CHECK(parts.results() == expected);
    CHECK(run(all).resumed == 5);
  }
}

TEST_CASE("a fit stops where it is asked to, and goes on", "[fit_sequence]") {
  const Smoke whole({0, 1, 2});
  run(whole.sequence);
  for (const int calls : {1, 2, 7, 20}) {
    const Smoke stopped({0, 1, 2});
    int left = calls;
    scene::Execution execution;
    execution.progress = [&](double) { return left-- > 0; };
    bool ended = false;
    try {
      fit_sequence(stopped.sequence, execution);
    } catch (const scene::Interrupted&) {
      ended = true;
    }
    CHECK(ended);
    run(stopped.sequence);
    CHECK(stopped.results() == whole.results());
  }
}

TEST_CASE("a fit by one thread and two writes the same files", "[fit_sequence]") {
  const Smoke one({0, 1}), two({0, 1});
  scene::Execution execution;
  execution.threads = 1;
  fit_sequence(one.sequence, execution);
  execution.threads = 2;
  fit_sequence(two.sequence, execution);
  CHECK(one.results() == two.results());
}

// Amplitudes are a hundredth of the greatest density and more; scenes take 1e-20 to 1e20.
TEST_CASE("a fit that no scene could read is refused before it begins", "[fit_sequence]") {
  for (const float greatest : {1e-30f, 0.9e-18f, 1.5e-18f, 0.9e20f, 1.1e20f, 1e38f}) {
    CAPTURE(greatest);
    const TemporaryFolder folder;
    FitSequence s;
    s.files = {folder.file("a.vdb")};
    s.folder = folder.path() / "fit";
    s.options.gaussians = 30;
    VoxelGrid grid = puff(8, 0);
    const float most = *std::max_element(grid.values.begin(), grid.values.end());
    for (float& value : grid.values) value = value / most * greatest;
    write_vdb(s.files[0], grid);
    if (greatest > 1e-18f && greatest < 1e20f) {
      CHECK(run(s).frames.size() == 1);
      CHECK(scene::load::read_gaussians_csv((s.folder / "a.csv").string()).size() > 1);
      CHECK_NOTHROW(scene::read_residual((s.folder / "a.residual").string()));
      continue;
    }
    CHECK_THROWS_WITH(run(s), Catch::Contains("a.vdb: found a greatest density of ") &&
                                  Catch::Contains("expected 0 or a number in [1e-18, 1e+20]"));
    CHECK_FALSE(std::filesystem::exists(s.folder));
  }
}

TEST_CASE("what a fit cannot go on with is told", "[fit_sequence]") {
  const Smoke smoke({0, 1});
  run(smoke.sequence);
  const auto what = [](const FitSequence& s) { return test::message_of([&] { run(s); }); };
  FitSequence other = smoke.sequence;
  SECTION("other options") {
    other.options.gaussians = 31;
    CHECK(what(other).find("holds a fit with other options") != std::string::npos);
  }
  SECTION("other smoke") {
    scene::write_vdb(smoke.sequence.files[1], puff(16, 1.5));
    CHECK(what(other).find("frame 1 is of other smoke") != std::string::npos);
  }
  SECTION("fewer frames") {
    other.files.pop_back();
    CHECK(what(other).find("frame 1 is of other smoke") != std::string::npos);
  }
  SECTION("a changed result") {
    smoke.folder.write("fit/puff_0.csv", "id,center_x,center_y,center_z,width,amplitude\n");
    CHECK(what(other).find("puff_0.csv: is gone or changed") != std::string::npos);
  }
  SECTION("a damaged record") {
    smoke.folder.write("fit/record.json", "{\"key\": 3}");
    CHECK_FALSE(what(other).empty());
    smoke.folder.write("fit/record.json", "{");
    CHECK(what(other).find("record.json") != std::string::npos);
  }
  SECTION("a changed record") {
    std::string record = read_bytes(smoke.folder.file("fit/record.json"));
    const std::size_t digit = record.find("\"rms\": ") + 9;
    record[digit] = record[digit] == '1' ? '2' : '1';
    smoke.folder.write("fit/record.json", record);
    CHECK(what(other).find("record.json: is not what was written there") != std::string::npos);
  }
  SECTION("files of one name") {
    other.files.push_back(smoke.sequence.files[0]);
    CHECK(what(other).find("expected another name") != std::string::npos);
  }
  SECTION("no smoke") {
    other.files.push_back(smoke.folder.file("none.vdb"));
    CHECK(what(other).find("none.vdb") != std::string::npos);
    smoke.folder.write("none.vdb", "no smoke");
    CHECK(what(other).find("none.vdb") != std::string::npos);
  }
  SECTION("a medium that is no grid") {
    smoke.folder.write("s.toml",
                       "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[[medium]]\ntype = 'homogeneous'\n");
    other.files = {smoke.folder.file("s.toml")};
    CHECK(what(other).find("is homogeneous, expected a grid") != std::string::npos);
    other.medium = "7";
    CHECK(what(other).find("--medium 7") != std::string::npos);
  }
  SECTION("too many Gaussians") {
    other.options.gaussians = 1000000;
    CHECK(what(other).find("1000000, expected 1 to 65536") != std::string::npos);
  }
  SECTION("no folder") {
    other.folder = smoke.sequence.files[0];
    CHECK_FALSE(what(other).empty());
  }
}

}  // namespace fit_sequence_test
