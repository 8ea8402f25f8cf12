#include "gpu/timer.h"

#include <algorithm>
#include <chrono>

namespace airlight::gpu {

StageTimer::~StageTimer() {
  const Use use(context_);
  if (!running_.empty()) context_.end_group();
  context_.gl().DeleteQueries(GLsizei(queries_.size()), queries_.data());
}

void StageTimer::restart() {
  const Use use(context_);
  if (!running_.empty()) context_.end_group();  // of a frame that threw
  running_.clear();
  names_.clear();
  marks_ = 0;
  host_.clear();
  mark();
}

void StageTimer::mark() {
  if (marks_ == queries_.size()) {
    queries_.push_back(0);
    context_.gl().CreateQueries(GL_TIMESTAMP, 1, &queries_.back());
    ++context_.traffic().allocations;
  }
  context_.gl().QueryCounter(queries_[marks_++], GL_TIMESTAMP);
  host_.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count());
}

void StageTimer::begin(const std::string& name) {
  const Use use(context_);
  end();
  running_ = name;
  context_.begin_group(name);
}

// Time before the first begin() belongs to no stage and is added to the first one.
void StageTimer::end() {
  if (running_.empty()) return;
  context_.end_group();
  mark();
  names_.push_back(running_);
  running_.clear();
}

void StageTimer::stage(const std::string& name) {
  const Use use(context_);
  mark();
  names_.push_back(name);
}

std::vector<scene::StageTime> StageTimer::times() {
  const Use use(context_);
  end();
  context_.wait();
  std::vector<double> at;
  GLuint64 first = 0, now = 0;
  for (std::size_t i = 0; i < marks_; ++i) {
    context_.gl().GetQueryObjectui64v(queries_[i], GL_QUERY_RESULT, &now);
    if (i == 0) first = now;
    at.push_back(1e-9 * double(now - first));
  }
  context_.check("reading timestamps");
  return by_stage(at);
}

std::vector<scene::StageTime> StageTimer::host_times() const { return by_stage(host_); }

std::vector<scene::StageTime> StageTimer::by_stage(const std::vector<double>& at) const {
  std::vector<scene::StageTime> result;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const double seconds = at[i + 1] - at[i];
    const auto same = std::find_if(result.begin(), result.end(), [&](const auto& t) { return t.name == names_[i]; });
    if (same == result.end())
      result.push_back({names_[i], seconds});
    else
      same->seconds += seconds;
  }
  return result;
}

}  // namespace airlight::gpu
