// The commands of `airlight`, one function each, free of the command-line library. Each returns the exit code and
// throws Error (exit code 2 or 3) or scene::Interrupted (130).
#pragma once
#include <map>
#include <string>
#include <vector>

namespace airlight::experiments::cli {

using Pairs = std::map<std::string, std::string>;  // from key=value

struct RenderOptions {
  std::string scene, method, out, png, samples, cache;
  Pairs settings, overrides;
  int threads = 0;
  double exposure = 0;
  bool distance = false;  // a layer `distance` too
};
// Writes the film with its record in the metadata; with `png` a preview too. A range of samples A..B also leaves
// `out`.samples for merging. Interrupted, a path tracer keeps the samples it has: the film is written, and the exit
// code is 130 all the same.
int render(const RenderOptions&);

struct MergeOptions {
  std::string scene, out;
  std::vector<std::string> parts;
  Pairs overrides;
};
// Joins ranges of samples of one picture, whoever computed them, to the bits of a render in one go. Refuses overlaps,
// gaps, and parts of another scene, view, setting, seed or build. Leaves `out`.samples too.
int merge(const MergeOptions&);

struct CompareOptions {
  std::string image, reference, scene;
  std::string layer = "mean";
  std::vector<std::string> metrics;
  Pairs most;        // metric=bound
  Pairs overrides;   // of the scene
  double alpha = 0;  // > 0: tests of equality at this false-alarm rate
};
// Exit code 1 if a metric is above its bound, beyond what noise explains, or the images differ.
int compare(const CompareOptions&);

struct ConvertOptions {
  std::vector<std::string> files;  // in, out, in, out, ...
  std::string layer = "mean";
  double exposure = 0;
  std::optional<double>
      depth_scale;               // of a PNG, grey with 16 bits: the layer's first channel, this many metres are white
  std::string grid = "density";  // of an OpenVDB file
  int pixels = 64, samples = 2, degree = 1;
  std::string medium = "0";              // of a scene: its name, or its number
  std::vector<int> coefficients = {12};  // of a Legendre box: along all axes, or x, y, z
  int cells = 24;                        // that its projection integrates over, along an axis
  bool no_lanczos = false, no_limiter = false;
};
// One layer of each file as PNG (8-bit sRGB) or PFM (linear floats); an OpenVDB file as a fogmap of its columns; such a file or a
// medium of a scene as a Legendre box.
int convert(const ConvertOptions&);

struct FitCommand {
  std::vector<std::string> files;
  std::string out, grid = "density", medium = "0", method = "gauss_newton";
  int gaussians = 1000, deleted = 3, inserted = 8, threshold = 0, threads = 0;
  double unit = 0, allowed = 1.1;
  bool keep = false;
};
// Smoke as Gaussians and residuals, frame by frame, into the folder `out` (experiments/application/fit_sequence.h), or goes on with them.
int fit(const FitCommand&);

struct ExplainOptions {
  std::string scene, method;
  Pairs settings, overrides;
};
int explain(const ExplainOptions&);

struct SimulateOptions {
  std::string problem, method = "stable_fluids", out;
  Pairs settings, overrides;
  std::string sequence, profile = "quick";  // in place of a problem and a folder
  std::string scene, renderer;              // of pictures of each frame; scene empty: none; renderer empty: by method
  Pairs renderer_settings;
  double exposure = 0;
  int threads = 0;
};
// Writes the frames of a flow problem into the folder `out` (experiments/application/simulation.h), or goes on with them; and pictures of them,
// NAME.0000.png, ..., of a scene.
int simulate(const SimulateOptions&);

struct AuthorOptions {
  std::string script, out;
};
// Runs a script of authoring operations (methods/fogshop/README.md) and writes the scene and its tables of Gaussians.
int author(const AuthorOptions&);

int doctor();

struct ExperimentOptions {
  std::string root, profile = "quick", junit, margins_csv;
  std::string results, cache;  // folders; empty: results and results/cache below root
  std::vector<std::string> names;
  bool resume = false;
  bool gates_only = false;        // experiments without gates are left out
  bool in_tests = false;          // likewise those without in_tests = true
  bool margins = false;           // how far each gate is from failing
  bool fresh_references = false;  // first makes all committed references of these experiments anew
  int threads = 0;
};
int list_experiments(const ExperimentOptions&);
// All files, scenes and settings are checked before anything is computed; exit code 1 names gates that failed.
int run_experiments(const ExperimentOptions&);
int plot_experiments(const ExperimentOptions&);
// Runs what is not there yet of every experiment that has gates; exit code 1 names those that failed.
int gates(const ExperimentOptions&);

}  // namespace airlight::experiments::cli
