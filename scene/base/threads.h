// How many threads a computation gets.
#pragma once
#include <tbb/info.h>

#include <algorithm>

namespace airlight::scene {

// As many as asked for, 0 meaning all, but no more than the machine has: TBB would give none of those, and say so on
// standard error.
inline int threads_for(int asked) {
  const int all = tbb::info::default_concurrency();
  return asked > 0 ? std::min(asked, all) : all;
}

}  // namespace airlight::scene
