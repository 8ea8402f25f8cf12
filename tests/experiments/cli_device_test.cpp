// The program with a device, without one, and with one that is not there.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace cli_device_test {

using namespace airlight::test;
using airlight::read_bytes;
using airlight::TemporaryFolder;
using Catch::Contains;

// A wish that no device fulfils stands for a machine without one.
TEST_CASE("without a GPU, asking for it is one line and exit code 3, and the rest works", "[cli]") {
  const TemporaryFolder folder;
  setenv("AIRLIGHT_GPU", "no such device", 1);
  const std::string scene = scenes + "fogshop/f100.toml";
  const Result rendered = run("render " + scene + " --method fogshop_gpu --out picture.exr", folder);
  CHECK(rendered.code == 3);
  CHECK(rendered.error_lines() == 1);
  CHECK_THAT(rendered.err, Catch::StartsWith("airlight: gpu: "));
  CHECK(!std::filesystem::exists(folder.path() / "picture.exr"));
  const Result explained = run("explain " + scene, folder);
  CHECK(explained.code == 0);
  CHECK_THAT(explained.out, Contains("not available on this machine: gpu: "));
  const Result examined = run("doctor", folder);
  CHECK(examined.code == 0);
  CHECK_THAT(examined.out, Contains("graphics   gpu: "));
  unsetenv("AIRLIGHT_GPU");
}

TEST_CASE("gates of a machine without a GPU are skipped, unless the device was asked for by name", "[cli]") {
  const SmallProject folder(box_of_fog(8, 6), both_backends("0.1"));
  setenv("AIRLIGHT_GPU", "none", 1);
  const Result without = run("gates --root . --junit gates.xml", folder);
  CAPTURE(without.out, without.err);
  CHECK(without.code == 0);
  CHECK(without.err.empty());
  CHECK_THAT(without.out, Contains("ok       g/e: one, CPU") && Contains("skipped  g/e: one, GPU") &&
                              Contains("not available on this machine: gpu: none is to be used") &&
                              Contains("\n1 of 2 gates ok, 1 skipped\n"));
  CHECK_THAT(read_bytes(folder.file("gates.xml")), Contains("failures=\"0\" skipped=\"1\"") && Contains("<skipped "));
  // Rows that were left out are not kept: whoever asks for a device by name learns that it is not there.
  setenv("AIRLIGHT_GPU", "no such device", 1);
  const Result asked = run("gates --root .", folder);
  CHECK(asked.code == 1);
  CHECK_THAT(asked.out, Contains("FAILED   g/e: one, GPU") && Contains("\n1 of 2 gates ok\n"));
  CHECK_THAT(asked.err, Contains("gate failed: g/e: one, GPU"));
  unsetenv("AIRLIGHT_GPU");
}

// Results of a device are kept for that device alone.
TEST_CASE("rows of a device are not taken for another's", "[cli]") {
  const SmallProject folder(box_of_fog(8, 6), against_quadrature({{"GPU", "ray_marcher_gpu", "0.1"}}));
  const Result first = run("gates --root .", folder);
  CAPTURE(first.out);
  CHECK(first.code == 0);
  setenv("AIRLIGHT_GPU", "none", 1);
  CHECK_THAT(run("gates --root .", folder).out, Contains("\n0 of 1 gates ok, 1 skipped\n"));
  unsetenv("AIRLIGHT_GPU");
  CHECK(run("gates --root .", folder).out == first.out);
}

TEST_CASE("the device is chosen by --gpu, and one that is not there is one line and exit code 3", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene = scenes + "fogshop/f100.toml", small = " --override film.width=8 --override film.height=6",
                    vectors = root + "/tests/vectors/shadow_planes.json";
  for (const std::string& command : {"render " + scene + " --method fogshop --out picture.exr", "explain " + scene,
                                     std::string("experiment run fogshop/table1"), std::string("gates fogshop/table1"),
                                     "verify --device " + vectors}) {
    const Result r = run(command + " --gpu 'no such device'", folder);
    CAPTURE(command, r.err);
    CHECK(r.code == 3);
    CHECK(r.error_lines() == 1);
    CHECK_THAT(r.err, Catch::StartsWith("airlight: gpu: "));
  }
  CHECK(!std::filesystem::exists(folder.path() / "picture.exr"));
  const Result empty = run("render " + scene + " --method fogshop --out picture.exr --gpu ''", folder);
  CHECK(empty.code == 2);
  CHECK(empty.error_lines() == 1);
  // Without one, what needs none goes on; what does says so.
  CHECK(run("render " + scene + " --method fogshop --out picture.exr --gpu none" + small, folder).code == 0);
  const Result none = run("render " + scene + " --method fogshop_gpu --out gpu.exr --gpu None" + small, folder);
  CHECK(none.code == 3);
  CHECK(none.err == "airlight: gpu: none is to be used, as asked for\n");
  CHECK(run("verify --device --gpu none " + vectors, folder).code == 3);
  CHECK(run("verify --gpu none " + vectors, folder).code == 2);
  CHECK_THAT(run("doctor --gpu none", folder).out, Contains("graphics   gpu: none is to be used"));
  CHECK_THAT(run("render --help", folder).out, Contains("--gpu WHICH"));
  CHECK_THAT(run("--help", folder).out, Contains("--gpu WHICH"));
}

TEST_CASE("the device: the option is stronger than the variable, and an old driver is passed over", "[cli][skips]") {
  const TemporaryFolder folder;
  const std::string scene = scenes + "fogshop/f100.toml", small = " --override film.width=8 --override film.height=6";
  setenv("AIRLIGHT_GPU", "no such device", 1);
  const Result doctor = run("doctor --gpu auto", folder);
  unsetenv("AIRLIGHT_GPU");
  if (doctor.out.find("chosen: ") == std::string::npos) {
    WARN("test skipped: no device");
    return;
  }
  CHECK_THAT(run("render " + scene + " --method fogshop --out picture.exr --gpu amdahl" + small, folder).err,
             Contains("gpu: no device 'amdahl' that works; there is "));
  if (doctor.out.find("llvmpipe") == std::string::npos) return;
  setenv("MESA_GL_VERSION_OVERRIDE", "4.3", 1);
  const Result old = run("doctor", folder);
  const Result render = run("render " + scene + " -m fogshop_gpu -o gpu.exr --gpu llvmpipe", folder);
  unsetenv("MESA_GL_VERSION_OVERRIDE");
  CHECK(old.code == 0);
  CHECK_THAT(old.out, Contains("OpenGL 4.5"));
  CHECK(render.code == 3);
  CHECK(render.error_lines() == 1);
}

}  // namespace cli_device_test
