// What the machine could do: the arithmetic of the kernels on values in registers, in a loop without memory, culling or
// branches. `airlight rate` holds the renderer against it.
#pragma once
#include "methods/fogshop/kernels.h"

namespace airlight::fogshop {

enum class BareLoop {
  error_function,  // erf(x)
  crossing,        // a Gaussian on a line: m, p^2, exp(-a^2 p^2), erf(a m)
  depth,           // its depth up to a point of the line, added to others: erf(a (t - m)), as `depths_at`
  paper_term,      // its airlight from one light, Eqs. 10 to 13: two erf, two exp, a root, two divisions
};

// Does it `count` times, rounded up to four whole vectors; returns a number that depends on all that was computed.
// Different seeds compute with different numbers.
double bare_loop(BareLoop, Erf, long count, double seed);

}  // namespace airlight::fogshop
