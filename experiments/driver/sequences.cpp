#include "experiments/driver/sequences.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "experiments/application/build_info.h"
#include "experiments/application/fit_sequence.h"
#include "experiments/application/folder_lock.h"
#include "experiments/application/frames.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/application/progress.h"
#include "experiments/application/say.h"
#include "experiments/application/simulation.h"
#include "experiments/application/solvers.h"
#include "experiments/authoring/write_scene.h"
#include "experiments/driver/toml_values.h"
#include "scene/base/atomic_file.h"
#include "scene/base/content_key.h"
#include "scene/base/nearest.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"
#include "scene/load/parse_toml.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
using scene::load::TableReader;
namespace {

const std::string mark = "sequence:";

fs::path list_of(const fs::path& root) { return root / "experiments" / "sequences.toml"; }

toml::table read_list(const fs::path& root) {
  const std::string file = list_of(root).string();
  toml::table list = scene::load::parse_toml(scene::read_whole_file(file, scene::load::most_toml_bytes), file);
  // A name becomes that of a folder, which is removed where the sequence is made anew.
  for (const auto& [key, table] : list) {
    const std::string name(key.str());
    const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '-';
    });
    if (!plain)
      throw Error(fmt::format("{}: found the name '{}', expected letters, digits, '_' and '-'",
                              scene::load::location(key.source()), scene::printable(name, 100)));
  }
  return list;
}

// Absolute: scenes look for files beside themselves.
fs::path folder_of(const Folders& folders, const std::string& name, const std::string& profile) {
  return fs::absolute(folders.cache) / "sequences" / (name + "." + profile);
}

TableReader reader_of(const toml::table& list, const std::string& name) {
  const toml::table* table = list[name].as_table();
  if (!table)
    throw Error(fmt::format("{}: expected a table [{}]", scene::load::location(list[name].node()->source()), name));
  TableReader reader(*table, name);
  if (table->contains("fit"))
    reader.allow({"fit", "quick", "paper"});
  else if (table->contains("script"))
    reader.allow({"script", "quick", "paper"});
  else
    reader.allow({"problem", "solver", "quick", "paper"});
  return reader;
}

// Whose frames a sequence that is a fit is of; itself, if it is none.
std::string simulated(const toml::table& list, const std::string& name) {
  const TableReader reader = reader_of(list, name);
  if (!list[name].as_table()->contains("fit")) return name;
  std::string of = reader.text("fit");
  const toml::table* other = list[of].as_table();
  if (!other || !other->contains("problem")) reader.expected("fit", "the name of a sequence that is simulated");
  return of;
}

// "swirl.red.csv": the sequence swirl, the coefficients of its density red; "snow.particles.csv": where its particles are;
// "fitted.csv", "fitted.residual": of a fit. Frames by default.
std::pair<std::string, std::string> name_and_kind(const std::string& asked) {
  const std::size_t dot = std::min(asked.find('.'), asked.size());
  return {asked.substr(0, dot), dot < asked.size() ? asked.substr(dot) : ".vdb"};
}

fs::path problem_of(const fs::path& root, const TableReader& reader) {
  return root / "experiments" / reader.text("problem");
}

}  // namespace

std::string sequence_files(const Folders& folders, const std::string& asked, const std::string& profile,
                           const std::string& where) {
  const auto [name, kind] = name_and_kind(asked);
  const toml::table list = read_list(folders.root);
  std::vector<std::string> known;
  for (const auto& [key, table] : list) known.emplace_back(key.str());
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw Error(fmt::format("{}: there is no sequence '{}' in {}{}", where, name, list_of(folders.root).string(),
                            scene::nearest_hint(name, known)));
  std::string stem = name;
  std::vector<std::string> kinds{".csv"};
  if (!list[name]["script"]) {
    const std::string of = simulated(list, name);
    const auto problem = scene::load_flow(problem_of(folders.root, reader_of(list, of)).string());
    stem = problem.name;
    if (of != name) {
      kinds = {".csv", ".residual"};
    } else {
      kinds = {".vdb", ".csv"};
      if (!problem.particles.empty()) kinds.push_back(".particles.csv");
      for (const scene::NamedDensity& d : problem.densities) kinds.push_back("." + d.name + ".csv");
    }
  }
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw Error(fmt::format("{}: the sequence '{}' has no files {}, expected one of {}", where, name, kind,
                            fmt::join(kinds, ", ")));
  const std::size_t ending = kind.rfind('.');
  return (folder_of(folders, name, profile) / (stem + kind.substr(0, ending) + ".####" + kind.substr(ending))).string();
}

void name_sequences(const Folders& folders, const std::string& profile, const std::string& where, Pairs& overrides,
                    std::vector<std::string>& names) {
  for (auto& [key, value] : overrides) {
    if (value.size() < 2 || value.compare(1, mark.size(), mark) != 0) continue;  // in quotes of TOML
    const std::string name = value.substr(1 + mark.size(), value.size() - mark.size() - 2);
    value = scene::load::toml_string(sequence_files(folders, name, profile, where));
    const std::string plain = name_and_kind(name).first;
    if (std::find(names.begin(), names.end(), plain) == names.end()) names.push_back(plain);
  }
}

namespace {

void fit(const Folders& folders, const TableReader& reader, const std::string& name, const std::string& of,
         const std::string& profile, int threads) {
  TableReader of_profile = reader.required_table(profile);
  of_profile.allow({"gaussians"});
  FitSequence fitted;
  fitted.options.gaussians = int(of_profile.integer("gaussians", 1, scene::most_fit_gaussians));
  fitted.folder = folder_of(folders, name, profile);
  fitted.begin_anew = true;
  make_folder(fitted.folder);
  const FolderLock lock = FolderLock::wait_for(fitted.folder);
  fitted.locked = true;
  for (const auto& entry : fs::directory_iterator(folder_of(folders, of, profile)))
    if (entry.path().extension() == ".vdb") fitted.files.push_back(entry.path().string());
  std::sort(fitted.files.begin(), fitted.files.end());
  Progress progress(fmt::format("sequence {} ({})", name, profile));
  fit_sequence(fitted, progress.execution(threads));
}

// Gaussians of a script of strokes, whose emitters go on from frame to frame.
void author(const Folders& folders, const TableReader& reader, const std::string& name, const std::string& profile) {
  TableReader of_profile = reader.required_table(profile);
  of_profile.allow({"frames", "rate"});
  const int frames = int(of_profile.integer("frames", 1, 10000));
  const double rate = of_profile.number("rate", {1e-3, 1e6});
  const std::string script = (folders.root / "experiments" / reader.text("script")).string();
  const fs::path folder = folder_of(folders, name, profile);
  make_folder(folder);
  const FolderLock lock = FolderLock::wait_for(folder);
  const auto base = authoring::run_script(script, check_interrupted).scene;
  const std::string made_of = content_key({scene::read_whole_file(script), base ? base->hash : "",
                                           std::to_string(frames), fmt::format("{}", rate), source_id()});
  const fs::path record = folder / "made_of";
  if (fs::exists(record) && scene::read_whole_file(record.string()) == made_of) return;
  for (const auto& entry : fs::directory_iterator(folder)) fs::remove_all(entry.path());
  Progress progress(fmt::format("sequence {} ({})", name, profile));
  std::string history = "frame,gaussians\n";
  for (int frame = 0; frame < frames; ++frame) {
    progress.update(double(frame) / frames);
    const authoring::Authored authored = authoring::run_script(script, check_interrupted, frame / rate);
    const auto files = authoring::scene_files(authored, script, (folder / "scene.toml").string());
    if (files.tables.size() != 1)
      throw Error(
          fmt::format("{}: {} colours in frame {}, expected one for a sequence", script, files.tables.size(), frame));
    scene::write_file_atomically((folder / fmt::format("{}.{:04}.csv", name, frame)).string(), files.tables[0].csv);
    history += fmt::format("{},{}\n", frame, files.tables[0].gaussians);
  }
  scene::write_file_atomically((folder / "history.csv").string(), history);
  scene::write_file_atomically(record.string(), made_of);
}

}  // namespace

void make_sequence(const Folders& folders, const std::string& asked, const std::string& profile, int threads) {
  const std::string name = name_and_kind(asked).first;
  const toml::table list = read_list(folders.root);
  const TableReader reader = reader_of(list, name);
  scene::make_private_folder(folders.cache, "sequences");
  if (list[name]["script"]) return author(folders, reader, name, profile);
  if (const std::string of = simulated(list, name); of != name) {
    make_sequence(folders, of, profile, threads);
    fit(folders, reader, name, of, profile, threads);
    return;
  }
  TableReader of_profile = reader.required_table(profile);
  of_profile.allow({"settings", "overrides"});
  const toml::table& raw = *list[name][profile].as_table();
  const scene::Solver& solver = find_solver(reader.text("solver"), reader.where());
  const scene::Settings chosen(solver.settings(), settings(raw, "settings", of_profile), name);
  const auto problem = std::make_shared<const scene::FlowProblem>(
      scene::load_flow(problem_of(folders.root, reader).string(), overrides(raw, "overrides", of_profile)));
  Simulation simulation{problem, solver, chosen, folder_of(folders, name, profile)};
  make_folder(simulation.folder);
  const FolderLock lock = FolderLock::wait_for(simulation.folder);
  simulation.locked = true;
  const FramesThere there = frames_there(simulation);
  if (there.frames == frame_steps(*problem, solver, chosen).frames) return;
  if (!there.damage.empty()) say(there.damage + "; simulating the sequence anew");
  if (there.frames == 0)  // the folder itself is locked
    for (const auto& entry : fs::directory_iterator(simulation.folder)) fs::remove_all(entry.path());
  Progress progress(fmt::format("sequence {} ({})", name, profile));
  simulate(simulation, progress.execution(threads));
}

Columns sequence_history(const Folders& folders, const std::string& name, const std::string& profile) {
  const fs::path folder = folder_of(folders, name, profile);
  Columns columns;
  if (const fs::path file = folder / "record.json"; fs::exists(file)) {
    const auto record = read_json(file.string());
    double number = 0;
    for (const auto& frame : record.at("frames")) {
      columns["frame"].push_back(number++);
      for (const auto& [key, value] : frame.items())
        if (value.is_number()) columns[key].push_back(value.get<double>());
    }
    return columns;
  }
  const std::string file = (folder / "history.csv").string();
  std::istringstream lines(scene::read_whole_file(file));
  const auto cells_of = [](const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    return cells;
  };
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = cells_of(line);
  for (int number = 2; std::getline(lines, line); ++number) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != names.size())
      throw Error(fmt::format("{}:{}: {} fields, expected {}", file, number, cells.size(), names.size()));
    for (std::size_t i = 0; i < cells.size(); ++i) columns[names[i]].push_back(std::stod(cells[i]));
  }
  return columns;
}

}  // namespace airlight::experiments
