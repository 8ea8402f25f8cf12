// The processor's way with numbers too small for a normalised float, for one thread and a while.
#pragma once
#include <xmmintrin.h>

namespace airlight::scene {

// While it lives, this thread takes subnormal numbers as zero, and gives them so: libraries set that for some threads
// of a pool and not for others, and a picture must not depend on which thread made it.
class FlushSubnormals {
 public:
  FlushSubnormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040u); }
  ~FlushSubnormals() { _mm_setcsr(before_); }
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;

 private:
  unsigned before_;
};

}  // namespace airlight::scene
