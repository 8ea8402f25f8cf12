// An experiment as data: what experiments/<group>/<name>.toml says (experiments/README.md documents the format).
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/application/folders.h"
#include "experiments/driver/next_frames.h"
#include "scene/convert/medium_form.h"
#include "scene/scene.h"

namespace airlight::experiments {

class ExperimentKind;
using Pairs = std::map<std::string, std::string>;

struct ReferenceCase {
  std::string renderer;  // empty: nothing is compared
  Pairs settings;
  std::filesystem::path committed;  // folder of committed films; empty: none is asked for
};

// The pictures of a sequence: what differs from one to the next.
struct SequenceCase {
  int count = 0;
  std::string key;           // path of an override that counts them: "medium.0.frame"; empty: media stand still
  int first = 0, step = 1;   // its values
  double turn = 0;           // [rad] by which suns and environments turn about the y axis
  Vec3 move = Vec3::Zero();  // [m] by which point and spot lights move
  struct Way {
    std::string path;              // of an override
    std::vector<double> from, to;  // its numbers in the first and the last picture, on a straight line between them
  };
  std::vector<Way> along;
};

struct SceneCase {  // kind "numbers": the input of a probe, all empty where there is none; "flow": the problem
  std::string name;
  std::string swept_from;  // the name without the sweep's value; empty without a sweep
  std::filesystem::path file;
  Pairs overrides;                         // with those of the profile
  std::optional<double> parameter;         // abscissa of plots over scenes
  std::string position;                    // file:line:column
  std::optional<SequenceCase> frames;      // kind "sequence"
  std::optional<ReferenceCase> reference;  // instead of the experiment's
  std::string of_sequence;  // what is swept from picture to picture: "frame" of a medium, "angle" of what turns
};

struct MethodCase {
  std::string name;
  std::string renderer;  // or the probe, or the solver
  Pairs settings;
  std::optional<scene::MediumConversion> convert;  // of the scene's media, before it is prepared
  std::string setting;                             // the swept setting's value, as text; empty without a sweep
  std::string layer;                               // compared with the reference's layer
  bool count_noise = false;         // the noise of this method is part of its error; else it is taken out
  bool anew = false;                // of a sequence every picture is prepared anew
  bool picture_only = false;        // rendered and timed, not compared
  std::optional<Moving> moving;     // each timed run is the next frame, of which this has moved; none: one frame
  std::vector<std::string> scenes;  // empty: all
  std::string position;             // file:line:column
};

// Is the method on this scene? A swept scene is called "name value": the name means all of them.
bool is_on(const MethodCase&, const SceneCase&);

struct TimingRule {
  int runs = 31;             // beside the warm-up; 5 where one takes over a second
  double least_seconds = 0;  // of warm-up
  double budget = 1;  // [s] per row for all runs, the warm-up included; 0: the run that makes the picture, no other
  int threads = 0;    // 0: all
};

struct PlotCase {
  std::string name, title, x, y, x_label, y_label;  // x: "seconds", "prepare_seconds", "parameter", "setting",
                                                    // "counter.NAME"; y: those or a metric; or both
                                                    // columns of the row, "column.NAME"
  bool per_scene = true;
  bool map = false;                  // not curves: the maps of the rows, side by side
  std::vector<std::string> methods;  // empty: all
  std::string position;              // file:line:column
};

struct GateCase {
  std::string scene, method, setting, metric;  // empty scene, method, setting: every one
  double at_most = infinity;
  double at_least = -infinity;
  std::string why;
  std::string position;  // file:line:column
  bool by_row = false;   // a bound by row (bounds.h): names are exact
  std::string device;    // that it was measured on, if not the processor
};

// Does the gate judge the row of this scene, method and setting? A swept scene is called "name value": a gate on the
// name means all of them.
bool judges(const GateCase&, const std::string& scene, const std::string& method, const std::string& setting);

struct SpeedUpCase {
  std::string baseline, method, metric;
};

struct ExpectedCase {
  std::string what, paper, scene, method, setting, metric;
  std::string baseline;  // not empty: how many times faster than this the method is at equal error of the metric
  std::string unit;      // that the figure is printed in (expected.h); empty: the usual one
};

// What a table shows, checked on it by scripts/figures. `table`: the folder that it is checked on, "group/name" or
// "group/name.paper".
struct ClaimCase {
  std::string where, claim, verdict, table;
};
struct Conclusion {
  std::string text, table;
};

struct Experiment {
  std::string id;  // "group/name"
  std::string title, paper, about;
  std::string summary;  // one sentence for people; {1} stands for the figure of the first [[expected]]
  const ExperimentKind* kind = nullptr;
  std::string profile;  // "quick" or "paper"
  std::vector<SceneCase> scenes;
  std::vector<std::string> sequences;  // that scenes show (sequences.h)
  std::vector<MethodCase> methods;
  ReferenceCase reference;
  std::string layer = "mean";
  std::vector<std::string> metrics;
  TimingRule timing;
  bool in_tests = false;            // its gates are judged by scripts/test
  bool stages = false;              // a table of the time of every stage
  bool left_out = false;            // every row says what its picture lacks
  std::vector<Moving::What> moves;  // of the frame after each of these moved every row says the time
  bool orders = false;              // a table of how fast errors fall with the swept setting
  std::vector<PlotCase> plots;
  std::vector<GateCase> gates;
  std::vector<SpeedUpCase> speed_ups;
  std::vector<ExpectedCase> expected;
  std::optional<Conclusion> conclusion;
  std::vector<ClaimCase> claims;
};

// The reference that judges the scene.
const ReferenceCase& reference_of(const Experiment&, const SceneCase&);

// Throws Error: file:line:column, what was found, what was expected, nearest valid key. Settings, metrics, renderers,
// names that refer to one another, and that every gate has a row and a figure to judge, are checked here; scenes by
// check_experiment.
Experiment read_experiment(const Folders&, const std::string& id, const std::string& profile);

// Where a profile's results lie below the results folder, and its pictures below its images/: "group/name" for quick,
// "group/name.paper" for paper, so that neither overwrites the other.
std::string results_name(const std::string& id, const std::string& profile);

// All ids below root/experiments, sorted. A file is an experiment if it lies in experiments/<group>/ and group is
// neither `scenes` nor `data`.
std::vector<std::string> experiment_ids(const std::filesystem::path& root);

// The ids that `names` stand for: ids, or groups; none means all. Throws Error with the nearest id.
std::vector<std::string> choose_experiments(const std::filesystem::path& root, const std::vector<std::string>& names);

}  // namespace airlight::experiments
