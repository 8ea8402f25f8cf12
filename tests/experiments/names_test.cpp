// Names and texts of experiment files: what is made of them, and that nothing in them is run or leads elsewhere.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <set>

#include "experiments/driver/plots.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace names_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

// The text as a basic string of TOML.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", int(c));
    else
      out += c;
  }
  return out + "\"";
}

// Every name and text of an experiment that reaches a file name, a plot or a table.
std::string experiment_of(const std::string& name, const std::string& text) {
  const std::string n = quoted(name), t = quoted(text);
  return fmt::format(R"(title = {1}
paper = {1}
about = {1}
layer = "airlight"
metrics = ["rel_l2"]
[[scene]]
name = {0}
file = "scenes/one.toml"
[reference]
renderer = "deterministic"
[[method]]
name = {0}
renderer = "ray_marcher"
sweep = {{ key = "steps", values = [4, 8] }}
[profile.quick]
budget = 0
[[plot]]
name = {0}
title = {1}
x = "setting"
y = "rel_l2"
x_label = {1}
y_label = {1}
)",
                     n, t);
}

bool was_run(const fs::path& folder) {
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename() == "injected") return true;
  return false;
}

std::set<std::string> files_below(const fs::path& folder) {
  std::set<std::string> files;
  if (fs::exists(folder))
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file()) files.insert(fs::relative(entry.path(), folder).string());
  return files;
}

}  // namespace

TEST_CASE("gnuplot shows every text as it is, and runs nothing of it", "[driver][plots][skips]") {
  if (!experiments::has_gnuplot()) {
    WARN("test skipped: gnuplot is not installed");
    return;
  }
  for (const std::string text :
       {"`touch injected`", "$(touch injected)", "'; system 'touch injected'; '", "''; system \"touch injected\"",
        "\".system('touch injected').\"", "'.system('touch injected').'", "\"; system \"touch injected\"; \"",
        "touch injected\\", "{/Bold touch injected} @x $a %s", "# touch injected"}) {
    CAPTURE(text);
    const SmallProject project(box_of_fog(8, 6), experiment_of(text, text + "\n!touch injected\n"));
    const Result result = run("experiment run g/e --root .", project);
    CAPTURE(result.err);
    CHECK(result.code == 0);
    CHECK_FALSE(was_run(project.path()));
    int plots = 0;
    for (const std::string& file : files_below(project.path() / "results/g/e/plots")) {
      if (!file.ends_with(".svg")) continue;
      ++plots;
      // In the title, the labels of both axes and the key.
      const std::string svg = read_bytes((project.path() / "results/g/e/plots" / file).string());
      int shown = 0;
      for (std::size_t at = 0; (at = svg.find("touch injected", at)) != std::string::npos; ++at) ++shown;
      CHECK(shown >= 4);
    }
    CHECK(plots == 1);
  }
}

TEST_CASE("a folder's name is no command either", "[driver][plots][skips]") {
  if (!experiments::has_gnuplot()) {
    WARN("test skipped: gnuplot is not installed");
    return;
  }
  const SmallProject project(box_of_fog(8, 6), experiment_of("a", "b"));
  const Result result = run("experiment run g/e --root . --results \"it's; touch injected; '\"", project);
  CAPTURE(result.err);
  CHECK(result.code == 0);
  CHECK_FALSE(was_run(project.path()));
  CHECK(project.has("it's; touch injected; '/g/e/plots/a.a.svg"));
}

TEST_CASE("a name is one line, and is refused where it is read", "[driver][experiment]") {
  for (const std::string& name :
       {std::string("a\nb"), std::string("a\0b", 3), std::string("\x1b[31m"), std::string(), std::string(201, 'a')}) {
    const SmallProject project(box_of_fog(8, 6), experiment_of(name, "t"));
    const Result result = run("experiment run g/e --root .", project);
    CAPTURE(result.err);
    CHECK(result.code == 2);
    CHECK(result.error_lines() == 1);
    CHECK_THAT(result.err, Contains("e.toml:7:8: ") && Contains("expected a name of 1 to 200 bytes in one line"));
    CHECK_FALSE(project.has("results/g"));
  }
}

// Each of these would give two rows one picture, or one name.
TEST_CASE("names are held apart before anything is written", "[driver][experiment]") {
  const std::string top = "title = \"t\"\nlayer = \"airlight\"\nmetrics = [\"rel_l2\"]\n[profile.quick]\nbudget = 0\n",
                    reference = "[reference]\nrenderer = \"deterministic\"\n",
                    scene = "[[scene]]\nfile = \"scenes/one.toml\"\n",
                    marcher = "[[method]]\nrenderer = \"ray_marcher\"\n";
  const auto said = [&](const std::string& text) {
    const SmallProject project(box_of_fog(8, 6), text);
    const Result result = run("experiment run g/e --root .", project);
    if (result.code == 2) {
      CHECK(result.error_lines() == 1);
      CHECK_FALSE(project.has("results/g"));
      CHECK_FALSE(project.has("results/images"));
    }
    return result.code == 0 ? "" : result.err;
  };
  const auto named = [](const std::string& name) { return "name = \"" + name + "\"\n"; };
  CHECK_THAT(said(top + reference + scene + marcher + named("reference")),
             Contains("e.toml:10:1: the picture 'reference' of method 'reference' is that of the reference, too"));
  CHECK_THAT(said(top + reference + scene + marcher + named("A b") + marcher + named("A_b")),
             Contains("e.toml:13:1: the picture 'A_b' of method 'A_b' is that of method 'A b', too"));
  CHECK_THAT(said(top + reference + scene + marcher + "settings = { steps = 4 }\n" + marcher),
             Contains("of method 'ray_marcher' is that of method 'ray_marcher', too"));
  CHECK_THAT(said(top + reference + scene + scene + marcher),
             Contains("the folder of pictures 'one' of scene 'one' is that of scene 'one', too"));
  CHECK_THAT(said(top + reference + scene + named("a:b") + scene + named("a/b") + marcher),
             Contains("the folder of pictures 'a_b' of scene 'a/b' is that of scene 'a:b', too"));
  CHECK_THAT(
      said(top + reference + scene + marcher + "sweep = { key = \"steps\", values = [5, 5] }\n"),
      Contains("of method 'ray_marcher' with setting '5' is that of method 'ray_marcher' with setting '5', too"));
  CHECK_THAT(
      said(top + reference + scene + "sweep = { key = \"medium.0.sigma_t\", values = [0.001, 1e-3] }\n" + marcher),
      Contains("of scene 'one 0.001' is that of scene 'one 0.001', too"));
  CHECK_THAT(said(top + reference + scene + marcher + named("a") + "sweep = { key = \"steps\", values = [5] }\n" +
                  marcher + named("a_5")),
             Contains("the picture 'a_5' of method 'a_5' is that of method 'a' with setting '5', too"));
  const std::string plot = "[[plot]]\nx = \"setting\"\ny = \"rel_l2\"\n";
  CHECK_THAT(said(top + reference + scene + marcher + plot + named("p q") + plot + named("p_q")),
             Contains("the file 'p_q.one' of plot 'p_q' is that of plot 'p q', too"));
  // Apart by scene, by profile, or by a letter.
  CHECK(said(top + reference + scene + named("s1") + scene + named("s2") + marcher + "scenes = [\"s1\"]\n" + marcher +
             "scenes = [\"s2\"]\n") == "");
  CHECK(said(top + reference + scene + marcher + marcher + "profiles = [\"paper\"]\n") == "");
  CHECK(said(top + reference + scene + marcher + named("A b") + marcher + named("A-b")) == "");
}

// Pictures stay in the project's folder even for names that a folder cannot have.
TEST_CASE("a scene named like the folder above stays below its experiment", "[driver][experiment]") {
  const TemporaryFolder elsewhere;
  for (const std::string& name : std::vector<std::string>{"..", ".", ".hidden", "../../../x", elsewhere.file("x")}) {
    CAPTURE(name);
    const SmallProject project(box_of_fog(8, 6), experiment_of(name, "t"));
    const Result result = run("experiment run g/e --root .", project);
    CAPTURE(result.err);
    CHECK(result.code == 0);
    int pictures = 0;
    for (const std::string& file : files_below(project.path()))
      if (file.ends_with(".exr") && file.find("/cache/") == std::string::npos) {
        CHECK_THAT(file, Catch::StartsWith("results/images/g/e/_"));
        ++pictures;
      }
    CHECK(pictures == 3);
  }
}

}  // namespace names_test
