// Common parts of probes of single stages: a box of noise, its threads, and how often a stage is timed.
#pragma once
#include <tbb/task_arena.h>

#include "reference/stable_fluids/obstacles.h"
#include "scene/base/stopwatch.h"
#include "scene/base/threads.h"
#include "scene/math/random.h"
#include "scene/renderer.h"

namespace airlight::experiments {

inline scene::FlowProblem unit_cube(scene::Side::Kind sides) {
  scene::FlowProblem problem;
  for (auto& axis : problem.sides)
    for (scene::Side& side : axis) side.kind = sides;
  return problem;
}

// Independent uniform numbers in (-1, 1), the same for the same place in the field.
template <class Real>
stable_fluids::Field<Real> noise_field(const stable_fluids::Lattice& l, int axis) {
  stable_fluids::Field<Real> f(l, axis);
  stable_fluids::for_rows(f.n, [&](int j, int k) {
    for (int i = 0; i < f.n[0]; ++i) {
      const PhiloxCounter at{std::uint32_t(i), std::uint32_t(j), std::uint32_t(k), std::uint32_t(axis + 1)};
      f.at(i, j, k) = Real(2 * uniform32(philox4x32_10(at, {1, 0})[0]) - 1);
    }
  });
  return f;
}

// body() with as many threads as the execution gives.
template <class Body>
void with_threads(const scene::Execution& execution, const Body& body) {
  tbb::task_arena arena(scene::threads_for(execution.threads));
  arena.execute(body);
}

// round() again and again: `runs` times, or fewer where they take more than `seconds`, but once at least.
template <class Round>
void repeat(int runs, double seconds, const Round& round) {
  double spent = 0;
  scene::Stopwatch watch;
  for (int i = 0; i < runs && (i == 0 || spent < seconds); ++i) {
    round();
    spent += watch.lap();
  }
}

}  // namespace airlight::experiments
