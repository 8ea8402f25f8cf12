// A sweep of every quantity of a scene over all powers of ten that a double holds.
//
// Each case has a law: the picture at s is factor(s)/factor(base) times that at `base`, to `law`; every renderer is
// held to it by its own picture at `base`, and there by the truth: the deterministic quadrature, or many paths, of one
// scattering under an environment, of all where the renderer has all. Where no law holds the truth is made at every s. Outcome of one value for one
// renderer: right; right, but for an approximation that its picture warns of; refused at loading; refused by name
// (supports, or an error while it renders); wrong.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace airlight::stress {

struct SweepCase {
  std::string quantity, scene;              // "intensity", "ball"
  std::function<std::string(double)> text;  // the scene file at s
  std::function<double(double)> factor;
  double base;
  double from = 0, to = 1e301;  // of s: where the law holds
  std::string layer = "mean";
  double law = 1e-6;                // how well it holds, relative to the brightest pixel
  bool dark = false;                // the picture at s is black beside that at base
  std::vector<double> truths = {};  // no law: these values of s, each against the truth
};

std::vector<SweepCase> sweep_cases();

// 1e-300 to 1e300: every decade from 1e-33 to 1e33 that `step` divides, and coarser beyond.
std::vector<double> sweep_values(int step);

struct Tally {
  int right = 0, warned = 0, at_loading = 0, by_name = 0, wrong = 0;
  double error = -1;      // from the truth, the greatest of all pixels relative to the brightest; < 0: not compared
  bool available = true;  // false: it cannot do such scenes, or has no device
  std::vector<std::string> details;  // of what is wrong
};
// By renderer; "fogshop variant=paper" is one with a setting.
std::map<std::string, Tally> sweep(const SweepCase&, const std::vector<double>& values,
                                   const std::vector<std::string>& renderers);

}  // namespace airlight::stress
