#include "experiments/driver/flows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "experiments/application/build_info.h"
#include "experiments/application/frames.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/machine.h"
#include "experiments/application/solvers.h"
#include "experiments/driver/comparisons.h"
#include "experiments/driver/keeper.h"
#include "experiments/driver/plan.h"
#include "experiments/driver/timing.h"
#include "experiments/judging/flow_metrics.h"
#include "scene/base/atomic_file.h"
#include "scene/base/content_key.h"
#include "scene/base/read_file.h"

namespace airlight::experiments {
namespace {

using ProblemPointer = std::shared_ptr<const scene::FlowProblem>;

// Data shared by all rows of a problem.
struct JudgedFlow {
  ProblemPointer problem;
  std::vector<FlowMetric> metrics;      // in the order of the experiment's
  std::vector<int> frames;              // at which they are taken, one for each
  std::vector<Point3> points;           // empty: nothing looks at samples
  std::map<int, FlowSample> reference;  // by frame
  std::string reference_key;
};

JudgedFlow plan_problem(const Experiment& e, const SceneCase& c) {
  JudgedFlow judged;
  judged.problem = std::make_shared<const scene::FlowProblem>(scene::load_flow(c.file.string(), c.overrides));
  const scene::FlowProblem& problem = *judged.problem;
  const int last = int(std::lround(problem.duration * problem.frame_rate));
  for (const std::string& name : e.metrics) {
    judged.metrics.push_back(parse_flow_metric(name, e.id));
    const double frame = judged.metrics.back().time.value_or(last / problem.frame_rate) * problem.frame_rate;
    if (std::abs(frame - std::round(frame)) > 1e-6 || frame > last + 0.5)
      throw Error(fmt::format("{}: {} of {}: expected the time of a frame, a multiple of {:g} s up to {:g} s", e.id,
                              name, c.name, 1 / problem.frame_rate, last / problem.frame_rate));
    judged.frames.push_back(int(std::lround(frame)));
  }
  if (std::any_of(judged.metrics.begin(), judged.metrics.end(), needs_samples)) judged.points = sample_points(problem);
  return judged;
}

// Frames at which samples are looked at.
std::vector<int> sampled_frames(const JudgedFlow& judged, bool (*looks)(const FlowMetric&)) {
  std::vector<int> frames;
  for (std::size_t i = 0; i < judged.metrics.size(); ++i)
    if (looks(judged.metrics[i])) frames.push_back(judged.frames[i]);
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

struct Solve {
  const scene::Solver& solver;
  scene::Settings settings;
};

// [s]; what looks at frames is not timed.
struct RunTime {
  double start, steps;
};
RunTime run_to(int last, const Solve& solve, const ProblemPointer& problem, const scene::Execution& execution,
               std::unique_ptr<scene::Flow>& flow, const std::function<void(int, const scene::Flow&)>& at_frame) {
  const FrameSteps plan = frame_steps(*problem, solve.solver, solve.settings);
  double since = steady_seconds();
  RunTime time{0, 0};
  const auto pause = [&](int frame) {
    (frame == 0 ? time.start : time.steps) += steady_seconds() - since;
    at_frame(frame, *flow);
    since = steady_seconds();
  };
  flow = solve.solver.start(problem, solve.settings, execution);
  pause(0);
  for (int frame = 1; frame <= last; ++frame) {
    to_next_frame(*flow, plan, [&](double share) {
      if (execution.progress && !execution.progress((frame - 1 + share) / last))
        throw scene::Interrupted("interrupted");
    });
    check_interrupted();
    pause(frame);
  }
  return time;
}

void put(std::string& bytes, const std::vector<double>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
}

FlowSample sample_from(const std::string& bytes, std::size_t index, std::size_t points) {
  const double* at = reinterpret_cast<const double*>(bytes.data()) + index * 5 * points;
  return {{at, at + 3 * points}, {at + 3 * points, at + 4 * points}, {at + 4 * points, at + 5 * points}};
}

Solve reference_of(const Experiment& e) {
  const scene::Solver& solver = find_solver(e.reference.renderer, "reference");
  return {solver, scene::Settings(solver.settings(), e.reference.settings, "reference")};
}

// Its samples, from the store where it was solved before.
void judge_by_reference(RowKeeper& keeper, const SceneCase& c, JudgedFlow& judged) {
  const Experiment& e = keeper.experiment();
  const Solve solve = reference_of(e);
  const std::vector<int> frames = sampled_frames(judged, needs_reference);
  std::vector<std::string> parts{judged.problem->hash, solve.solver.name(), solve.settings.canonical(),
                                 source_id(),          compiler(),          std::to_string(judged.points.size())};
  for (const int frame : frames) parts.push_back(std::to_string(frame));
  judged.reference_key = content_key(parts);
  const std::string name = "references/" + judged.reference_key + ".flow";
  ReferenceInfo info{c.name, judged.reference_key, solve.solver.name(), solve.settings.canonical(), "", 0, true, 0, ""};
  std::string bytes;
  RunProgress::Step step = keeper.reference_step(c);
  if (const auto kept = keeper.store().find(name)) {
    step.spare();
    bytes = scene::read_whole_file(kept->string(), std::size_t(1) << 33);
  } else {
    std::unique_ptr<scene::Flow> flow;
    const RunTime time = run_to(frames.empty() ? 0 : frames.back(), solve, judged.problem,
                                step.execution(e.timing.threads), flow, [&](int frame, const scene::Flow& now) {
                                  if (!std::binary_search(frames.begin(), frames.end(), frame)) return;
                                  const FlowSample s = sample(now, judged.points);
                                  put(bytes, s.velocity);
                                  put(bytes, s.density);
                                  put(bytes, s.temperature);
                                });
    put(bytes, {time.start + time.steps});
    info.cached = false;
    keeper.store().keep(name, [&](const auto& path) { scene::write_file_atomically(path.string(), bytes); });
  }
  for (std::size_t i = 0; i < frames.size(); ++i)
    judged.reference[frames[i]] = sample_from(bytes, i, judged.points.size());
  std::memcpy(&info.seconds, bytes.data() + bytes.size() - sizeof(double), sizeof(double));
  keeper.add(info);
}

std::vector<Point3> mirrored(std::vector<Point3> points, const Box& box, int axis) {
  for (Point3& x : points) x[axis] = box.lo[axis] + box.hi[axis] - x[axis];
  return points;
}

// Takes the figures as the flow passes their frames.
class Witness {
 public:
  Witness(const Experiment& e, const JudgedFlow& judged) : e_(e), judged_(judged) {}

  void at_frame(int frame, const scene::Flow& flow) {
    moment_.totals.push_back(flow.totals());
    for (const auto& [name, value] : history_of(flow.time(), moment_.totals.back())) columns_[name].push_back(value);
    const auto asks = [](const FlowMetric& m) { return m.base == "density.contrast"; };
    if (frame == 0 && std::any_of(judged_.metrics.begin(), judged_.metrics.end(), asks))
      moment_.deviation_at_start = deviation(sample(flow, judged_.points).density);
    if (std::find(judged_.frames.begin(), judged_.frames.end(), frame) == judged_.frames.end()) return;
    look(frame, flow);
    for (std::size_t i = 0; i < judged_.metrics.size(); ++i) {
      if (judged_.frames[i] != frame) continue;
      const double value = flow_figure(judged_.metrics[i].base, moment_);
      figures_.push_back({e_.metrics[i], value, value, value, 0, false});
    }
  }

  // In the order of the experiment's metrics.
  std::vector<Measure> figures() const {
    std::vector<Measure> sorted;
    for (const std::string& name : e_.metrics)
      for (const Measure& m : figures_)
        if (m.name == name) sorted.push_back(m);
    return sorted;
  }
  const Columns& columns() const { return columns_; }

 private:
  void look(int frame, const scene::Flow& flow) {
    moment_.reference = nullptr;
    for (std::size_t i = 0; i < judged_.metrics.size(); ++i) {
      if (judged_.frames[i] != frame || !needs_samples(judged_.metrics[i])) continue;
      moment_.here = sample(flow, judged_.points);
      if (const auto found = judged_.reference.find(frame); found != judged_.reference.end())
        moment_.reference = &found->second;
      if (judged_.metrics[i].base != "density.asymmetry") continue;
      for (int side = 0; side < (judged_.problem->dimensions == 3 ? 2 : 1); ++side)
        moment_.mirrored[side] = sample(flow, mirrored(judged_.points, judged_.problem->box, 2 * side));
    }
  }

  const Experiment& e_;
  const JudgedFlow& judged_;
  FlowMoment moment_;
  std::vector<Measure> figures_;
  Columns columns_;
};

// The figures are those of the first run; the timed ones look at nothing.
MadeRow make_row(const Experiment& e, std::shared_ptr<const JudgedFlow> judged, const Solve& solve, Row row,
                 const scene::Execution& execution) {
  row.device = solve.solver.device();
  Witness witness(e, *judged);
  const int last = int(std::lround(judged->problem->duration * judged->problem->frame_rate));
  std::unique_ptr<scene::Flow> flow;
  const double before = resident_gib();
  RunTime first{0, 0};
  try {
    first = run_to(last, solve, judged->problem, execution, flow,
                   [&](int frame, const scene::Flow& now) { witness.at_frame(frame, now); });
  } catch (const scene::Unstable& error) {
    row.note = fmt::format("unstable: {}", error.what());
  }
  row.measures = witness.figures();
  row.columns = witness.columns();
  if (flow) row.counters = flow->counters();
  if (!row.note.empty()) return {row, 0, {}};
  row.counters["simulated seconds"] = judged->problem->duration;
  row.counters["MiB"] = std::max(0.0, 1024 * (resident_gib() - before));
  // The first start may compile shaders: this time does not count as a step.
  row.prepare_seconds = first.start;
  return {row, first.steps, flow->times(), {}, [judged, solve, last](const scene::Execution& quiet) {
            std::unique_ptr<scene::Flow> again;
            run_to(last, solve, judged->problem, quiet, again, [](int, const scene::Flow&) {});
            return again->times();
          }};
}

}  // namespace

const scene::Component& Flows::find_component(const std::string& name, const std::string& position) const {
  return find_solver(name, position);
}

void Flows::read(const TableReader& top, Experiment& e) const {
  e.stages = top.flag("stages", false);
  e.orders = top.flag("orders", false);
}

void Flows::check_metrics(Experiment& e, const std::string& position) const {
  for (const std::string& metric : e.metrics) parse_flow_metric(metric, position);
}

bool Flows::needs_reference(const std::string& metric, const std::string& position) const {
  return experiments::needs_reference(parse_flow_metric(metric, position));
}

std::vector<std::string> Flows::times() const {
  return {"seconds", "step_seconds", "cell_seconds", "simulated_seconds"};
}

std::vector<RowColumn> Flows::time_columns() const {
  const auto part = [](const char* name) {
    return [name](const Row& row) {
      const auto time = quantity(row, name);
      return time ? duration(time->value) : "";
    };
  };
  return {{"time of the whole", time_text},
          {"of a step", part("step_seconds")},
          {"of a simulated second", part("simulated_seconds")}};
}

std::string Flows::conditions() const {
  return "Errors at 61 samples along the longest side of the box; times: median [ranks] of the whole run's wall clock, what "
         "looks at it left out.";
}

Outcome Flows::run(Experiment experiment, const RunOptions& options) const {
  RowKeeper keeper(std::move(experiment), options);
  return keeper.run([&](const SceneCase& c) {
    const Experiment& e = keeper.experiment();
    const auto judged = std::make_shared<JudgedFlow>(plan_problem(e, c));
    if (!e.reference.renderer.empty()) judge_by_reference(keeper, c, *judged);
    std::vector<RowPlan> rows;
    for (const MethodCase& m : e.methods) {
      if (!is_on(m, c)) continue;
      const scene::Solver& solver = find_solver(m.renderer, m.name);
      const Solve solve{solver, scene::Settings(solver.settings(), m.settings, m.name)};
      Row row = row_of(c, m, solve.settings, judged->problem->hash);
      row.reference_key = judged->reference_key;
      set_keys(e, m, solver, row);
      rows.push_back({row, [&e, judged, solve](Row known, const scene::Execution& execution) {
                        return make_row(e, judged, solve, std::move(known), execution);
                      }});
    }
    return rows;
  });
}

void Flows::check(const Experiment& e, const RunOptions&) const {
  for (const SceneCase& c : e.scenes) {
    const JudgedFlow judged = plan_problem(e, c);
    if (e.reference.renderer.empty()) continue;
    const Solve solve = reference_of(e);
    const auto reasons = solve.solver.supports(*judged.problem, solve.settings);
    if (!reasons.empty())
      throw Error(fmt::format("{}: reference {}: {}", c.name, solve.solver.name(), reasons.front()));
  }
}

}  // namespace airlight::experiments
