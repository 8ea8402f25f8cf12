// airlight author with a script that draws a fogmap.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "experiments/authoring/fogmap_script.h"
#include "scene/base/error.h"
#include "scene/film/grey_image.h"
#include "scene/media/fogmap.h"
#include "scene/scene.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace author_fogmap_test {

using namespace airlight;
using namespace airlight::experiments::authoring;
using Catch::Contains;

namespace {

const std::string head =
    R"({"op": "fogmap", "width": 16, "height": 12, "cell": 2, "profile": {"type": "layers", "knots": [[0, 1], [5, 0]]}}
{"op": "view", "position": [0, 2, -20], "look_at": [0, 1, 0], "width": 8, "height": 6}
)";

DrawnFogmap run(const TemporaryFolder& folder, const std::string& operations) {
  folder.write("s.jsonl", head + operations);
  return run_fogmap_script(folder.file("s.jsonl"), [] {});
}

double sum(const DrawnFogmap& drawn) {
  return std::accumulate(drawn.canvas.values().begin(), drawn.canvas.values().end(), 0.0);
}

std::string refusal(const TemporaryFolder& folder, const std::string& operations) {
  return test::message_of([&] { run(folder, operations); });
}

const std::string stroke =
    R"({"op": "stroke", "points": [[-1, 1]], "radius": 5, "hardness": 0.5, "opacity": 0.5, "value": 0.8}
)";

}  // namespace

TEST_CASE("a drawn fogmap: strokes, noise, blur, undo", "[authoring][wavelet_fog]") {
  const TemporaryFolder folder;
  const DrawnFogmap one = run(folder, stroke);
  // The pixel under the brush: centres lie at odd places, (-1, 1) is pixel (7, 6).
  CHECK(one.canvas.values()[6 * 16 + 7] == Approx(0.4));
  CHECK(one.canvas.values()[6 * 16 + 12] == 0);  // 10 m away
  CHECK(one.canvas.values()[6 * 16 + 9] > 0);    // 4 m away, in the fall
  CHECK(one.canvas.values()[6 * 16 + 9] < 0.4);
  const std::string erase =
      R"({"op": "stroke", "points": [[-1, 1], [9, 1]], "radius": 5, "hardness": 1, "mode": "erase"}
)";
  CHECK(sum(run(folder, stroke + erase)) < 0.2 * sum(one));
  CHECK(run(folder, stroke + erase + R"({"op": "undo"})").canvas.values() == one.canvas.values());
  const std::string blur = R"({"op": "blur", "deviation": 3}
)";
  const DrawnFogmap blurred = run(folder, stroke + blur);
  CHECK(sum(blurred) == Approx(sum(one)).epsilon(1e-13));
  CHECK(blurred.done.back().greatest < 0.35);
  const std::string noise = R"({"op": "noise", "seed": 3, "size": 8, "low": -0.5, "high": 0.9}
)";
  const DrawnFogmap noisy = run(folder, noise);
  CHECK(noisy.done.back().greatest == Approx(0.9));
  int empty = 0;
  for (const double value : noisy.canvas.values()) empty += value == 0;
  CHECK(empty > 30);
  CHECK(empty < 150);
  CHECK(run(folder, noise).canvas.values() == noisy.canvas.values());
  CHECK(run(folder, R"({"op": "noise", "seed": 4, "size": 8, "low": -0.5, "high": 0.9})").canvas.values() !=
        noisy.canvas.values());
}

TEST_CASE("a drawn fogmap is a scene that can be read", "[authoring][wavelet_fog]") {
  const TemporaryFolder folder;
  const DrawnFogmap drawn = run(folder, stroke);
  CHECK(write(drawn, "s.jsonl", folder.file("a.toml")) == "a.png");
  const scene::Scene scene = scene::load_scene(folder.file("a.toml"));
  const auto& fog = *std::get<scene::FogmapPointer>(scene.media.at(0).field);
  CHECK(fog.map.coefficient(7, 6) == Approx(0.4).margin(0.5 / 65535));
  CHECK(scene::density(fog, {-1, 0, 1}) > 0.2);
  const DrawnFogmap thick =
      run(folder, stroke + R"({"op": "stroke", "points": [[-1, 1]], "radius": 5, "value": 7, "mode": "add"})");
  CHECK(write(thick, "s.jsonl", folder.file("b.toml")) == "b.exr");
  const scene::GreyImage image = scene::read_grey_image(folder.file("b.exr"), "", 1000);
  CHECK(image.values[6 * 16 + 7] == Approx(7.4).epsilon(1e-6));
}

TEST_CASE("a map that is blurred further than it reaches is its mean", "[authoring][wavelet_fog]") {
  const TemporaryFolder folder;
  const double mean = sum(run(folder, stroke)) / (16 * 12);
  for (const std::string deviation : {"127", "128", "1e5", "1e300"}) {  // 4 times its longer side is 128 m
    CAPTURE(deviation);
    const DrawnFogmap drawn = run(folder, stroke + R"({"op": "blur", "deviation": )" + deviation + "}");
    for (const double value : drawn.canvas.values()) CHECK(value == Approx(mean).epsilon(1e-3));
  }
}

TEST_CASE("a drawn fogmap may have any name, and no range but a scene's", "[authoring][wavelet_fog]") {
  const TemporaryFolder folder;
  const std::string out = folder.file("a\"b\\c\nd.toml");
  write(run(folder, stroke), "s.jsonl", out);
  CHECK(scene::load_scene(out).media.size() == 1);
  std::filesystem::remove_all(out);
  const DrawnFogmap far = run(folder, stroke);
  DrawnFogmap beyond = far;
  beyond.medium.insert(beyond.medium.find("corner = [-16") + 13, "e30");
  CHECK_THROWS_WITH(write(beyond, "s.jsonl", folder.file("far.toml")), Contains("far.toml: not written, since"));
  CHECK_FALSE(std::filesystem::exists(folder.file("far.png")));
  CHECK_FALSE(std::filesystem::exists(folder.file("far.toml")));
}

TEST_CASE("a drawn fogmap: what is wrong is named", "[authoring][wavelet_fog]") {
  const TemporaryFolder folder;
  CHECK_THAT(refusal(folder, R"({"op": "stroke", "points": [[0, 0]], "radius": 0})"),
             Contains("s.jsonl:3: stroke: radius = 0"));
  CHECK_THAT(refusal(folder, R"({"op": "undo"})"), Contains("count = 1, expected at most 0"));
  CHECK_THAT(refusal(folder, R"({"op": "columns", "file": "no.vdb", "height": 1})"), Contains("s.jsonl:3: "));
  CHECK_THAT(refusal(folder, R"({"op": "fogmap", "width": 2, "height": 2})"), Contains("once"));
  folder.write("t.jsonl", R"({"op": "noise", "size": 1})");
  CHECK_FALSE(draws_fogmap(folder.file("t.jsonl")));
  CHECK_THROWS_WITH(run_fogmap_script(folder.file("t.jsonl"), [] {}), Contains("before 'fogmap'"));
}

TEST_CASE("scripts give the committed fogmaps", "[authoring][wavelet_fog][scenes]") {
  int scripts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(AIRLIGHT_SOURCE_DIR "/experiments/scenes/wavelet_fog")) {
    if (entry.path().extension() != ".jsonl") continue;
    ++scripts;
    CAPTURE(entry.path());
    const TemporaryFolder folder;
    const std::string name = entry.path().stem().string();
    const DrawnFogmap drawn = run_fogmap_script(entry.path().string(), [] {});
    write(drawn, entry.path().string(), folder.file(name + ".toml"));
    const std::filesystem::path committed = entry.path().parent_path() / name;
    CHECK(read_bytes(folder.file(name + ".toml")) == read_bytes(committed.string() + ".toml"));
    // Pictures are compared by their values, because the library decides how they are packed.
    CHECK(scene::read_grey_image(folder.file(name + ".png"), "", 10'000).values ==
          scene::read_grey_image(committed.string() + ".png", "", 10'000).values);
  }
  CHECK(scripts >= 3);
}

}  // namespace author_fogmap_test
