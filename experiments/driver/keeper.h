// Keeps the rows of one run, whoever makes them: finds those that are finished, says which cannot be made, times the
// others in turns, and writes tables, plots and the record.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "experiments/driver/journal.h"
#include "experiments/driver/run.h"
#include "experiments/driver/run_progress.h"
#include "scene/base/content_store.h"
#include "scene/renderer.h"

namespace airlight::experiments {

// A row with its figures. Where `again` is set, the same run once more, it waits for its timed runs; else what it says of
// time is its own.
struct MadeRow {
  Row row;
  double first = 0;                      // [s] of the run that the figures are from
  std::vector<scene::StageTime> stages;  // of that run
  std::optional<double> download = {};   // [s] of a picture that a device made: a stage that the timed runs have not
  std::function<std::vector<scene::StageTime>(const scene::Execution&)> again = {};
};

// A row before it is made: its names and its key. `make` adds the figures, and throws NotSupported, Unavailable or Error.
struct RowPlan {
  Row row;
  std::function<MadeRow(Row, const scene::Execution&)> make;
};

class RowKeeper {
 public:
  // Rows of one scene, planned when it is their turn.
  using Plan = std::function<std::vector<RowPlan>(const SceneCase&)>;

  RowKeeper(Experiment, const RunOptions&);

  const Experiment& experiment() const { return outcome_.experiment; }
  const scene::ContentStore& store() const { return store_; }
  // Below the results folder: where the tables lie, and below its images/ the pictures.
  const std::string& name() const { return name_; }
  std::filesystem::path images() const { return options_.folders.results / "images"; }
  void add_history(Row history) { outcome_.histories.push_back(std::move(history)); }
  // While a scene's reference is computed, or read.
  RunProgress::Step reference_step(const SceneCase&);
  void add(const ReferenceInfo& reference) { outcome_.references.push_back(reference); }

  const std::vector<Row>& rows() const { return outcome_.rows; }  // of the scenes that are finished

  // Runs the plan like run_experiment.
  Outcome run(const Plan&);

 private:
  struct Held;  // a row that was made, and waits for its timed runs
  std::size_t row_count() const;
  double row_work() const;  // [s] as planned, of one row
  // The part of row_work before the timed runs.
  double making_work() const;
  bool has_picture(const Row&) const;
  // The finished row of that plan, when gathering also one of another processor or without times.
  const Row* finished(const Row& plan) const;
  void judge_times();
  void measure(std::vector<RowPlan>);
  void make(RowPlan&, std::size_t place, std::vector<Held>&, std::vector<std::optional<Row>>&);
  void time_group(std::vector<Held>&, std::vector<std::optional<Row>>&);
  void finish(Row, std::optional<Row>& place);
  void say(const Row&, const char* how) const;
  void write() const;

  RunOptions options_;
  std::unique_ptr<RunProgress> own_progress_;
  RunProgress& progress_;
  scene::ContentStore store_;
  std::string name_;
  Journal journal_;
  Outcome outcome_;
  bool made_rows_ = false;            // not all of them were kept
  int planned_ = 0;                   // rows so far
  std::vector<std::string> missing_;  // titles of rows that nobody has finished, when gathering
};

}  // namespace airlight::experiments
