// `airlight doctor --check`: what it finds is kept for the device, its driver and the shaders, and a method that failed is refused there.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace device_check_test {

using namespace airlight::test;
using airlight::read_bytes;
using airlight::TemporaryFolder;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

const std::string scene = scenes + "fogshop/f100.toml --override film.width=8 --override film.height=6";

// A folder of caches of its own, but not for Mesa's compiled shaders.
class OwnCache : public TemporaryFolder {
 public:
  OwnCache() {
    const auto text = [](const char* name) {
      const char* value = std::getenv(name);
      return std::string(value ? value : "");
    };
    if (text("MESA_SHADER_CACHE_DIR").empty()) {
      const std::string usual = text("XDG_CACHE_HOME").empty() ? text("HOME") + "/.cache" : text("XDG_CACHE_HOME");
      set("MESA_SHADER_CACHE_DIR", usual);
    }
    set("XDG_CACHE_HOME", file("cache"));
  }
  ~OwnCache() {
    for (const auto& [name, value] : before_)
      value.empty() ? unsetenv(name.c_str()) : setenv(name.c_str(), value.c_str(), 1);
  }
  // A variable of the environment, as long as this lives.
  void set(const std::string& name, const std::string& value) {
    const char* const old = std::getenv(name.c_str());
    before_.try_emplace(name, old ? old : "");
    value.empty() ? unsetenv(name.c_str()) : setenv(name.c_str(), value.c_str(), 1);
  }
  std::vector<fs::path> records() const {
    std::vector<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(path() / "cache/airlight/devices", none))
      files.push_back(entry.path());
    return files;
  }

 private:
  std::map<std::string, std::string> before_;
};

// False after the line that ctest knows as "skipped".
bool has_device(const TemporaryFolder& folder) {
  if (run("doctor", folder).out.find("chosen: ") != std::string::npos) return true;
  WARN("test skipped: no device");
  return false;
}

// The shaders, of which one makes all light of froxel fog by a thousandth too bright.
void copy_shaders_with_fault(const TemporaryFolder& folder) {
  fs::copy(root + "/gpu", folder.path() / "shaders", fs::copy_options::recursive);
  const std::string file = folder.file("shaders/froxel_fog/integrate.comp"), line = "airlight[c] += ";
  std::string text = read_bytes(file);
  const std::size_t at = text.find(line);
  REQUIRE(at != std::string::npos);
  text.replace(at, line.size(), "airlight[c] += 1.001 * ");
  folder.write("shaders/froxel_fog/integrate.comp", text);
}

}  // namespace

TEST_CASE("doctor --check finds that every method holds on the device, and keeps it", "[cli][skips][slow]") {
  OwnCache folder;
  if (!has_device(folder)) return;
  CHECK_THAT(run("doctor", folder).out, Contains("not checked: `airlight doctor --check`"));
  const Result checked = run("doctor --check", folder);
  CAPTURE(checked.out, checked.err);
  CHECK(checked.code == 0);
  CHECK_THAT(checked.out, Contains("\n0 of 14 checks failed\nkept in ") && !Contains("FAILED"));
  REQUIRE(folder.records().size() == 1);
  CHECK_THAT(run("doctor", folder).out, Contains(": 0 of 14 checks failed\n") && !Contains("not checked"));
  // What is no record is not taken for one, and is replaced by the next check.
  airlight::write_bytes(folder.records()[0].string(), "{");
  const Result damaged = run("doctor", folder);
  CHECK_THAT(damaged.out, Contains("not checked: "));
  CHECK_THAT(damaged.err, Contains("warning: ") && Contains(folder.records()[0].filename().string()));
}

TEST_CASE("a method that failed on a device is refused there, unless --unchecked is given", "[cli][skips][slow]") {
  OwnCache folder;
  if (!has_device(folder)) return;
  copy_shaders_with_fault(folder);
  const std::string render = "render " + scene + " --method froxel_fog_gpu --out picture.exr";
  folder.set("AIRLIGHT_SHADERS", folder.file("shaders"));
  CHECK(run(render, folder).code == 0);  // never checked
  const Result checked = run("doctor --check", folder);
  CAPTURE(checked.out, checked.err);
  CHECK(checked.code == 1);
  CHECK_THAT(checked.out, Contains("  FAILED   froxel_fog_gpu, ") && Contains("\n1 of 14 checks failed\nkept in "));
  CHECK_THAT(run("doctor", folder).out, Contains("refused: froxel_fog_gpu, ") && Contains("tolerance"));

  fs::remove(folder.path() / "picture.exr");
  const Result refused = run(render, folder);
  CHECK(refused.code == 3);
  CHECK(refused.error_lines() == 1);
  CHECK_THAT(refused.err,
             Catch::StartsWith("airlight: froxel_fog_gpu is refused on ") &&
                 Contains(" differs by 0.00099 from the CPU, tolerance 2.7e-05 (`airlight doctor --check` of ") &&
                 Contains("--unchecked"));
  CHECK(!fs::exists(folder.path() / "picture.exr"));
  CHECK(run(render + " --unchecked", folder).code == 0);
  CHECK(fs::exists(folder.path() / "picture.exr"));
  CHECK(run("render " + scene + " --method half_resolution_march_gpu --out other.exr", folder).code == 0);
  CHECK_THAT(run("explain " + scene, folder).out,
             Contains("not available on this machine: froxel_fog_gpu is refused on "));

  const SmallProject project(box_of_fog(8, 6), against_quadrature({{"GPU", "froxel_fog_gpu", "0.5", "tile = 1"}}));
  const Result gates = run("gates --root .", project);
  CHECK(gates.code == 1);
  CHECK_THAT(gates.out, Contains("FAILED   g/e: one, GPU") && Contains("froxel_fog_gpu is refused on "));
  CHECK(run("gates --root . --unchecked", project).code == 0);

  // The record is for these shaders, and for this version of the driver.
  const bool mesa = checked.out.find("Mesa") != std::string::npos;
  if (mesa) {
    folder.set("MESA_GL_VERSION_OVERRIDE", "4.6");
    CHECK_THAT(run("doctor", folder).out, Contains("not checked: "));
    CHECK(run(render, folder).code == 0);
    folder.set("MESA_GL_VERSION_OVERRIDE", "");
  }
  CHECK(run(render, folder).code == 3);
  folder.set("AIRLIGHT_SHADERS", "");
  CHECK(run(render, folder).code == 0);
}

TEST_CASE("doctor --check without a device is one line and exit code 3", "[cli]") {
  const TemporaryFolder folder;
  const Result none = run("doctor --check --gpu none", folder);
  CHECK(none.code == 3);
  CHECK(none.error_lines() == 1);
  CHECK_THAT(none.err, Contains("gpu: none is to be used"));
}

}  // namespace device_check_test
