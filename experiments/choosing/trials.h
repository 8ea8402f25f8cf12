// Times and errors of candidates in one scene: on its own film if that is cheap or worth it, else on a small one.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/choosing/candidates.h"
#include "experiments/choosing/truth.h"
#include "experiments/judging/statistics.h"

namespace airlight::experiments {

// Parts of the scene that move from one frame to the next. Empty: a still from nothing, whose time
// includes conversion and preparation.
using Moves = std::vector<Moving::What>;

// One of the two.
struct Goal {
  std::optional<double> seconds;  // of a frame, at most
  std::optional<double> error;    // at most
};

// [s]
struct FrameTime {
  Estimate seconds{0, 0, 0};
  bool at_least = false;  // the frame was not timed, being far from the goal: it takes at least the lower end
};

struct Trial {
  const Candidate* candidate = nullptr;
  std::string refused;              // why it cannot render the scene; else empty
  std::string stopped;              // why there are no figures, though it could
  Measure error;                    // relative L2 of the picture
  std::vector<FrameTime> times;     // in the order of the moves asked for
  std::vector<FrameTime> screened;  // times by the small film alone
  bool of_film = false;             // error and times are those of the scene's own film; else times are extrapolated
  std::string left_out;
  double density_error = 0;  // of the conversion, relative L2; 0 without
  bool done() const { return !times.empty(); }
};

// A candidate whose time or error on the small film is up to this factor above the goal is tried on the
// scene's own film.
inline constexpr double worth_trying = 1.25;

class Trials {
 public:
  // Throws Error where something of `moves` has nothing in the scene that could move so.
  Trials(std::shared_ptr<const scene::Scene>, TrialSetup, std::vector<Moves>, Report);

  // Tries the candidates that are wanted (default: all), each renderer's first row first. Throws scene::Interrupted on a signal; a trial says
  // so where the time to spend is over.
  std::vector<Trial> run(const std::vector<Candidate>&, const Truth&, const Goal&,
                         const std::function<bool(const Candidate&)>& wanted = {});
  // Share of the threads' time in run() in which no processor was free for them: other programs made times longer.
  double waited() const { return waited_; }

 private:
  struct Converted {
    std::shared_ptr<const scene::Scene> scene;  // null: it cannot be converted
    std::string refused;
    double seconds = 0, density_error = 0;
  };
  struct Pass;  // a preparation, its first picture, and frames after that
  const Converted& scene_for(const Candidate&);
  scene::Execution execution() const;  // ends at the deadline
  Pass pass(const Candidate&, const Converted&, const scene::View&) const;
  std::vector<Estimate> stills(const Candidate&, const Converted&, const std::vector<scene::View>&) const;
  // Empty where the first takes hopelessly long.
  std::vector<Estimate> frames(const Candidate&, const Converted&, const Moves&, Pass&, const std::vector<scene::View>&,
                               const Goal&) const;
  std::vector<FrameTime> times(const Trial&, const Converted&, const Moves&, Pass&, const std::vector<scene::View>&,
                               const Goal&) const;
  void screen(Trial&, const Truth&, const Goal&);
  void measure_on_film(Trial&, const Truth&, const Goal&);
  // [s] of the time to spend, which begins with the constructor; while films are small, of a part of it.
  double left() const;
  bool attempt(Trial&, const std::function<void()>& work);

  std::shared_ptr<const scene::Scene> scene_;
  TrialSetup setup_;
  std::vector<Moves> moves_;
  Report report_;
  double start_, end_, deadline_;
  double waited_ = 0;
  double done_ = 0;  // share of the candidates
  std::map<std::string, Converted> converted_;
  std::map<const Candidate*, double> costs_;  // [s] that the trial on the scene's film takes, about
};

// Time on a film of `pixels` from medians on two smaller films, if it is a sum of one part that knows no film and one that grows with it.
Estimate extrapolated(const Estimate& small, double small_pixels, const Estimate& smaller, double smaller_pixels,
                      double pixels);

}  // namespace airlight::experiments
