// The path tracer's picture of a scene, which gets more samples while nobody asks for a frame.
#pragma once
#include <memory>
#include <string>

#include "experiments/judging/metrics.h"
#include "experiments/serve/pane.h"
#include "reference/path_tracer/accumulation.h"

namespace airlight::experiments::serve {

class LiveReference {
 public:
  // Throws scene::NotSupported, with the reason.
  LiveReference(std::shared_ptr<const scene::Scene>, int width, int height, bool all_orders);

  bool is_of(const scene::Scene&, int width, int height, bool all_orders) const;
  // A block of samples more, or as much of it as takes about so many seconds, or until the execution says stop.
  void advance(const scene::Execution&, double seconds);
  double seconds() const { return accumulation_.seconds; }  // that the samples took
  bool complete() const { return samples() >= most_samples; }
  // Samples of every pixel, at least.
  std::uint64_t samples() const { return accumulation_.least_samples(); }
  // The picture so far.
  std::shared_ptr<const scene::Film> film() const;
  std::string about() const;  // "path tracing with all orders of scattering"

 private:
  static constexpr std::uint64_t most_samples = 1 << 14;

  std::shared_ptr<const scene::Scene> scene_;
  scene::View view_;
  bool all_orders_;
  long long most_orders_ = -1;  // of scattering; -1: all
  std::unique_ptr<path_tracer::World> world_;
  path_tracer::Accumulation accumulation_;
};

// Relative L2 error of a frame against a reference of the same scene and film, with its interval. Nothing, and why, where there is none.
struct LiveError {
  std::string missing;
  Measure measure;
};
LiveError error_of(const Frame&, const scene::Scene& of, const scene::Film& reference, std::uint64_t samples,
                   const std::vector<unsigned char>& left_out);

}  // namespace airlight::experiments::serve
