// How many threads a computation gets.
#pragma once
#include <tbb/info.h>

#include <algorithm>

namespace airlight::scene {

// Number of threads to use: 0 asks for all, and no more than the machine has are used. With more than that, TBB would
// give none of them and print a warning on standard error.
inline int threads_for(int asked) {
  const int all = tbb::info::default_concurrency();
  return asked > 0 ? std::min(asked, all) : all;
}

}  // namespace airlight::scene
