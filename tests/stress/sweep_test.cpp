// The table of the extreme scenes: every quantity over all powers of ten, every renderer right or refusing by name.
#include "tests/stress/sweep.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "experiments/application/renderers.h"
#include "scene/base/atomic_file.h"

namespace sweep_test {

using namespace airlight;
using namespace airlight::stress;

namespace {

std::string row(const SweepCase& c, const std::string& renderer, const Tally& t) {
  if (!t.available)
    return fmt::format("| {} | {} | {} | not: {} | | | | | |\n", c.quantity, c.scene, renderer,
                       t.details.empty() ? "no such layer" : t.details[0]);
  return fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", c.quantity, c.scene, renderer, t.right,
                     t.warned, t.at_loading, t.by_name, t.wrong, t.error < 0 ? "" : fmt::format("{:.2g}", t.error));
}

// Variants where they differ.
std::vector<std::string> with_variants(const SweepCase& c, const std::vector<std::string>& renderers) {
  std::vector<std::string> specs;
  for (const std::string& name : renderers) {
    if (name.starts_with("compensated_ray_marching")) {
      specs.push_back(name + " cells=12");
      specs.push_back(name + " cells=12 multiple=none");
      if (c.scene == "sky" || c.scene == "harmonics") specs.push_back(name + " variant=paper multiple=none");
      continue;
    }
    // Films of 3 x 3 pixels: froxels of one, every pixel marched.
    specs.push_back(name == "wavelet_fog"                       ? name + " sun=true"
                    : name.starts_with("froxel_fog")            ? name + " tile=1 slices=256 map_size=64"
                    : name.starts_with("half_resolution_march") ? name + " divide=1 jitter=none steps=256 map_size=64"
                                                                : name);
    if (!name.starts_with("fogshop") || name.find(' ') != std::string::npos) continue;
    if (c.scene == "sky" || c.scene == "harmonics") specs.push_back(name + " environment_airlight=volume");
    if (c.scene == "fog" || c.scene == "smoke" || c.scene == "gaussian") specs.push_back(name + " variant=paper");
  }
  return specs;
}

void run(int step, const std::vector<std::string>& renderers, const char* file) {
  std::string table =
      "| quantity | scene | renderer | right | with a warning | refused at loading | refused by name | wrong | error "
      "|\n|---|---|---|---|---|---|---|---|---|\n";
  for (const SweepCase& c : sweep_cases())
    for (const auto& [renderer, tally] : sweep(c, sweep_values(step), with_variants(c, renderers))) {
      table += row(c, renderer, tally);
      std::string details;
      for (const std::string& d : tally.details) details += d + "\n";
      CAPTURE(c.quantity, c.scene, renderer, details);
      CHECK(tally.wrong == 0);
    }
  if (file) scene::write_file_atomically(file, table);
}

}  // namespace

TEST_CASE("stress: a sweep of every quantity, every renderer on the processor", "[stress][sweep][slow][thorough]") {
  run(11,
      {"deterministic", "path_tracer", "ray_marcher", "froxel_fog", "half_resolution_march", "fogshop", "shadow_planes",
       "compensated_ray_marching", "wavelet_fog", "legendre_fluids"},
      nullptr);
}

// On demand: AIRLIGHT_SWEEP names the file of the table, a list of renderers in AIRLIGHT_SWEEP_OF replaces all.
TEST_CASE("stress: the whole sweep", "[.][whole_sweep]") {
  std::vector<std::string> renderers = experiments::renderer_names();
  if (const char* one = std::getenv("AIRLIGHT_SWEEP_OF")) renderers = {one};
  const char* step = std::getenv("AIRLIGHT_SWEEP_STEP");
  run(step ? std::atoi(step) : 3, renderers, std::getenv("AIRLIGHT_SWEEP"));
}

}  // namespace sweep_test
