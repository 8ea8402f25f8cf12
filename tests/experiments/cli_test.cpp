// The program itself, as users call it: exit codes, one line on standard error, nothing half-written.
#include <fmt/format.h>
#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "methods/fogshop/fogshop.h"
#include "scene/film/film.h"
#include "scene/scene.h"
#include "tests/experiments/run_program.h"

namespace cli_test {

using airlight::read_bytes;
using airlight::TemporaryFolder;
using airlight::test::program;
using airlight::test::Result;
using airlight::test::root;
using airlight::test::run;
using airlight::test::run_command;
using airlight::test::scenes;
using Catch::Contains;

TEST_CASE("help is quick", "[cli]") {
  const TemporaryFolder folder;
  // Processor time: other tests run beside.
  const auto used = [] {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
  };
  double best = 1;
  for (int i = 0; i < 5; ++i) {
    const double before = used();
    const Result r = run("--help", folder);
    best = std::min(best, used() - before);
    CHECK(r.code == 0);
    CHECK_THAT(r.out, Contains("render") && Contains("experiment"));
  }
  // The promise is 0.1 s; two shells start too.
  CHECK(best < 0.15);
}

TEST_CASE("usage errors are one line, exit code 2, and name the nearest", "[cli]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& arguments, const std::string& says) {
    const Result r = run(arguments, folder);
    CAPTURE(arguments, r.err);
    CHECK(r.code == 2);
    CHECK(r.error_lines() == 1);
    CHECK_THAT(r.err, Catch::StartsWith("airlight: ") && Contains(says));
  };
  refused("rendr x.toml", "nearest: render");
  refused("experiment rum", "nearest: run");
  refused("render x.toml --methud fogshop", "nearest: --method");
  refused("render x.toml -m fogshp -o a.exr", "nearest: fogshop");
  refused("render x.toml -m fogshop", "--out is missing");
  refused("", "expected a command");
  refused("help", "unknown command 'help'; see airlight --help");
  refused("render " + scenes + "constant_homogeneous.toml -m ray_marcher -o a.png", "a.png: expected a name in .exr");
  refused("render " + scenes + "constant_homogeneous.toml -m ray_marcher -o a.exr --png b.exr",
          "expected a name in .png");
  refused("merge " + scenes + "constant_homogeneous.toml a.samples -o a.pfm", "a.pfm: expected a name in .exr");
  refused("compare a.exr b.exr --equal 0", "--equal 0: expected a rate above 0");
  refused("compare a.exr b.exr --override film.width=4", "expected --scene");
  refused("render " + scenes + "constant_homogeneous.toml -m ray_marcher -o a.exr --set ' =3'", "expected name=value");
  refused("render no_such_file.toml -m ray_marcher -o a.exr", "no_such_file.toml");
  refused("render " + scenes + "constant_homogeneous.toml -m ray_marcher -o no/such/folder/a.exr", "no folder");
  refused("render " + scenes + "constant_homogeneous.toml -m ray_marcher -o a.exr --set stps=3", "nearest: step");
  refused("render " + scenes + "constant_homogeneous.toml -m ray_marcher -o a.exr --set steps=-3", "out of range");
  refused("render " + scenes + "constant_homogeneous.toml -m ray_marcher -o a.exr --set steps", "expected name=value");
  refused("render " + scenes + "constant_homogeneous.toml -m ray_marcher -o a.exr --override film.widht=4",
          "nearest: width");
  refused("render " + scenes + "constant_homogeneous.toml -m path_tracer -o a.exr --samples 9..3", "not empty");
  refused("render " + scenes + "constant_homogeneous.toml -m ray_marcher -o a.exr --threads many", "threads");
  refused("render " + scenes + "constant_homogeneous.toml -m path_tracer -o a.exr --samples 1..3", "multiple of 64");
  refused("render " + scenes + "constant_homogeneous.toml -m ray_marcher -o a.exr --samples 0..3", "path_tracer");
  refused("compare a.exr", "REFERENCE is missing");
  refused("compare a.exr b.exr", "a.exr");
  refused("compare a.exr b.exr --max rel_l3=1", "nearest: rel_l2");
  refused("convert a.exr b.gif", ".png or .pfm");
  refused("experiment list --root .", "experiments/README.md");
  refused("experiment list --root '" + root + "' nothing_like_it", "unknown experiment");
  refused("gates --root '" + root + "' --profile fast", "quick or paper");
  CHECK_FALSE(std::filesystem::exists(folder.path() / "a.exr"));
}

TEST_CASE("render, compare and convert", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene = scenes + "constant_homogeneous.toml";
  const std::string small = " --override 'film.width = 16' --override film.height=12";
  REQUIRE(run("render " + scene + small + " -m deterministic -o truth.exr --png truth.png", folder).code == 0);
  REQUIRE(run("render " + scene + small + " -m ray_marcher --set 'steps = 64' -o marched.exr", folder).code == 0);
  const std::string one = " -m path_tracer --set max_order=1 --samples 256 -o ";
  REQUIRE(run("render " + scene + small + one + "traced.exr --threads 1", folder).code == 0);
  CHECK(std::filesystem::file_size(folder.path() / "truth.png") > 0);
  const auto film = airlight::scene::read_exr((folder.path() / "traced.exr").string());
  CHECK(film.metadata.at("renderer") == "path_tracer");
  CHECK(film.metadata.at("scene_hash").size() == 32);
  CHECK_THAT(film.metadata.at("settings"), Contains("max_order=1"));

  const Result good = run("compare marched.exr truth.exr --max rel_l2=0.01 --metric bias", folder);
  CAPTURE(good.out, good.err);
  CHECK(good.code == 0);
  CHECK_THAT(good.out, Contains("bias") && Contains("rel_l2") && Contains("ok, bound"));
  // Order one of the path tracer is the deterministic truth. Fixed seed; false alarm 1e-4.
  const Result equal = run("compare traced.exr truth.exr --equal 1e-4 --max rel_l2=0.01", folder);
  CAPTURE(equal.out);
  CHECK(equal.code == 0);
  CHECK_THAT(equal.out, Contains("equal: "));
  const Result itself = run("compare traced.exr traced.exr --equal 1e-4 --metric bias", folder);
  CHECK(itself.code == 1);
  CHECK_THAT(itself.out, Contains("different, too alike"));
  CHECK(run("compare marched.exr truth.exr --scene " + scene + small, folder).code == 0);
  CHECK_THAT(run("compare marched.exr truth.exr --scene " + scene, folder).err, Contains("film is"));
  // A few steps are wrong beyond any noise.
  REQUIRE(run("render " + scene + small + " -m ray_marcher --set steps=1 -o bad.exr", folder).code == 0);
  const Result bad = run("compare bad.exr truth.exr --max rel_l2=0.0001", folder);
  CHECK(bad.code == 1);
  CHECK_THAT(bad.out, Contains("ABOVE"));

  CHECK(run("convert truth.exr truth.pfm --layer airlight", folder).code == 0);
  CHECK(std::filesystem::file_size(folder.path() / "truth.pfm") ==
        std::string("PF\n16 12\n-1.0\n").size() + 16 * 12 * 12);
  CHECK(run("convert truth.exr again.png --layer nothing", folder).code == 2);
}

TEST_CASE("ranges of samples merge to the bits of one render", "[cli]") {
  const TemporaryFolder folder;
  const std::string small = scenes + "constant_homogeneous.toml --override film.width=16 --override film.height=12 ";
  const auto part = [&](const std::string& samples, const std::string& out) {
    REQUIRE(run("render " + small + "-m path_tracer --set seed=7 --samples " + samples + " -o " + out, folder).code ==
            0);
  };
  part("0..192", "whole.exr");
  part("0..64", "a.exr");
  part("64..192", "b.exr");
  REQUIRE(run("merge " + small + "b.exr.samples a.exr.samples -o merged.exr", folder).code == 0);
  const auto whole = airlight::scene::read_exr(folder.file("whole.exr"));
  const auto merged = airlight::scene::read_exr(folder.file("merged.exr"));
  CHECK(whole.layers == merged.layers);
  CHECK(merged.metadata.at("sample_ranges") == "0..192");
  CHECK(merged.metadata.at("complete") == "true");
  for (const auto& [name, value] : whole.metadata) {
    CAPTURE(name);
    if (name != "seconds") CHECK(merged.metadata.at(name) == value);
  }
  CHECK(merged.metadata.size() == whole.metadata.size());

  const auto refused = [&](const std::string& arguments, const std::string& says) {
    const Result r = run("merge " + arguments, folder);
    CAPTURE(arguments, r.err);
    CHECK(r.code == 2);
    CHECK_THAT(r.err, Contains(says));
  };
  part("128..192", "c.exr");
  refused(small + "a.exr.samples a.exr.samples -o x.exr", "a.exr.samples");
  refused(small + "a.exr.samples c.exr.samples -o x.exr", "128");  // a gap
  refused(scenes + "constant_grid.toml a.exr.samples b.exr.samples -o x.exr",
          "found a film of 16 x 12, expected 64 x 48");
  refused(small + "a.exr -o x.exr", "not a file of path tracer samples");
  CHECK_FALSE(std::filesystem::exists(folder.file("x.exr")));
}

TEST_CASE("compare says where noise is unknown", "[cli]") {
  const TemporaryFolder folder;
  const std::string traced = "render " + scenes +
                             "constant_homogeneous.toml -m path_tracer --samples 128 "
                             "--override film.width=8 --override film.height=6 -o noisy.exr";
  REQUIRE(run(traced, folder).code == 0);
  CHECK(run("compare noisy.exr noisy.exr", folder).err.empty());
  airlight::scene::Film film = airlight::scene::read_exr(folder.file("noisy.exr"));
  std::erase_if(film.layers, [](const auto& layer) {
    return layer.first == "se" || layer.first.ends_with(".se") || layer.first.find("batch.") != std::string::npos;
  });
  airlight::scene::write_exr(folder.file("bare.exr"), film);
  const Result bare = run("compare noisy.exr bare.exr", folder);
  CHECK(bare.code == 0);
  CHECK(bare.error_lines() == 1);
  CHECK_THAT(bare.err, Contains("bare.exr: warning: has 128 samples a pixel and no batches: its noise is unknown"));
}

// No room on standard error, or no standard error at all, changes no exit code; and a message never lands in a file that
// happens to have its number.
TEST_CASE("messages that cannot be written change nothing", "[cli]") {
  const TemporaryFolder folder;
  const std::string good = "render " + scenes + "constant_homogeneous.toml -m ray_marcher -o a.exr";
  const auto code = [&](const std::string& arguments, const std::string& streams) {
    return run_command("( '" + program + "' " + arguments + " " + streams + " )", folder).code;
  };
  CHECK(code(good, "") == 0);
  const auto picture = airlight::scene::read_exr(folder.file("a.exr")).layers;
  for (const std::string lost : {"2>/dev/full", "2>&-", "<&- 2>&-"}) {
    CAPTURE(lost);
    CHECK(code("render nope.toml -m fogshop -o x.exr", lost) == 2);
    CHECK(code("compare a.exr a.exr --max rel_l2=nan", lost) == 2);
    CHECK(code(good, lost) == 0);
    CHECK(code("compare a.exr a.exr", lost) == 0);
  }
  for (const std::string lost : {">/dev/full", ">&-", ">/dev/full 2>/dev/full", ">&- 2>&-"}) {
    CAPTURE(lost);
    CHECK(code("compare a.exr a.exr", lost) == 2);
    CHECK(code("doctor", lost) == 2);
    CHECK(code(good, lost) == 0);  // says nothing where all is well
  }
  CHECK((airlight::scene::read_exr(folder.file("a.exr")).layers == picture));
  const Result full = run_command("( '" + program + "' doctor >/dev/full )", folder);
  CHECK_THAT(full.err, Contains("standard output could not be written"));
}

// The cache's disk is full (here: its file would be too long) after all the work was done.
TEST_CASE("a picture whose samples cannot be kept is written all the same", "[cli]") {
  const TemporaryFolder folder;
  const std::string render =
      "'" + program + "' render " + scenes +
      "constant_homogeneous.toml --override film.width=16 --override film.height=12 -m path_tracer "
      "--samples 256 -o ";
  REQUIRE(run_command(render + "good.exr --cache kept", folder).code == 0);
  std::uintmax_t samples = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder.path() / "kept"))
    if (file.is_regular_file()) samples = std::max(samples, file.file_size());
  const std::uintmax_t blocks = std::filesystem::file_size(folder.file("good.exr")) / 512 + 1;  // that a shell counts
  REQUIRE(samples > 512 * blocks);
  const Result lost = run_command(
      "trap '' XFSZ && ulimit -f " + std::to_string(blocks) + " && " + render + "a.exr --cache full", folder);
  CAPTURE(lost.err);
  CHECK(lost.code == 2);
  CHECK(lost.error_lines() == 1);
  CHECK_THAT(lost.err, Catch::StartsWith("airlight: warning: full/samples/") &&
                           Contains("cannot write: File too large; a.exr is written, its samples are not kept"));
  CHECK((airlight::scene::read_exr(folder.file("a.exr")).layers ==
         airlight::scene::read_exr(folder.file("good.exr")).layers));
}

TEST_CASE("explain and doctor", "[cli]") {
  const TemporaryFolder folder;
  const Result explained = run("explain " + scenes + "constant_homogeneous.toml --verbose", folder);
  CHECK(explained.code == 0);
  CHECK_THAT(explained.out, Contains("computes") && Contains("leaves out") && Contains("cannot render this scene") &&
                                Contains("path_tracer") && Contains("ray_marcher") && Contains("fogshop"));
  CHECK_THAT(explained.out, Contains("\n  medium 0, homogeneous, phase "));  // it has no name
  const Result doctor = run("doctor", folder);
  CHECK(doctor.code == 0);
  CHECK_THAT(doctor.out, Contains("Embree 3") && Contains("processor") && Contains("graphics"));
}

// A path tracer that is stopped keeps its samples, and the film says how many.
TEST_CASE("what airlight lacks airlight_studies computes, of the same commit, or one line says so", "[cli]") {
  const TemporaryFolder folder;
  const std::string vectors = root + "/tests/vectors/fogshop.json --kind F";
  const Result here = run("verify " + vectors, folder);
  CHECK(here.code == 0);
  CHECK_THAT(here.out, Contains(" 0 out;"));
  const Result other = run_command("AIRLIGHT_COMMIT_BEFORE=0 '" + program + "' verify " + vectors, folder);
  CHECK(other.code == 3);
  CHECK(other.out.empty());
  CHECK(other.error_lines() == 1);
  CHECK_THAT(other.err, Contains(" of 0: scripts/build builds both"));
  std::filesystem::copy_file(program, folder.file("airlight"));
  const Result alone = run_command("./airlight verify " + vectors, folder);
  CHECK(alone.code == 3);
  CHECK(alone.error_lines() == 1);
  CHECK_THAT(alone.err, Contains("airlight_studies: No such file or directory") && Contains("scripts/build"));
}

TEST_CASE("Ctrl-C keeps the samples of a path tracer, and no other picture is made of them", "[cli]") {
  const TemporaryFolder folder;
  const std::string scene = scenes + "constant_homogeneous.toml --override film.width=16 --override film.height=12 ";
  const std::string many = "render " + scene + "-m path_tracer --set max_order=1 --cache kept --samples ";
  const Result stopped = run(many + "65536 -o a.exr & pid=$!; sleep 1; kill -INT $pid; wait $pid; exit $?; #", folder);
  CAPTURE(stopped.err);
  CHECK(stopped.code == 130);
  const auto part = airlight::scene::read_exr(folder.file("a.exr"));
  CHECK(part.metadata.at("complete") == "false");
  // Fewer samples than there are now: exactly those, and the stopped render loses nothing by it.
  REQUIRE(run(many + "1024 -o b.exr", folder).code == 0);
  REQUIRE(run("render " + scene + "-m path_tracer --set max_order=1 --samples 1024 -o c.exr", folder).code == 0);
  const auto fewer = airlight::scene::read_exr(folder.file("b.exr")),
             whole = airlight::scene::read_exr(folder.file("c.exr"));
  CHECK(fewer.metadata.at("samples") == "1024");
  CHECK(fewer.layers == whole.layers);
}

// The terminal is closed. Under nohup, which has the signal ignored, work goes on.
TEST_CASE("SIGHUP stops a render with a line, but not under nohup", "[cli]") {
  const TemporaryFolder folder;
  const auto hung_up = [&](const std::string& before, const std::string& steps) {
    return run_command("( " + before + "'" + program + "' render " + scenes +
                           "constant_homogeneous.toml -m ray_marcher -o a.exr --set steps=" + steps +
                           " & pid=$!; sleep 0.3; kill -HUP $pid; wait $pid )",
                       folder);
  };
  const Result r = hung_up("", "100000");
  CHECK(r.code == 130);
  CHECK(r.err == "airlight: interrupted\n");
  CHECK_FALSE(std::filesystem::exists(folder.file("a.exr")));
  CHECK(hung_up("trap '' HUP; ", "1500").code == 0);
  CHECK(std::filesystem::exists(folder.file("a.exr")));
}

TEST_CASE("Ctrl-C stops a render and leaves nothing half-written", "[cli]") {
  const TemporaryFolder folder;
  const Result r = run("render " + scenes +
                           "constant_homogeneous.toml -m ray_marcher --set steps=100000 -o a.exr & "
                           "pid=$!; sleep 1; kill -INT $pid; wait $pid; exit $?; #",
                       folder);
  CHECK(r.code == 130);
  for (const auto& file : std::filesystem::directory_iterator(folder.path()))
    CHECK_THAT(file.path().filename().string(), !Contains("a.exr"));
}

}  // namespace cli_test
