#include "gpu/timer.h"

#include <algorithm>

namespace airlight::gpu {

StageTimer::~StageTimer() {
  const Use use(context_);
  context_.gl().DeleteQueries(GLsizei(queries_.size()), queries_.data());
}

void StageTimer::mark() {
  const Use use(context_);
  GLuint query = 0;
  context_.gl().CreateQueries(GL_TIMESTAMP, 1, &query);
  context_.gl().QueryCounter(query, GL_TIMESTAMP);
  queries_.push_back(query);
}

void StageTimer::stage(const std::string& name) {
  mark();
  names_.push_back(name);
}

std::vector<scene::StageTime> StageTimer::times() {
  const Use use(context_);
  std::vector<GLuint64> at;
  for (const GLuint query : queries_) {
    GLuint64 nanoseconds = 0;
    context_.gl().GetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
    at.push_back(nanoseconds);
  }
  context_.check("reading timestamps");
  std::vector<scene::StageTime> result;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const double seconds = 1e-9 * double(at[i + 1] - at[i]);
    const auto same = std::find_if(result.begin(), result.end(), [&](const auto& t) { return t.name == names_[i]; });
    if (same == result.end())
      result.push_back({names_[i], seconds});
    else
      same->seconds += seconds;
  }
  return result;
}

}  // namespace airlight::gpu
