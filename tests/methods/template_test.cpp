// The method that README.md tells people to copy, and its experiment.
#include "methods/template/template.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/application/renderers.h"
#include "experiments/driver/run.h"
#include "scene/base/read_file.h"
#include "tests/experiments/small_project.h"

namespace template_test {

using namespace airlight;
using namespace airlight::experiments;

namespace {

const std::string root = AIRLIGHT_SOURCE_DIR;

double error(const Row& row) { return quantity(row, "rel_l2").value().value; }

}  // namespace

TEST_CASE("template: its experiment runs, and the error falls with the square of the step", "[template]") {
  const AddedRenderer added(template_method::make_renderer());
  const test::SmallProject project("", scene::read_whole_file(root + "/methods/template/experiment.toml"));
  for (const std::string file : {"experiments/scenes/fogshop/f100.toml", "experiments/scenes/fogshop/cloud_100.csv"})
    project.write(file, scene::read_whole_file(root + "/" + file));
  const Outcome outcome =
      run_experiment(read_experiment(project.path(), "g/e", "quick"), {project.path(), false, 0, false});
  REQUIRE(outcome.rows.size() == 8);
  CHECK(outcome.gates.at(0).passed);
  CHECK(error(outcome.rows[3]) < error(outcome.rows[1]) / 10);
}

TEST_CASE("template: it refuses what it cannot do, and is gone afterwards", "[template]") {
  {
    const AddedRenderer added(template_method::make_renderer());
    const scene::Renderer& renderer = find_renderer("template", "test");
    const scene::Settings settings(renderer.settings(), {}, "");
    const auto reasons = [&](const std::string& file) {
      return renderer.supports(scene::load_scene(root + "/experiments/scenes/common/" + file), settings);
    };
    CHECK(reasons("plume_sun.toml").empty());
    CHECK(reasons("lamp_and_boxes.toml").size() == 1);
    CHECK(reasons("plume_sky.toml").size() == 1);
  }
  CHECK_THROWS_AS(find_renderer("template", "test"), Error);
}

}  // namespace template_test
