// The commands of `airlight`, one function each, free of the command-line library. Each returns the exit code and
// throws Error (exit code 2 or 3) or scene::Interrupted (130).
#pragma once
#include <map>
#include <string>
#include <vector>

namespace airlight::experiments::cli {

using Pairs = std::map<std::string, std::string>;  // from key=value

struct RenderOptions {
  std::string scene, method, out, png, samples;
  Pairs settings, overrides;
  int threads = 0;
  double exposure = 0;
};
// Writes the film with its record in the metadata; with `png` a preview too.
int render(const RenderOptions&);

struct CompareOptions {
  std::string image, reference, scene;
  std::string layer = "mean";
  std::vector<std::string> metrics;
  Pairs most;        // metric=bound
  double alpha = 0;  // > 0: tests of equality at this false-alarm rate
};
// Exit code 1 if a metric is above its bound, beyond what noise explains, or the images differ.
int compare(const CompareOptions&);

struct ConvertOptions {
  std::string in, out;
  std::string layer = "mean";
  double exposure = 0;
};
// One layer as PNG (8-bit sRGB) or PFM (linear floats).
int convert(const ConvertOptions&);

struct ExplainOptions {
  std::string scene, method;
  Pairs settings, overrides;
};
int explain(const ExplainOptions&);

int doctor();

struct ExperimentOptions {
  std::string root, profile = "quick", junit;
  std::vector<std::string> names;
  bool resume = false;
  int threads = 0;
};
int list_experiments(const ExperimentOptions&);
int run_experiments(const ExperimentOptions&);
int plot_experiments(const ExperimentOptions&);
// Runs what is not there yet of every experiment that has gates; exit code 1 names those that failed.
int gates(const ExperimentOptions&);

}  // namespace airlight::experiments::cli
