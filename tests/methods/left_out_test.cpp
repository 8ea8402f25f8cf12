// Stages that methods leave out of a scene, by tests/methods/left_out.csv: a line for each method and property of a
// scene. `base` names the stages that `explain` calls left out. The other properties name the stages that they leave
// out too, or compute (+) where base does not, and the counters that are 0 then and are not in base. Stages that are
// left out take no time.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <set>
#include <sstream>

#include "experiments/application/renderers.h"
#include "scene/convert/residual.h"
#include "scene/geometry/shapes.h"
#include "scene/media/fitted.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "tests/gpu/device.h"
#include "tests/methods/compensated_ray_marching/puffs.h"
#include "tests/methods/legendre_fluids/light_scenes.h"

namespace left_out_test {

using namespace airlight;
using test::Given;

namespace {

const char* const table_file = AIRLIGHT_SOURCE_DIR "/tests/methods/left_out.csv";

// One line of the table.
struct Line {
  std::string method, settings, property, stages, zero;
};

std::vector<Line> read_table() {
  std::ifstream file(table_file);
  REQUIRE(file);
  std::vector<Line> lines;
  std::string text;
  std::getline(file, text);
  REQUIRE(text == "method,settings,scene,stages left out,counters at 0");
  while (std::getline(file, text)) {
    std::vector<std::string> cells;
    std::istringstream stream(text);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    cells.resize(5);
    lines.push_back({cells[0], cells[1], cells[2], cells[3], cells[4]});
  }
  return lines;
}

Given settings_of(const std::string& text) {
  Given given;
  std::istringstream stream(text);
  for (std::string each; stream >> each;) {
    const auto equals = each.find('=');
    REQUIRE(equals != std::string::npos);
    given[each.substr(0, equals)] = each.substr(equals + 1);
  }
  return given;
}

const Rgb coloured(1, 0.7, 0.5);
const scene::PhaseFunction forward = scene::HenyeyGreenstein{0.3};

std::shared_ptr<scene::Scene> empty_scene() {
  auto scene = std::make_shared<scene::Scene>();
  scene->width = 8;
  scene->height = 6;
  scene->camera = scene::look_at({0, 0.2, 5}, {0, 0, 0}, Vec3::UnitY());
  scene->camera.vertical_fov = 0.7;
  return scene;
}

// A lamp above a medium in a box, a brick between both.
std::shared_ptr<scene::Scene> for_shadow_planes() {
  auto scene = empty_scene();
  scene::Medium& medium = scene->media.emplace_back();
  medium.region = Box{Point3::Constant(-1), Point3::Constant(1)};
  medium.sigma_t = coloured;
  medium.albedo = Rgb::Constant(0.8);
  medium.phase = forward;
  scene->lights = {scene::PointLight{{0.2, 3, 0.1}, Rgb::Ones(), 0}};
  scene->surfaces = {{"brick", scene::make_box({{-0.4, 1.5, -0.4}, {0.3, 1.7, 0.5}}), scene::Lambert{}}};
  return scene;
}

std::shared_ptr<scene::Scene> for_fogshop() {
  auto scene = for_shadow_planes();
  scene::Medium& medium = scene->media.front();
  medium.region = scene::Unbounded{};
  medium.phase = scene::Isotropic{};
  scene::GaussianSum sum = test::puffs();
  sum.cutoff = infinity;
  medium.field = sum;
  return scene;
}

std::shared_ptr<scene::Scene> for_wavelet_fog() {
  auto scene = test::scene_named("wavelet_fog/smooth", 8, 6);
  scene->ambient_in_scatter = Rgb::Zero();
  scene->media.front().sigma_t = 0.05 * coloured;
  scene->media.front().albedo = Rgb::Constant(0.8);
  scene->media.front().phase = forward;
  scene->lights = {scene::DirectionalLight{Vec3(0.3, 0.8, 0.2).normalized(), Rgb::Ones()}};
  scene->surfaces = {{"tower", scene::make_box({{-1, 0, -1}, {1, 4, 1}}), scene::Lambert{}}};
  return scene;
}

// Smoke before a sky and under a sun.
std::shared_ptr<scene::Scene> for_compensated(bool paper) {
  auto scene = test::in_white(test::puffs(), 2);
  scene->width = 8;
  scene->height = 6;
  scene->media.front().sigma_t = 2 * coloured;
  scene->media.front().phase = forward;
  if (!paper) scene->lights.emplace_back(scene::DirectionalLight{Vec3(0.3, 0.8, 0.2).normalized(), Rgb::Ones()});
  scene->surfaces = {{"ball", scene::Sphere{{0.2, 1.4, 0}, 0.3}, scene::Lambert{}}};
  return scene;
}

std::shared_ptr<scene::Scene> for_legendre(bool paper, bool on_device) {
  using namespace legendre_fluids::testing;
  auto scene = lit_scene(smoke(random_density({3, 3, 3}, 1), 1), oblique_light, oblique_view, 8, 6);
  scene->media.front().sigma_t = coloured;
  scene->media.front().phase = forward;
  // The device knows no shadows in Legendre boxes: there the ball stands behind the medium.
  const double side = on_device ? -1 : 1;
  if (!paper) scene->surfaces = {{"ball", scene::Sphere{side * 3 * oblique_light, 0.4}, scene::Lambert{}}};
  return scene;
}

std::shared_ptr<scene::Scene> scene_for(const std::string& method, bool paper) {
  if (method.starts_with("shadow_planes")) return for_shadow_planes();
  if (method.starts_with("fogshop")) return for_fogshop();
  if (method.starts_with("wavelet_fog")) return for_wavelet_fog();
  if (method.starts_with("compensated_ray_marching")) return for_compensated(paper);
  REQUIRE(method.starts_with("legendre_fluids"));
  return for_legendre(paper, method.ends_with("_gpu"));
}

void darken(scene::Light& light) {
  scene::match(
      light, [](scene::PointLight& point) { point.intensity = Rgb::Zero(); },
      [](scene::SpotLight& spot) { spot.intensity = Rgb::Zero(); },
      [](scene::DirectionalLight& sun) { sun.irradiance = Rgb::Zero(); },
      [](scene::EnvironmentLight& sky) { sky = scene::make_constant_environment(Rgb::Zero()); });
}

void change(scene::Scene& scene, const std::string& property) {
  if (property == "no light") scene.lights.clear();
  if (property == "dark light") std::for_each(scene.lights.begin(), scene.lights.end(), darken);
  if (property == "albedo 0") scene.media.front().albedo = Rgb::Zero();
  if (property == "no medium") scene.media.clear();
  if (property == "thin medium") scene.media.front().sigma_t *= 1e-7;
  if (property == "no medium in view") scene.camera.forward = -scene.camera.forward;
  if (property == "medium without end") {
    scene::Medium& air = scene.media.emplace_back();
    air.sigma_t = 0.01 * scene.media.front().sigma_t;
    air.albedo = scene.media.front().albedo;
    air.phase = scene.media.front().phase;
  }
  if (property == "grey") scene.media.front().sigma_t = Rgb::Constant(scene.media.front().sigma_t[0]);
  if (property == "isotropic") scene.media.front().phase = scene::Isotropic{};
  if (property == "no occluder") scene.surfaces.clear();
  if (property == "occluder out of reach")
    scene.surfaces = {{"far", scene::make_box({{30, 1, -1}, {32, 3, 1}}), scene::Lambert{}}};
  if (property == "one direction")
    scene.lights = {scene::DirectionalLight{Vec3(0.3, 0.8, 0.2).normalized(), Rgb::Ones()}};
  if (property == "residual" ||
      property == "residual 0") {  // of Gaussians that miss what is 1, or what they are themselves
    scene::VoxelGrid grid;
    grid.size = {4, 4, 4};
    grid.voxel_size = 0.3;
    grid.translation = Vec3::Constant(-0.45);
    for (int z = 0; z < 4; ++z)
      for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
          grid.values.push_back(
              property == "residual" ? 1 : float(density(test::puffs(), grid.translation + 0.3 * Vec3(x, y, z))));
    auto fitted = std::make_shared<scene::Fitted>();
    fitted->gaussians = test::puffs();
    fitted->residual = std::make_shared<const scene::Residual>(
        scene::residual_of(grid, fitted->gaussians, {0, property == "residual" ? 0.01 : 1}));
    fitted->grid = grid;
    scene.media.front().field = scene::FittedPointer(fitted);
  }
}

// Times that belong to a stage beside one of its own name.
const std::map<std::string, std::set<std::string>> also_of = {
    {"silhouettes", {"edges", "counts", "edges of rays"}},
    {"airlight", {"sun maps"}},
    {"airlight of Gaussians", {"light maps", "depths to centres", "sky volume"}},
    {"single scattering",
     {"nodes", "depths", "towards the camera", "passing light", "diffusion matrix", "multiple scattering"}},
    {"transmittance", {"polar tables"}},
    {"direct systems", {"scattered systems"}},
};

const std::set<std::string> without_airlight = {"no light", "dark light", "albedo 0", "no medium", "no medium in view"};

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : "; ") + name;
  return all;
}

struct Seen {
  std::vector<std::string> left_out, zero;  // stages and counters
};

Seen look_at(const Line& line) {
  const Given given = settings_of(line.settings);
  const bool paper = given.contains("variant") && given.at("variant") == "paper";
  const auto scene = scene_for(line.method, paper);
  change(*scene, line.property);
  finish(*scene);
  const scene::Renderer& renderer = experiments::find_renderer(line.method, table_file);
  const auto prepared = renderer.prepare(scene, {renderer.settings(), given}, {1, {}});
  const scene::Rendering picture = prepared->render(view_of(*scene), {1, {}});
  std::set<std::string> times;
  for (const auto& all : {prepared->prepare_times(), picture.times})
    for (const scene::StageTime& time : all) times.insert(time.name);
  Seen seen;
  for (const scene::Stage& stage : prepared->stages()) {
    CAPTURE(stage.name);
    CHECK(!stage.reason.empty());
    if (stage.kept) continue;
    seen.left_out.push_back(stage.name);
    CHECK(!times.contains(stage.name));
    if (const auto also = also_of.find(stage.name); also != also_of.end())
      for (const std::string& name : also->second) {
        CAPTURE(name);
        CHECK(!times.contains(name));
      }
  }
  for (const auto& [name, value] : picture.counters)
    if (value == 0) seen.zero.push_back(name);
  if (without_airlight.contains(line.property) && picture.film.layers.contains("airlight"))
    for (const float value : picture.film.layer("airlight")) CHECK(value == 0);
  return seen;
}

// The line as the program has it, beside what it has for `base`; null: this is base.
Line as_seen(Line line, const Seen& seen, const Seen* base) {
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::vector<std::string> stages, zero;
  for (const std::string& name : seen.left_out)
    if (!base || !has(base->left_out, name)) stages.push_back(name);
  for (std::size_t i = 0; base && i < base->left_out.size(); ++i)
    if (!has(seen.left_out, base->left_out[i])) stages.push_back("+" + base->left_out[i]);
  for (const std::string& name : seen.zero)
    if (base && !has(base->zero, name)) zero.push_back(name);
  line.stages = joined(stages);
  line.zero = joined(zero);
  return line;
}

template <class F>
int for_lines(bool on_device, const F& compare) {
  int lines = 0;
  Seen base;
  for (const Line& line : read_table()) {
    if (line.method.ends_with("_gpu") != on_device) continue;
    CAPTURE(line.method, line.settings, line.property);
    const Seen seen = look_at(line);
    const bool is_base = line.property == "base";
    if (is_base) base = seen;
    compare(line, as_seen(line, seen, is_base ? nullptr : &base));
    ++lines;
  }
  return lines;
}

void check_all(bool on_device) {
  const int lines = for_lines(on_device, [](const Line& expected, const Line& seen) {
    CHECK(seen.stages == expected.stages);
    CHECK(seen.zero == expected.zero);
  });
  CHECK(lines > 30);
}

}  // namespace

// Writes the table as the program has it; what it says is then to be judged.
TEST_CASE("table of what methods leave out", "[.left_out_table]") {
  std::printf("method,settings,scene,stages left out,counters at 0\n");
  for (const bool on_device : {false, true})
    for_lines(on_device, [](const Line&, const Line& l) {
      std::printf("%s,%s,%s,%s,%s\n", l.method.c_str(), l.settings.c_str(), l.property.c_str(), l.stages.c_str(),
                  l.zero.c_str());
    });
}

TEST_CASE("methods leave out what the table says a scene does not need", "[left_out]") { check_all(false); }

DEVICE_TEST_CASE("methods on the device leave out what the table says a scene does not need",
                 "[left_out][gpu][thorough]") {
  check_all(true);
}

}  // namespace left_out_test
