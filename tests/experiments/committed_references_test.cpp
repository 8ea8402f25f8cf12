// References committed as films: how they are made, found and refused, and whether those of the project are still what the
// program computes.
#include "experiments/driver/committed_references.h"

#include <catch2/catch.hpp>
#include <iostream>
#include <numeric>

#include "experiments/application/json_value.h"
#include "experiments/application/machine.h"
#include "experiments/driver/run.h"
#include "experiments/judging/equality.h"
#include "scene/base/content_store.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"
#include "tests/texts.h"

namespace committed_references_test {

using namespace airlight::experiments;
using namespace airlight::test;
using airlight::read_bytes;
using airlight::test::replaced;
using Catch::Contains;
namespace fs = std::filesystem;
namespace scene = airlight::scene;

namespace {

// The guard: a part of a committed film is computed anew, with other random numbers, and compared.
constexpr double false_alarms = 1e-4;  // per film
constexpr double most_undetected =
    0.03;                             // relative bias of a whole Monte Carlo film that the guard must be able to find
constexpr double most_pixels = 5000;  // as far as the film's size allows

// Every odd `f`-th pixel: pixel x of the small film has the same centre as pixel f x + (f - 1) / 2 of the large one.
scene::Film subsampled(const scene::Film& film, int f) {
  scene::Film small(film.width / f, film.height / f);
  small.metadata = film.metadata;
  for (const auto& [name, values] : film.layers) {
    std::vector<float>& to = small.add(name);
    for (int y = 0; y < small.height; ++y)
      for (int x = 0; x < small.width; ++x)
        for (int c = 0; c < 3; ++c)
          to[std::size_t(3 * (y * small.width + x) + c)] =
              values[std::size_t(3 * ((f * y + f / 2) * film.width + f * x + f / 2) + c)];
  }
  return small;
}

// The smallest odd number that divides both sides and leaves few pixels; else the greatest that divides them.
int stride(const scene::Film& film, double most) {
  int best = 1;
  for (int f = 3; f <= std::min(film.width, film.height); f += 2) {
    if (double(film.pixels()) <= most * best * best) break;
    if (film.width % f == 0 && film.height % f == 0) best = f;
  }
  return best;
}

scene::Film render(const CommittedReference& r, const scene::Settings& settings, int f) {
  scene::View view = scene::view_of(*r.scene);
  view.width /= f;
  view.height /= f;
  const scene::Execution execution;
  return r.renderer->prepare(r.scene, settings, execution)->render(view, execution).film;
}

std::string monte_carlo_objection(const CommittedReference& r, const scene::Film& film, int f) {
  std::map<std::string, std::string> given;
  for (const auto& spec : r.renderer->settings()) given[spec.name] = r.settings.text(spec.name);
  const double all = std::stod(film.metadata.at("samples"));
  given["seed"] = std::to_string(r.settings.integer("seed") + 1);
  given["stream"] = "1";
  given["target_error"] = "0";
  Equality e;
  // Uses the fewest samples that can detect this bias. The choice depends on the noise alone, not on the difference,
  // and so causes no false alarms.
  const auto strong = [&] { return e.image_in_range && e.detectable_bias <= most_undetected; };
  int samples = 16;
  do {
    samples *= 4;
    given["samples"] = std::to_string(samples);
    const scene::Settings settings(r.renderer->settings(), given, r.renderer->name());
    e = compare_equal(render(r, settings, f), subsampled(film, f), r.layer, {}, false_alarms);
  } while (!strong() && samples < std::min(all, 1024.0));
  std::cout << r.asked_by << ": " << samples << " samples, one pixel of " << f << "x" << f << ": finds a bias of "
            << 100 * e.detectable_bias << " %; whole film z " << e.image_z << "\n";
  if (sure_objections(e, false_alarms)) return "not what the program computes now: " + text(e);
  if (!strong()) return "the guard is too weak: " + text(e);
  return "";
}

// Quadrature errs by at most its tolerance; the rest is rounding in single precision, and of other processors.
std::string exact_objection(const CommittedReference& r, const scene::Film& film, int f) {
  double tolerance = 2e-6;
  for (const auto& spec : r.renderer->settings())
    if (spec.name == "relative_tolerance") tolerance += 2 * r.settings.real("relative_tolerance");
  const scene::Film fresh = render(r, r.settings, f), kept = subsampled(film, f);
  const std::vector<float>&a = fresh.layer(r.layer), &b = kept.layer(r.layer);
  float greatest = 0;
  for (const float value : b) greatest = std::max(greatest, std::abs(value));
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(std::abs(a[i] - b[i]) <= tolerance * std::abs(b[i]) + 1e-6 * greatest))
      return "not what the program computes now: pixel " + std::to_string(i / 3) + ": found " + std::to_string(b[i]) +
             ", computed " + std::to_string(a[i]);
  return "";
}

// Empty if the committed film is what the program computes now, as far as the guard can tell.
std::string objection(const CommittedReference& r, double most = most_pixels) {
  const scene::Film film = read_committed(r.file);
  if (film.width != r.scene->width || film.height != r.scene->height) return "a film of another size";
  // A pixel that is a mean over its area has another area in a smaller film.
  const int f = r.settings.canonical().find("pixel=box") == std::string::npos ? stride(film, most) : 1;
  return r.renderer->monte_carlo() ? monte_carlo_objection(r, film, f) : exact_objection(r, film, f);
}

const std::string noisy_experiment = R"(title = "Committed"
metrics = ["rel_l2", "bias"]
[[scene]]
file = "scenes/one.toml"
[reference]
renderer = "path_tracer"
settings = { max_order = 1 }
[[method]]
name = "marcher"
renderer = "ray_marcher"
settings = { kernel = "scalar" }
[profile.quick]
budget = 0
committed_references = true
reference = { samples = 512 }
)";

const std::string exact_experiment =
    replaced(replaced(noisy_experiment, "\"path_tracer\"\nsettings = { max_order = 1 }", "\"deterministic\""),
             "reference = { samples = 512 }\n", "reference = { relative_tolerance = 1e-6 }\n");

struct Project : SmallProject {
  explicit Project(const std::string& experiment)
      : SmallProject(box_of_fog(48, 36, "vertical_fov = 0.7\n"), experiment) {}
  Experiment read() const { return read_experiment(path(), "g/e", "quick"); }
  Outcome run(bool resume = false) const { return run_experiment(read(), {path(), resume, 1, false}); }
  CommittedReference reference() const {
    const auto all = committed_references({read()});
    REQUIRE(all.size() == 1);
    return all[0];
  }
  void make() const { make_committed(reference(), {}); }
};

}  // namespace

TEST_CASE("a committed film is used, and the record says so", "[committed_references]") {
  const std::string experiment = GENERATE(noisy_experiment, exact_experiment);
  const Project project(experiment);
  const Outcome before = project.run();  // no film: computed, and kept in the cache
  CHECK(before.references.at(0).committed.empty());
  CHECK(project.run().references.at(0).cached);
  project.make();
  const std::string file = project.reference().file.filename().string();
  CHECK(project.has(std::string(committed_folder) + "/" + file));
  CHECK(project.has(std::string(committed_folder) + "/" + file + ".xxh128"));
  fs::remove_all(project.path() / "results/cache");
  const Outcome after = project.run();
  const ReferenceInfo& info = after.references.at(0);
  CHECK_FALSE(info.cached);
  CHECK(info.committed == std::string(committed_folder) + "/" + file);
  CHECK_THAT(info.program, Catch::StartsWith("airlight "));
  CHECK_FALSE(project.has("results/cache/references"));
  CHECK_FALSE(project.has("results/cache/samples"));
  const auto record = nlohmann::json::parse(read_bytes(project.file("results/g/e/run.json")));
  CHECK(record["references"][0]["committed"] == info.committed);
  CHECK(record["references"][0]["made_by"] == info.program);
  CHECK(record["references"][0]["kept"] == info.kept);
  CHECK_THAT(
      read_bytes(project.file("results/g/e/table.md")),
      Contains("read from the committed film `" + info.committed + "`, made by airlight ") && Contains(info.kept));
  // The samples are unchanged; only the batches are rounded. Quadrature has no noise and is kept exactly.
  const Measure &a = before.rows.at(0).measures.at(0), &b = after.rows.at(0).measures.at(0);
  if (experiment == exact_experiment) {
    CHECK(a.value == b.value);
  } else {
    CHECK(info.samples == "512");
    CHECK((b.low <= a.high && a.low <= b.high));
    CHECK(b.floor > a.floor);
    CHECK(b.floor < 1.05 * a.floor);
  }
}

TEST_CASE("rows are kept only while the committed film stays as it is", "[committed_references]") {
  const Project project(noisy_experiment);
  project.make();
  const std::string first = project.run().rows.at(0).key;
  CHECK(project.run(true).rows.at(0).key == first);
  const CommittedReference r = project.reference();
  const std::string film = read_bytes(r.file.string());
  project.write("experiments/g/f.toml", replaced(noisy_experiment, "samples = 512", "samples = 512, seed = 5"));
  const auto other = committed_references({read_experiment(project.path(), "g/f", "quick")}).at(0);
  make_committed(other, {});
  for (const std::string end : {"", ".xxh128"})
    fs::copy_file(other.file.string() + end, r.file.string() + end, fs::copy_options::overwrite_existing);
  CHECK_THROWS_WITH(project.run(true), Contains("damaged committed reference"));  // another one, moved here
  airlight::write_bytes(r.file.string() + ".xxh128",
                        committed_checksum(other.file) + "  " + r.file.filename().string() + "\n");
  CHECK(project.run(true).rows.at(0).key != first);
}

TEST_CASE("a damaged committed film ends the run with code 2 and says what to do", "[committed_references]") {
  const Project project(noisy_experiment);
  project.make();
  const fs::path file = project.reference().file;
  const std::string whole = read_bytes(file.string());
  const auto refusal = [&]() -> std::string { return airlight::test::message_of([&] { project.run(); }); };
  airlight::write_bytes(file.string(), whole.substr(0, whole.size() / 2));
  CHECK_THAT(refusal(), Contains("damaged committed reference") && Contains("git checkout") && !Contains("\n"));
  std::string changed = whole;
  changed[changed.size() - 40] ^= 1;
  airlight::write_bytes(file.string(), changed);
  CHECK_THAT(refusal(), Contains("damaged committed reference"));
  airlight::write_bytes(file.string(), whole);
  CHECK(refusal() == "");
  fs::remove(file.string() + ".xxh128");
  CHECK_THAT(refusal(), Contains("without its checksum"));
}

TEST_CASE("the key of a committed film is scene, size, renderer, settings and layer", "[committed_references]") {
  const Project project(noisy_experiment);
  const fs::path file = project.reference().file;
  project.write("experiments/g/f.toml", replaced(noisy_experiment, "Committed", "Shared"));
  const auto shared = committed_references({project.read(), read_experiment(project.path(), "g/f", "quick")});
  REQUIRE(shared.size() == 1);
  CHECK(shared[0].file == file);
  CHECK(shared[0].asked_by == "g/e, scene 'one'");
  const std::string scene = box_of_fog(48, 36, "vertical_fov = 0.7\n");
  project.write("experiments/scenes/one.toml", replaced(scene, "sigma_t = 0.5", "sigma_t = 0.6"));
  CHECK(project.reference().file != file);
  project.write("experiments/scenes/one.toml", replaced(scene, "height = 36", "height = 24"));
  CHECK(project.reference().file != file);
  project.write("experiments/scenes/one.toml", "# another comment\n" + scene);
  CHECK(project.reference().file == file);
  project.write("experiments/g/e.toml", replaced(noisy_experiment, "samples = 512", "samples = 576"));
  CHECK(project.reference().file != file);
  project.write("experiments/g/e.toml", replaced(noisy_experiment, "committed_references = true", ""));
  CHECK(committed_references({project.read()}).empty());
}

TEST_CASE("committed references are refused where they could not be guarded", "[committed_references]") {
  const auto refusal = [](const std::string& experiment) -> std::string {
    return airlight::test::message_of([&] { Project(experiment).read(); });
  };
  CHECK(refusal(noisy_experiment) == "");
  CHECK_THAT(refusal(replaced(replaced(exact_experiment, "\"deterministic\"", "\"fogshop\""),
                              "reference = { relative_tolerance = 1e-6 }\n", "")),
             Contains("e.toml:") && Contains("only those of reference/ may be committed"));
  CHECK_THAT(refusal(replaced(noisy_experiment, "committed_references = true", "committed_references = 1")),
             Contains("e.toml:") && Contains("committed_references"));
  CHECK_THAT(refusal("kind = \"numbers\"\ntitle = \"n\"\nmetrics = []\n[profile.quick]\ncommitted_references = true\n"),
             Contains("e.toml:5:") && Contains("only pictures"));
}

// The fault: a scene that was edited behind the film's back, so that the film is 4 % too dark.
TEST_CASE("the guard passes what the program computes, and finds what it does not", "[committed_references]") {
  const std::string experiment = GENERATE(noisy_experiment, exact_experiment);
  const Project project(experiment);
  project.make();
  const CommittedReference r = project.reference();
  CHECK(objection(r) == "");
  CHECK(objection(r, 500) == "");  // of 3x3 pixels one
  CommittedReference edited = r;
  const std::string scene = box_of_fog(48, 36, "vertical_fov = 0.7\n");
  for (const std::string change : {"intensity = 5.2", "intensity = 5"}) {
    project.write("experiments/scenes/two.toml", replaced(scene, "intensity = 5", change));
    edited.scene = std::make_shared<const scene::Scene>(scene::load_scene(project.file("experiments/scenes/two.toml")));
    INFO(change);
    for (const double most : {most_pixels, 500.0})
      CHECK((objection(edited, most) == "") == (change == "intensity = 5"));
  }
}

TEST_CASE("the option --fresh-references makes the films, and says how long it took", "[committed_references][cli]") {
  const Project project(noisy_experiment);
  const Result missing = run("experiment run g/e --root .", project);
  CHECK(missing.code == 0);
  CHECK_THAT(missing.err, Contains("reference of 'one' is not committed") && Contains("--fresh-references"));
  const Result made = run("experiment run g/e --root . --fresh-references", project);
  CHECK(made.code == 0);
  CHECK(made.err.empty());
  const std::string name = project.reference().file.filename().string();
  CHECK_THAT(made.out, Contains("reference 1 of 1: g/e, scene 'one': ") && Contains(name));
  const std::string film = read_bytes(project.reference().file.string());
  CHECK(run("experiment run g/e --root .", project).err.empty());
  // Another run makes the same film: the same samples, rounded alike. Its metadata has the seconds that it took.
  CHECK(run("experiment run g/e --root . --fresh-references", project).code == 0);
  CHECK(read_committed(project.reference().file).layers.size() == 18);
  project.write("experiments/g/e.toml", replaced(noisy_experiment, "committed_references = true", ""));
  const Result none = run("experiment run g/e --root . --fresh-references", project);
  CHECK(none.code == 2);
  CHECK_THAT(none.err, Contains("no experiment of this run has committed references") && !Contains("\n "));
}

namespace {

const fs::path root = AIRLIGHT_SOURCE_DIR;

std::vector<CommittedReference> references_of_project() {
  std::vector<Experiment> experiments;
  for (const std::string& id : experiment_ids(root)) {
    // Reading all of them, with their bounds, takes a second: only those that ask for films.
    if (read_bytes((root / "experiments" / (id + ".toml")).string()).find("committed_references") == std::string::npos)
      continue;
    for (const std::string profile : {"quick", "paper"}) experiments.push_back(read_experiment(root, id, profile));
  }
  return committed_references(experiments);
}

void check_guard(bool of_headline) {
  int checked = 0;
  for (const CommittedReference& r : references_of_project()) {
    if (!fs::exists(r.file) || r.asked_by.starts_with("headline/") != of_headline) continue;
    INFO(r.asked_by << ": " << r.file.string());
    CHECK(objection(r) == "");
    ++checked;
  }
  CHECK(checked > 0);
  std::cout << checked << " committed references: as the program computes them now\n";
}

}  // namespace

TEST_CASE("no committed reference is missing, none is left over, and all fit into their megabytes",
          "[committed_references]") {
  const fs::path folder = root / committed_folder;
  std::map<std::string, std::uintmax_t> films;  // name and bytes
  for (const auto& file : fs::directory_iterator(folder))
    if (file.path().extension() == ".exr") films[file.path().filename().string()] = fs::file_size(file.path());
  std::uintmax_t bytes = 0;
  for (const auto& [name, size] : films) bytes += size;
  CHECK(bytes <= most_committed_bytes);
  for (const CommittedReference& r : references_of_project()) {
    INFO(r.asked_by << ": " << r.file.string());
    // If not: airlight experiment run NAME --fresh-references, and commit the film.
    CHECK(films.erase(r.file.filename().string()) == 1);
  }
  for (const auto& [name, size] : films)
    FAIL_CHECK("no experiment uses " << committed_folder << "/" << name << ": delete it");
}

TEST_CASE("the headline's committed references are what the program computes", "[committed_references]") {
  check_guard(true);
}

TEST_CASE("all other committed references are what the program computes", "[committed_references][thorough]") {
  check_guard(false);
}

}  // namespace committed_references_test
