// Times of stages on the device, by pairs of timestamps (GL_TIME_ELAPSED reads 0 on the software renderer). Queries are
// kept from frame to frame; debuggers see the stages as groups.
#pragma once
#include <string>
#include <vector>

#include "gpu/context.h"
#include "scene/renderer.h"

namespace airlight::gpu {

class StageTimer {
 public:
  explicit StageTimer(Context& context) : context_(context) { restart(); }
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;

  // Forgets all stages; the time counts from now.
  void restart();
  // Begins a stage that lasts until the next begins or times() is called; the same name again adds up.
  void begin(const std::string& name);
  // Ends what began at the last mark, named afterwards; for work that is no group to debuggers.
  void stage(const std::string& name);
  // Ends the running stage and waits for the device. Seconds per stage, in the order of their first call.
  std::vector<scene::StageTime> times();
  // After times(): what the processor spent between the same marks, the wait left out.
  std::vector<scene::StageTime> host_times() const;

 private:
  std::vector<scene::StageTime> by_stage(const std::vector<double>& at) const;
  void mark();
  void end();

  Context& context_;
  std::vector<GLuint> queries_;  // all there are; as many marks are in use
  std::size_t marks_ = 0;
  std::vector<double> host_;  // [s] of the marks on the processor's clock
  std::vector<std::string> names_;
  std::string running_;
};

}  // namespace airlight::gpu
