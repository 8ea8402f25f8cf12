// Times of stages on the device, by pairs of timestamps (GL_TIME_ELAPSED reads 0 on the software renderer).
#pragma once
#include <deque>
#include <string>
#include <vector>

#include "gpu/context.h"
#include "scene/renderer.h"

namespace airlight::gpu {

class StageTimer {
 public:
  explicit StageTimer(Context& context) : context_(context) { mark(); }
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;

  // Ends the stage that began at the last mark; the same name again adds up.
  void stage(const std::string& name);
  // Waits for the device. Seconds per stage, in the order of their first call.
  std::vector<scene::StageTime> times();

 private:
  void mark();

  Context& context_;
  std::vector<GLuint> queries_;
  std::vector<std::string> names_;
};

}  // namespace airlight::gpu
