// Work that is larger than the machine, or than --limit allows: refused in one line before it is done, or in its first second.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <chrono>

#include "scene/film/grey_image.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace cli_limit_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

namespace {

const std::string camera = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
const std::string fog =
    "[[light]]\ntype = 'point'\nposition = [0, 2, 0]\nintensity = 1\n[[medium]]\ntype = 'homogeneous'\n"
    "region = { type = 'box', lo = [-1, -1, -1], hi = [1, 1, 1] }\n";
const std::string flow =
    "name = 'f'\n[flow]\nduration = 0.1\nframe_rate = 10\nbox = { lo = [0, 0, 0], hi = [1, 1, 1] }\n"
    "[start]\ndensity = 1\n";

void refused(const TemporaryFolder& folder, const std::string& arguments, const std::string& says) {
  CAPTURE(arguments);
  const auto start = std::chrono::steady_clock::now();
  const Result result = run(arguments, folder);
  CAPTURE(result.err);
  CHECK(result.code == 2);
  CHECK(result.error_lines() == 1);
  CHECK_THAT(result.err, Contains(says));
  CHECK(std::chrono::steady_clock::now() - start <
        std::chrono::seconds(30));  // of work of hours, on a machine that is busy
}

}  // namespace

TEST_CASE("memory that a command may not take is refused before it is taken", "[cli][limit]") {
  const TemporaryFolder folder;
  scene::write_grey_image(folder.file("a.png"), {3000, 3000, std::vector<double>(9'000'000, 0.5), ""});
  folder.write("backdrop.toml", camera + "[backdrop]\nimage = 'a.png'\ndepth = 'a.png'\n" + fog);
  folder.write("fog.toml", camera + fog);
  folder.write("flow.toml", flow);
  refused(folder, "render backdrop.toml -m ray_marcher -o a.exr --limit 128MiB",
          "a.png: 3000 x 3000 pixels: would take this");
  CHECK(run("render backdrop.toml -m ray_marcher -o a.exr --override film.width=8 --override film.height=6", folder)
            .code == 0);
  const std::string large = " --override film.width=16384 --override film.height=16384 --limit 2GiB";
  for (const std::string method : {"ray_marcher", "path_tracer", "deterministic"})
    refused(folder, "render fog.toml -o a.exr -m " + method + large,
            "a film of 16384 x 16384: would take this program to about ");
  refused(folder, "simulate flow.toml -m legendre_fluids --set cells=1024 --out o --limit 4GiB",
          "frames of 1024 x 1024 x 1024 cells: would take this program to about 70 GiB of memory, --limit allows 4");
  refused(folder, "simulate flow.toml --set n=512 --out o --limit 4GiB", "512 x 512 x 512 cells: would take");
}

TEST_CASE("time that a command may not take is refused before it is spent", "[cli][limit]") {
  const TemporaryFolder folder;
  folder.write("fog.toml", "[film]\nwidth = 8\nheight = 6\n" + camera + fog);
  folder.write("flow.toml", flow);
  folder.write("discs.toml", camera + fog +
                                 "[[particles]]\ntype = 'disc'\ncount = 1000000\nradius = 3\nradiance = [[1, 1, 1]]\n"
                                 "region = { type = 'box', lo = [-1, -1, -1], hi = [1, 1, 1] }\n");
  std::string wide = "center_x,center_y,center_z,width,amplitude\n";
  for (int i = 0; i < 2000; ++i) wide += fmt::format("{},1,1,100,1e-6\n", i);
  folder.write("wide.csv", wide);
  folder.write("wide.toml", camera + fog +
                                "[[medium]]\ntype = 'fitted'\ngaussians = 'wide.csv'\nsize = [600, 600, 600]\n"
                                "voxel_size = 0.1\norigin = [0, 0, 0]\n");
  folder.write("air.jsonl", R"({"op": "view", "position": [0, 0, 5], "look_at": [0, 0, 0]}
{"op": "airbrush", "pos": [0,0,0], "rate": 1, "speed": 1, "diffusion": 0, "dt": 1e-9, "steps": 900000000, "a": 3, "c": 1}
)");
  folder.write("blur.jsonl", R"({"op": "fogmap", "width": 8192, "height": 8192, "cell": 1}
{"op": "view", "position": [0, 2, -20], "look_at": [0, 1, 0]}
{"op": "blur", "deviation": 9000}
)");
  refused(folder, "render discs.toml -m ray_marcher -o a.exr --limit 1min", "drawing 1000000 particles: takes about ");
  refused(folder, "render wide.toml -m ray_marcher -o a.exr --limit 5s",
          "2000 Gaussians in 216000000 samples: takes about ");
  refused(folder, "author air.jsonl -o a.toml --limit 10s", "airbrush of 900000000 steps: takes about ");
  refused(folder, "author blur.jsonl -o a.toml --limit 10min", "a blur of 9000 pixels over 8192 x 8192: takes about ");
  // The limit is checked by the time of the first second.
  refused(folder, "render fog.toml -m path_tracer --samples 99999999999 -o a.exr --limit 1h",
          "path_tracer fog: takes about ");
  refused(folder, "simulate flow.toml --set n=4 --set dt=1e-8 --out o --limit 20s", "stable_fluids f: takes about ");
  CHECK(run("render fog.toml -m path_tracer --samples 4 -o a.exr --limit 1h --limit 1GiB", folder).code == 0);
}

// Within a row, not only between rows; and no gate is said to fail.
TEST_CASE("an experiment ends where its time is over", "[cli][limit]") {
  const SmallProject project(box_of_fog(64, 64),
                             against_quadrature({{"slow", "ray_marcher", "1", "steps = 65536, shadow_steps = 1024"}}));
  for (const std::string command : {"experiment run", "gates --junit report.xml"}) {
    refused(project, command + " --root . --limit 2s", "not done after 2 s, which is what --limit allows");
    CHECK_THAT(run(command + " --root . --limit 2s", project).out, !Contains("FAILED"));
  }
  const std::string report = read_bytes(project.file("report.xml"));
  CHECK_THAT(report, Contains("<error") && Contains("not done after 2 s") && !Contains("<failure"));
}

TEST_CASE("a limit is an amount with a unit", "[cli][limit]") {
  const TemporaryFolder folder;
  folder.write("fog.toml", camera + fog);
  for (const std::string limit : {"2", "GiB", "-1GiB", "0s", "nanGiB", "infs", "1e400s", "2GB", "1 s", "10 minutes"})
    refused(folder, "explain fog.toml --limit '" + limit + "'", "expected an amount with GiB, MiB, s, min or h");
}

}  // namespace cli_limit_test
