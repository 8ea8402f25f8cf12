// Parts of `airlight choose`: pixels of a film, candidates, ranking, verdicts, variations; and
// experiments of kind "choices".
#include <catch2/catch.hpp>
#include <set>

#include "experiments/application/renderers.h"
#include "experiments/choosing/ranking.h"
#include "experiments/choosing/variations.h"
#include "experiments/choosing/verdict.h"
#include "experiments/driver/left_out.h"
#include "experiments/driver/run.h"
#include "tests/experiments/small_project.h"
#include "tests/texts.h"

namespace choosing_test {

using namespace airlight;
using namespace airlight::experiments;
using airlight::test::SmallProject;
using Catch::Contains;

namespace {

const std::string rows = R"(title = "Rows"
metrics = ["rel_l2"]
[reference]
renderer = "path_tracer"
settings = { samples = 64 }
[[scene]]
file = "scenes/one.toml"
[[method]]
name = "marched"
renderer = "ray_marcher"
sweep = { key = "steps", values = [4, 32] }
scenes = ["one"]
[[method]]
name = "again"
renderer = "ray_marcher"
settings = { steps = 32 }
[[method]]
name = "converted"
renderer = "fogshop"
convert = { to = "gaussians", count = 20, cut = false }
[[method]]
name = "closed form"
renderer = "shadow_planes"
)";

std::vector<Candidate> small_candidates() {
  const SmallProject project(test::box_of_fog(8, 8), rows);
  return candidates_of(read_experiment(project.path(), "g/e", "quick"));
}

Trial trial(const Candidate& c, double error, double width, double seconds) {
  Trial t;
  t.candidate = &c;
  t.error = {"rel_l2", error, error - width, error + width, 0, false};
  t.times = t.screened = {{{seconds, 0.95 * seconds, 1.05 * seconds}, false}};
  t.of_film = true;
  return t;
}

}  // namespace

TEST_CASE("choosing: pixels of a small film are pixels of the whole one", "[choosing]") {
  for (const auto& [width, height, small] :
       {std::tuple(160, 120, 64), {320, 240, 64}, {333, 251, 64}, {64, 48, 64}, {9, 5, 2}, {1, 1, 1}}) {
    scene::View whole{scene::look_at({1, 2, 5}, {0, 0, 0}, Vec3::UnitY()), width, height};
    whole.camera.vertical_fov = 0.6;
    const SparseView sparse = sparse_view(whole, small);
    CAPTURE(width, height, sparse.stride, sparse.small.width, sparse.small.height);
    CHECK(sparse.stride % 2 == 1);
    CHECK(sparse.small.width >= 1);
    for (const auto& [x, y] : {std::pair(0, 0), {sparse.small.width - 1, sparse.small.height - 1}}) {
      const int i = sparse.left + sparse.stride * x, j = sparse.top + sparse.stride * y;
      REQUIRE((i >= 0 && i < width && j >= 0 && j < height));
      const Ray a = camera_ray(sparse.small.camera, x + 0.5, y + 0.5, sparse.small.width, sparse.small.height);
      const Ray b = camera_ray(whole.camera, i + 0.5, j + 0.5, width, height);
      CHECK((a.direction - b.direction).norm() < 1e-14);
    }
    scene::Film film(width, height);
    film.add("mean");
    film.set("mean", sparse.left, sparse.top + sparse.stride * (sparse.small.height - 1), Rgb(1, 2, 3));
    CHECK((pick(film, sparse).get("mean", 0, sparse.small.height - 1) == Rgb(1, 2, 3)).all());
  }
}

TEST_CASE("choosing: a time on a larger film has a part that knows no film", "[choosing]") {
  // 1 ms and 1 us a pixel.
  const Estimate small{0.002, 0.002, 0.002}, smaller{0.00125, 0.00125, 0.00125};
  CHECK(extrapolated(small, 1000, smaller, 250, 20000).value == Approx(0.021).epsilon(1e-12));
  // At least as long as on the small film, and at most in proportion.
  CHECK(extrapolated(small, 1000, {0.003, 0.003, 0.003}, 250, 20000).value == Approx(0.002).epsilon(1e-12));
  CHECK(extrapolated(small, 1000, {0.0001, 0.0001, 0.0001}, 250, 20000).value == Approx(0.04).epsilon(1e-12));
  const Estimate wide = extrapolated({0.002, 0.0018, 0.0022}, 1000, {0.00125, 0.001, 0.0015}, 250, 20000);
  CHECK(wide.low < wide.value);
  CHECK(wide.value < wide.high);
}

TEST_CASE("choosing: candidates are the rows of an experiment, each once", "[choosing]") {
  const std::vector<Candidate> all = small_candidates();
  std::vector<std::string> names;
  for (const Candidate& c : all) names.push_back(c.name);
  CHECK(names == std::vector<std::string>{"marched (steps 4)", "marched (steps 32)", "converted", "closed form"});
  CHECK(command_line(all[0], "a.toml", {{"film.width", "8"}}, 2) ==
        "airlight render a.toml -m ray_marcher --set steps=4 --override film.width=8 --threads 2 -o picture.exr");
  CHECK(command_line(all[2], "my scene's.toml", {}) ==
        "airlight render 'my scene'\\''s.toml' -m fogshop --convert to=gaussians,count=20,cut=false -o picture.exr");
  const SmallProject numbers(test::box_of_fog(8, 8), "kind = \"flow\"\ntitle = \"f\"\nmetrics = [\"mass\"]\n");
  CHECK_THROWS_AS(candidates_of(read_experiment(numbers.path(), "g/e", "quick")), Error);
}

TEST_CASE("choosing: what is left out", "[choosing]") {
  CHECK(left_out({{"scattering", true, "light scattered once"}}) == "orders of scattering above one");
  CHECK(left_out({{"multiple scattering", true, "4 bands"}}).empty());
  CHECK(left_out({{"multiple scattering", false, "not asked for"},
                  {"light_maps", false, "self_shadow = none: media do not dim light"}}) ==
        "orders of scattering above one, the shadow of media on themselves");
  const SmallProject project(test::box_of_fog(8, 8), "");
  const auto fog =
      std::make_shared<const scene::Scene>(scene::load_scene(project.path() / "experiments/scenes/one.toml"));
  const scene::Renderer& tracer = find_renderer("path_tracer", "");
  const auto stages = [&](const Pairs& settings) {
    return tracer.prepare(fog, scene::Settings(tracer.settings(), settings, ""), {})->stages();
  };
  CHECK(left_out(stages({})).empty());
  CHECK(left_out(stages({{"max_events", "1"}})) == "orders of scattering above one");
}

TEST_CASE("choosing: ranked by error within a time, by time within an error", "[choosing]") {
  const std::vector<Candidate> c = small_candidates();
  std::vector<Trial> trials{trial(c[0], 0.2, 0.01, 0.001), trial(c[1], 0.05, 0.01, 0.010),
                            trial(c[2], 0.02, 0.005, 0.1), Trial()};
  trials[3].candidate = &c[3];
  trials[3].refused = "medium 0 is gaussians";
  Truth truth;
  truth.samples = 256;
  const Ranking in_time = rank(trials, {0.016, {}});
  REQUIRE(in_time.fit.size() == 2);
  CHECK(in_time.fit[0]->candidate == &c[1]);
  REQUIRE(in_time.beyond.size() == 1);
  CHECK(worth_more(in_time, {0.016, {}}) == in_time.beyond);
  CHECK_THAT(doubts(in_time, {0.016, {}}, truth).front(), Contains("clear"));
  CHECK_THAT(doubts(rank(trials, {0.011, {}}), {0.011, {}}, truth).front(), Contains("within 20 %"));
  CHECK_THAT(doubts(rank(trials, {1e-4, {}}), {1e-4, {}}, truth).front(), Contains("Nothing"));
  const Ranking in_error = rank(trials, {{}, 0.07});
  REQUIRE(in_error.fit.size() == 2);
  CHECK(in_error.fit[0]->candidate == &c[1]);
  CHECK_THAT(doubts(rank(trials, {{}, 0.05}), {{}, 0.05}, truth).front(), Contains("small enough"));  // 4 to 6 %
  trials[0].error = {"rel_l2", 0.04, 0, 0.12, 0.1, true};
  const Ranking hidden = rank(trials, {0.016, {}});
  CHECK(hidden.fit[0]->candidate == &c[1]);  // the other may err by 6 % as well as by nothing
  CHECK_THAT(doubts(hidden, {0.016, {}}, truth).front(), Contains("the same within"));
  CHECK(refusals(trials) == std::vector<std::string>{"shadow_planes: medium 0 is gaussians"});
  CHECK(error_text(trials[0].error) == "below noise, < 12 %");
  CHECK(error_text(trials[1].error) == "5.0 % (4.0 to 6.0)");
}

TEST_CASE("choosing: a choice is good if it is near the best, as far as intervals and times tell", "[choosing]") {
  const std::vector<Candidate> c = small_candidates();
  std::vector<Trial> judged{trial(c[0], 0.2, 0.01, 0.001), trial(c[1], 0.1, 0.001, 0.010),
                            trial(c[2], 0.02, 0.001, 0.1)};
  CHECK(judge_choice(&judged[1], judged, 0.016, 0).hit);
  const Verdict far = judge_choice(&judged[0], judged, 0.016, 0);
  CHECK_FALSE(far.hit);
  CHECK(far.ratio == Approx(0.19 / 0.101));
  CHECK_THAT(far.why, Contains("marched (steps 4)") && Contains("best: marched (steps 32)"));
  CHECK_FALSE(judge_choice(&judged[2], judged, 0.016, 0).hit);  // much too slow
  CHECK_FALSE(judge_choice(nullptr, judged, 0.016, 0).hit);
  CHECK(judge_choice(nullptr, judged, 1e-4, 0).hit);  // nothing fits
  // A difference in time that another timing may reverse decides nothing.
  judged[1].times[0].seconds = {0.0155, 0.015, 0.016};
  CHECK(judge_choice(&judged[0], judged, 0.016, 0).hit);
  CHECK(judge_choice(&judged[1], judged, 0.015, 0).hit);
  std::vector<Trial> slower = judged;
  for (Trial& t : slower) t.times[0].seconds = {10, 9, 11};
  slower[2].times[0].at_least = true;
  keep_lower_times(slower, judged);
  CHECK(slower[0].times[0].seconds.value == 0.001);
  CHECK_FALSE(slower[2].times[0].at_least);
  std::vector<Trial> extrapolated = judged;
  extrapolated[0].of_film = false;
  extrapolated[0].times[0].seconds = {1e-6, 1e-6, 1e-6};
  keep_lower_times(slower, extrapolated);
  CHECK(slower[0].times[0].seconds.value == 0.001);
  judged[0].error = {"rel_l2", 0.2, 0.1, 0.3, 0, false};
  judged[1].times[0].seconds = {0.010, 0.009, 0.011};
  CHECK(judge_choice(&judged[0], judged, 0.016, 0).hit);
}

TEST_CASE("choosing: variations are scenes of their own, and always the same", "[choosing]") {
  for (const char* const light :
       {"type = \"point\"\nposition = [1, 2, 1]\nintensity = 1\n",
        "type = \"directional\"\nto_light = [1, 1, 1]\nirradiance = 1\n",
        "type = \"environment\"\nsh = [[1, 1, 1], [0.1, 0.1, 0.1], [0.2, 0.2, 0.2], [0.3, 0.3, 0.3]]\n"}) {
    const scene::Scene scene = scene::parse_scene(
        "[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n[[medium]]\ntype = \"homogeneous\"\nsigma_t = 1\nalbedo = [0.9, 0.5, "
        "0.1]\nregion = { type = \"box\", lo = [-1, -1, -1], hi = [1, 1, 1] }\n[[light]]\n" +
            std::string(light),
        "varied", ".");
    CAPTURE(light);
    CHECK(varied(scene, 0)->hash == scene.hash);
    std::set<std::string> hashes{scene.hash}, lights{scene.light_hash}, matters{scene.matter_hash};
    for (int v = 1; v <= 20; ++v) {
      const auto changed = varied(scene, v);
      CHECK(varied(scene, v)->hash == changed->hash);
      hashes.insert(changed->hash);
      lights.insert(changed->light_hash);
      matters.insert(changed->matter_hash);
      const scene::Medium& medium = changed->media[0];
      CHECK((medium.sigma_t >= 0.4).all());
      CHECK((medium.sigma_t <= 2.5).all());
      CHECK((medium.albedo >= 0).all());
      CHECK((medium.albedo < 1).all());
    }
    CHECK(hashes.size() == 21);
    CHECK(lights.size() == 21);
    CHECK(matters.size() == 21);
  }
}

TEST_CASE("choices: rows of scenes, a row of all of them, and a gate on that", "[choosing]") {
  SmallProject project(test::box_of_fog(24, 18), R"(kind = "choices"
title = "Choices"
metrics = ["cases", "hits", "hit_rate", "worst_ratio"]
[[scene]]
name = "a box"
file = "scenes/one.toml"
[[method]]
name = "within a second"
question = "first_choice"
settings = { budget = 1, moves = "camera", variations = 1, samples = 64 }
[[method]]
name = "at once"
question = "first_choice"
settings = { budget = 1e-6, moves = "lights", variations = 0, samples = 64 }
[[gate]]
scene = "all scenes"
metric = "hit_rate"
at_least = 0.5
)");
  project.write("experiments/common/all_orders.toml", rows);
  const auto run = [&](bool resume) {
    return run_experiment(read_experiment(project.path(), "g/e", "quick"), {project.path(), resume, 1, false});
  };
  const Outcome outcome = run(false);
  REQUIRE(outcome.rows.size() == 3);
  const auto figure = [](const Row& row, const char* name) { return quantity(row, name).value().value; };
  CHECK(figure(outcome.rows[0], "cases") == 2);
  CHECK(figure(outcome.rows[1], "cases") == 1);
  CHECK(figure(outcome.rows[1], "hits") == 1);  // nothing renders in a microsecond, and nothing was chosen
  CHECK(outcome.rows[2].scene == "all scenes");
  CHECK(figure(outcome.rows[2], "cases") == 3);
  CHECK(figure(outcome.rows[2], "hits") == figure(outcome.rows[0], "hits") + 1);
  REQUIRE(outcome.gates.size() == 1);
  CHECK(outcome.gates[0].passed);
  const Outcome kept = run(true);
  CHECK(figure(kept.rows[2], "hits") == figure(outcome.rows[2], "hits"));
  SmallProject wrong(test::box_of_fog(8, 8),
                     "kind = \"choices\"\ntitle = \"c\"\nmetrics = [\"hit_rat\"]\n[[scene]]\nfile = "
                     "\"scenes/one.toml\"\n[[method]]\nquestion = \"first_choice\"\n");
  CHECK_THROWS_WITH(read_experiment(wrong.path(), "g/e", "quick"), Contains("nearest: hit_rate"));
}

}  // namespace choosing_test
