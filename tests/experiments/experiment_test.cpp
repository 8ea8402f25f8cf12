#include "experiments/driver/experiment.h"

#include <catch2/catch.hpp>

#include "scene/base/error.h"
#include "tests/temporary_folder.h"
#include "tests/texts.h"

namespace experiment_test {

using namespace airlight::experiments;
using airlight::TemporaryFolder;
using airlight::test::replaced;
using Catch::Contains;

namespace {

const std::string good = R"(title = "t"
layer = "airlight"
metrics = ["rel_l2", "bias"]
[[scene]]
file = "scenes/one.toml"
overrides = { "film.width" = 8, camera = { vertical_fov = 0.5 } }
sweep = { key = "medium.0.sigma_t", values = [0.5, 2] }
[reference]
renderer = "deterministic"
[[method]]
name = "marcher"
renderer = "ray_marcher"
sweep = { key = "steps", values = [8, 16, 32] }
[profile.quick]
overrides = { "film.height" = 6 }
runs = 3
[[plot]]
x = "setting"
y = "rel_l2"
[[gate]]
scene = "one"
method = "marcher"
setting = 32
metric = "rel_l2"
at_most = 0.1
)";

std::string failure(const std::string& text, const std::string& profile = "quick") {
  const TemporaryFolder folder;
  folder.write("experiments/README.md", "");
  folder.write("experiments/g/e.toml", text);
  return airlight::test::message_of([&] { read_experiment(folder.path(), "g/e", profile); }, "no failure");
}

}  // namespace

TEST_CASE("an experiment file becomes scenes, methods, plots and gates", "[experiment]") {
  const TemporaryFolder folder;
  folder.write("experiments/README.md", "");
  folder.write("experiments/g/e.toml", good);
  folder.write("experiments/scenes/not_an_experiment.toml", "");
  folder.write("experiments/scenes/more/neither.toml", "");
  const Experiment e = read_experiment(folder.path(), "g/e", "quick");
  REQUIRE(e.scenes.size() == 2);
  CHECK(e.scenes[0].name == "one 0.5");
  CHECK(e.scenes[1].parameter.value() == 2);
  CHECK(e.scenes[1].overrides ==
        Pairs{{"film.width", "8"}, {"film.height", "6"}, {"camera.vertical_fov", "0.5"}, {"medium.0.sigma_t", "2"}});
  REQUIRE(e.methods.size() == 3);
  CHECK(e.methods[2].setting == "32");
  CHECK(e.methods[2].settings == Pairs{{"steps", "32"}});
  CHECK(e.timing.runs == 3);
  // A method on a swept scene is on all of its values.
  MethodCase on_one;
  on_one.scenes = {"one"};
  CHECK(is_on(on_one, e.scenes[1]));
  on_one.scenes = {"one 0.5"};
  CHECK(is_on(on_one, e.scenes[0]));
  CHECK_FALSE(is_on(on_one, e.scenes[1]));
  CHECK(e.gates.at(0).setting == "32");
  CHECK(e.plots.at(0).name == "rel_l2_against_setting");
  CHECK(read_experiment(folder.path(), "g/e", "paper").timing.runs == 31);
  CHECK(read_experiment(folder.path(), "g/e", "paper").scenes[0].overrides.count("film.height") == 0);
  CHECK(experiment_ids(folder.path()) == std::vector<std::string>{"g/e"});
  CHECK(choose_experiments(folder.path(), {"g"}) == std::vector<std::string>{"g/e"});
  CHECK_THROWS_WITH(choose_experiments(folder.path(), {"g/f"}), Contains("nearest: g/e"));
}

TEST_CASE("a summary and what it quotes are checked", "[experiment]") {
  const std::string entry = "[[expected]]\nwhat = \"w\"\npaper = \"p\"\n";
  const std::string figure = "scene = \"one 2\"\nmethod = \"marcher\"\nmetric = \"rel_l2\"\n";
  const auto with = [&](const std::string& summary, const std::string& of_entry) {
    return "summary = \"" + summary + "\"\n" + good + entry + of_entry;
  };
  CHECK(failure(with("errs by {1}", figure)) == "no failure");
  CHECK(failure(with("errs by {1}", figure + "unit = \"percent\"\n")) == "no failure");
  CHECK_THAT(failure(with("errs by {2}", figure)),
             Contains("e.toml:1:11: ") && Contains("{2}") && Contains("there are 1"));
  CHECK_THAT(failure(with("errs by {0}", figure)), Contains("e.toml:1:11: ") && Contains("{0}"));
  CHECK_THAT(failure(with("errs by {1", figure)), Contains("e.toml:1:11: ") && Contains("without '}'"));
  CHECK_THAT(failure(with("errs by {1}", "")), Contains("e.toml:1:11: ") && Contains("no method"));
  CHECK_THAT(failure(with("a\\nb", figure)), Contains("e.toml:1:11: ") && Contains("one line"));
  CHECK_THAT(failure(with("", figure + "unit = \"ms\"\n")), Contains("unit = \"ms\"") && Contains("rel_l2"));
  CHECK_THAT(failure(with("", figure + "unit = \"furlongs\"\n")), Contains("furlongs") && Contains("\"percent\""));
  // A speed-up must be one of those that the table has.
  const std::string over = figure + "baseline = \"other\"\n",
                    other = "[[method]]\nname = \"other\"\nrenderer = \"ray_marcher\"\n",
                    speed_up = "[[speed_up]]\nbaseline = \"other\"\nmethod = \"marcher\"\nmetric = \"rel_l2\"\n";
  CHECK_THAT(failure(with("{1}", over)), Contains("baseline = \"other\""));
  CHECK_THAT(failure(with("{1}", over + other)), Contains("there is no [[speed_up]]"));
  CHECK(failure(with("{1}", over + other + speed_up)) == "no failure");
  CHECK_THAT(failure(with("{1}", over + "setting = 8\n" + other + speed_up)), Contains("no effect beside baseline"));
}

// By the edit distance alone g/rate would be nearer.
TEST_CASE("of the names that may be meant one that begins with the word comes first", "[experiment]") {
  const TemporaryFolder folder;
  for (const char* name : {"fig4_smooth", "fig5_teapots", "rate"})
    folder.write(std::string("experiments/g/") + name + ".toml", "");
  CHECK_THROWS_WITH(choose_experiments(folder.path(), {"g/fig4"}), Contains("(nearest: g/fig4_smooth)"));
  CHECK_THROWS_WITH(choose_experiments(folder.path(), {"g/fig4_smoth"}), Contains("(nearest: g/fig4_smooth)"));
  CHECK_THROWS_WITH(choose_experiments(folder.path(), {"g/rat"}), Contains("(nearest: g/rate)"));
}

TEST_CASE("overrides go along with the values of a sweep", "[experiment]") {
  const std::string swept = "values = [0.5, 2]";
  const std::string along = ", with = { \"film.width\" = [4, 5], \"camera.position\" = [[0, 1, 2], [3, 4, 5]] }";
  const TemporaryFolder folder;
  folder.write("experiments/README.md", "");
  folder.write("experiments/g/e.toml", replaced(good, swept, swept + along));
  const Experiment e = read_experiment(folder.path(), "g/e", "quick");
  REQUIRE(e.scenes.size() == 2);
  CHECK(e.scenes[0].overrides.at("film.width") == "4");
  CHECK(e.scenes[1].overrides.at("film.width") == "5");
  CHECK(e.scenes[1].overrides.at("film.height") == "6");
  CHECK(e.scenes[1].overrides.at("medium.0.sigma_t") == "2");
  CHECK_THAT(e.scenes[0].overrides.at("camera.position"), Contains("0, 1, 2"));
  CHECK_THAT(e.scenes[1].overrides.at("camera.position"), Contains("3, 4, 5"));
  CHECK_THAT(failure(replaced(good, swept, swept + ", with = { \"film.width\" = [4] }")),
             Contains("e.toml:7:") && Contains("film.width") && Contains("a list of 2 values"));
  CHECK_THAT(failure(replaced(good, swept, swept + ", with = 3")), Contains("e.toml:7:"));
}

TEST_CASE("mistakes in an experiment file are one line with position and nearest name", "[experiment]") {
  CHECK_THAT(failure(good), Contains("no failure"));
  CHECK_THAT(failure("title = "), Contains("e.toml:1:"));
  CHECK_THAT(failure(replaced(good, "layer", "layr")), Contains("e.toml:2:1") && Contains("layr") && Contains("layer"));
  CHECK_THAT(failure(replaced(good, "\"bias\"", "\"biass\"")), Contains("e.toml:3:") && Contains("nearest: bias"));
  CHECK_THAT(failure(replaced(good, "metrics = [\"rel_l2\", \"bias\"]", "metrics = 3")),
             Contains("e.toml:3:11") && Contains("a list of strings"));
  CHECK_THAT(failure(replaced(good, "ray_marcher", "raymarcher")),
             Contains("e.toml:12:") && Contains("nearest: ray_marcher"));
  CHECK_THAT(failure(replaced(good, "\"steps\"", "\"stepz\"")), Contains("e.toml") && Contains("nearest: step"));
  CHECK_THAT(failure(replaced(good, "[8, 16, 32]", "[8, \"many\"]")), Contains("many"));
  CHECK_THAT(failure(replaced(good, "scene = \"one\"", "scene = \"on\"")), Contains("nearest: one"));
  CHECK_THAT(failure(replaced(good, "method = \"marcher\"", "method = \"marchr\"")), Contains("nearest: marcher"));
  CHECK_THAT(failure(replaced(good, "y = \"rel_l2\"", "y = \"rel_l3\"")), Contains("e.toml") && Contains("rel_l3"));
  CHECK_THAT(failure(replaced(good, "at_most = 0.1", "at_most = 0.1\nat_least = 0")), Contains("found both 'at_most'"));
  CHECK_THAT(failure(replaced(good, "at_most = 0.1", "at_most = 0.0")), Contains("no failure"));
  // A gate must have a row and a figure.
  CHECK_THAT(failure(replaced(good, "setting = 32", "setting = 33")),
             Contains("e.toml:20:1") && Contains("no row of method 'marcher' with setting 33 on scene 'one'"));
  CHECK_THAT(failure(replaced(good, "name = \"marcher\"", "name = \"marcher\"\nprofiles = [\"paper\"]")),
             Contains("e.toml:21:1") && Contains("no row of method 'marcher'") && Contains("in profile quick"));
  CHECK_THAT(failure(replaced(good, "name = \"marcher\"", "name = \"marcher\"\nprofiles = [\"paper\"]"), "paper"),
             Contains("no failure"));
  CHECK_THAT(failure(replaced(good, "name = \"marcher\"", "name = \"marcher\"\npicture_only = true")),
             Contains("e.toml:21:1") && Contains("picture_only: it has no rel_l2"));
  const std::string objections = replaced(replaced(good, "\"bias\"", "\"objections\", \"wrong\""),
                                          "metric = \"rel_l2\"", "metric = \"objections\"");
  CHECK_THAT(failure(objections), Contains("e.toml:20:1") && Contains("objections needs noise"));
  CHECK_THAT(failure(replaced(objections, "deterministic", "path_tracer")), Contains("no failure"));
  CHECK_THAT(failure(replaced(replaced(objections, "deterministic", "path_tracer"), "metric = \"objections\"",
                              "metric = \"wrong\"")),
             Contains("wrong is not defined against a noisy reference"));
  CHECK_THAT(failure(replaced(good, "metric = \"rel_l2\"", "metric = \"counter.steps\"")), Contains("no failure"));
  CHECK_THAT(failure(replaced(good, "name = \"marcher\"", "name = \"marcher\"\nscenes = [\"on\"]")),
             Contains("e.toml:12:10") && Contains("nearest: one"));
  CHECK_THAT(failure(replaced(good, "y = \"rel_l2\"", "y = \"rel_l2\"\nmethods = [\"marchr\"]")),
             Contains("e.toml:20:") && Contains("nearest: marcher"));
  CHECK_THAT(failure(replaced(good, "[[scene]]", "[scene]")), Contains("[[scene]]"));
  CHECK_THAT(failure(replaced(good, "runs = 3", "runs = 0")), Contains("runs = 0"));
  CHECK_THAT(failure(replaced(good, "runs = 3", "runs = 3\nbudget = 0")),
             Contains("e.toml:16:") && Contains("no effect"));
  CHECK_THAT(failure(replaced(good, "[reference]\nrenderer = \"deterministic\"", "")), Contains("no [reference]"));
}

TEST_CASE("a claim of a paper needs a verdict from the list and what makes it true", "[experiment]") {
  const std::string claim =
      good + "[[claim]]\nwhere = \"Figure 4\"\nclaim = \"matches\"\npublished = \"{one|marcher; %}\"\n";
  const std::string holds = "holds = \"[one|marcher] > 0.1\"\n";
  CHECK_THAT(failure(claim + holds + "verdict = \"not reproduced\"\n"), Contains("no failure"));
  CHECK_THAT(failure(claim + holds + "verdict = \"holds only where it is thin: why\"\n"), Contains("no failure"));
  CHECK_THAT(failure(claim + "verdict = \"not comparable: no number\"\n"), Contains("no failure"));
  CHECK_THAT(failure(claim + "verdict = \"reproduced\"\n"), Contains("e.toml:26:1") && Contains("holds is missing"));
  CHECK_THAT(failure(claim + holds + "verdict = \"true\"\n"),
             Contains("e.toml:31:11") && Contains("expected reproduced, not reproduced"));
  CHECK_THAT(failure(claim + holds), Contains("e.toml:26:1") && Contains("verdict"));
  CHECK_THAT(failure(claim + "figure = 4\n"), Contains("e.toml:30:1") && Contains("figure"));
  CHECK_THAT(failure(claim + holds + "verdict = \"reproduced\"\ngroup = \"h\"\n"),
             Contains("e.toml:32:9") && Contains("a folder of experiments/"));
  const std::string erratum = good + "[[erratum]]\nwhere = \"Eq. 1\"\nprinted = \"1\"\nright = \"2\"\n";
  CHECK_THAT(failure(erratum + "proof = \"{one|marcher}\"\n"), Contains("no failure"));
  const std::string conclusion = good + "[conclusion]\ntext = \"It is right.\"\n";
  CHECK_THAT(failure(conclusion + holds), Contains("no failure"));
  CHECK_THAT(failure(conclusion), Contains("e.toml:26:1") && Contains("holds"));
  CHECK_THAT(failure(erratum), Contains("e.toml:26:1") && Contains("proof"));
}

TEST_CASE("bounds by row come before the gates of the file, and belong to one", "[experiment]") {
  const TemporaryFolder folder;
  folder.write("experiments/g/e.toml", good);
  const std::string header = "scene,method,setting,metric,device,measured,at_least,at_most\n";
  const auto gates = [&](const std::string& lines, const std::string& profile = "quick") {
    folder.write("experiments/g/e.bounds.csv", lines);
    return read_experiment(folder.path(), "g/e", profile).gates;
  };
  const auto read = gates(header + "one 0.5,marcher,32,rel_l2,\"a \"\"card\"\", 2\",0.05,0.04,0.075\n");
  REQUIRE(read.size() == 3);
  CHECK(read[0].by_row);
  CHECK(read[0].scene == "one 0.5");
  CHECK(read[0].device == "a \"card\", 2");
  CHECK(read[0].at_most == 0.075);
  CHECK(read[0].why == "measured 0.05");
  CHECK(read[1].at_least == 0.04);
  CHECK(read[2].at_most == 0.1);
  CHECK(gates(header + "one 0.5,marcher,32,rel_l2,,0.05,,0.075\n", "paper").size() == 1);
  CHECK_THROWS_WITH(gates("scene\n"), Contains("e.bounds.csv:1: 'scene', expected scene,method"));
  CHECK_THROWS_WITH(gates(header + "one 0.5,marcher,32,rel_l2,0.1\n"), Contains("e.bounds.csv:2: 5 fields"));
  CHECK_THROWS_WITH(gates(header + "one 0.5,marcher,32,rel_l2,,0.05,,much\n"), Contains("'much', expected a number"));
  CHECK_THROWS_WITH(gates(header + "one 0.5,marcher,32,rel_l2,,0.05,,\n"), Contains("neither at_least nor at_most"));
  CHECK_THROWS_WITH(gates(header + "\"one 0.5,marcher,32,rel_l2,,0.05,,1\n"), Contains("a quote is not closed"));
  CHECK_THROWS_WITH(gates(header + "one 0.5,marcher,16,rel_l2,,0.05,,1\n"),
                    Contains("e.bounds.csv:2: no [[gate]] covers one 0.5, marcher 16: rel_l2"));
}

}  // namespace experiment_test
