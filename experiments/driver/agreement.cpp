#include "experiments/driver/agreement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/application/probes.h"
#include "experiments/driver/kind.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

constexpr double same_to = 1e-3;           // of the greater figure
constexpr double single_precision = 1e-6;  // below it errors are rounding
constexpr double share_by_chance = 0.05;   // of noisy figures, whose intervals do not touch
constexpr std::size_t most_named = 3;

const Row* find_row(const std::vector<Row>& rows, const Row& like) {
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& r) {
    return r.scene == like.scene && r.method == like.method && r.setting == like.setting;
  });
  return found == rows.end() ? nullptr : &*found;
}

const Measure* find_measure(const Row& row, const std::string& metric) {
  for (const Measure& m : row.measures)
    if (m.name == metric && !std::isnan(m.value)) return &m;
  return nullptr;
}

bool same(double a, double b) {
  const double greater = std::max(std::abs(a), std::abs(b));
  return greater < single_precision || std::abs(a - b) <= same_to * greater;
}

// Does a greater figure mean more time?
bool is_time(const std::string& metric) {
  return has_word(metric, "seconds") || has_word(metric, "ms") || has_word(metric, "ns");
}

class Comparison {
 public:
  Comparison(const IsSpeed& is_speed, const std::vector<Row>& committed) : is_speed_(is_speed) {
    for (const Row& row : committed)
      for (const Measure& m : row.measures) known_.insert(m.name);
  }

  void rows(const Row& ours, const Row& committed) {
    if (ours.unavailable || committed.unavailable || ours.device != committed.device) {
      ++result_.not_comparable;
      return;
    }
    if (ours.runs > 0 && committed.runs > 0) ratio(ours.seconds.value, committed.seconds.value);
    std::vector<std::string> metrics;
    for (const Row* row : {&committed, &ours})
      for (const Measure& m : row->measures)
        if (std::find(metrics.begin(), metrics.end(), m.name) == metrics.end()) metrics.push_back(m.name);
    for (const std::string& metric : metrics)
      if (known_.count(metric)) figure(ours, committed, metric);
  }

  Agreement result() {
    if (ratios_.empty()) return result_;
    std::sort(ratios_.begin(), ratios_.end());
    const auto at = [&](double p) { return ratios_[std::size_t(std::lround(p * double(ratios_.size() - 1)))]; };
    result_.times = Estimate{at(0.5), at(0.1), at(0.9)};
    return result_;
  }

  Agreement result_;

 private:
  void ratio(double ours, double committed) {
    if (ours > 0 && committed > 0) ratios_.push_back(ours / committed);
  }

  void figure(const Row& ours, const Row& committed, const std::string& metric) {
    const Measure *a = find_measure(ours, metric), *b = find_measure(committed, metric);
    if (!a && !b) return;
    if (is_speed_(ours, metric)) {
      if (a && b && is_time(metric)) ratio(a->value, b->value);
      return;
    }
    ++result_.figures;
    constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
    const Difference difference{
        ours.scene, ours.method, ours.setting, metric, a ? a->value : undefined, b ? b->value : undefined};
    if (a && b && (a->low < a->high || b->low < b->high)) {
      ++result_.noisy;
      if (a->low > b->high || b->low > a->high) result_.apart.push_back(difference);
    } else if (!a || !b || !same(a->value, b->value)) {
      result_.differ.push_back(difference);
    }
  }

  const IsSpeed& is_speed_;
  std::set<std::string> known_;  // metrics of the committed table, which may be older than some
  std::vector<double> ratios_;
};

std::string counted(std::size_t n, const std::string& what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

std::string named(const Difference& d) {
  const auto shown = [](double x) { return std::isnan(x) ? std::string("not defined") : fmt::format("{:.4g}", x); };
  std::string row;
  for (const std::string& word : {d.scene, d.method, d.setting})
    if (!word.empty()) row += (row.empty() ? "" : ", ") + word;
  return fmt::format("{} of {}: {}, committed {}", d.metric, row, shown(d.ours), shown(d.committed));
}

std::string some_of(const std::vector<Difference>& all) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < all.size() && i < most_named; ++i) names.push_back(named(all[i]));
  if (all.size() > most_named) names.push_back(fmt::format("and {} more", all.size() - most_named));
  return fmt::format("{}", fmt::join(names, "; "));
}

}  // namespace

bool Agreement::agrees() const {
  return differ.empty() && double(apart.size()) <= std::max(1.0, share_by_chance * double(noisy));
}

Agreement compare_tables(const std::vector<Row>& ours, const std::vector<Row>& committed, const IsSpeed& is_speed) {
  Comparison comparison(is_speed, committed);
  for (const Row& row : ours) {
    if (const Row* other = find_row(committed, row))
      comparison.rows(row, *other);
    else
      ++comparison.result_.rows_here;
  }
  for (const Row& row : committed) comparison.result_.rows_there += !find_row(ours, row);
  return comparison.result();
}

std::string text(const Agreement& a, const std::string& name) {
  std::vector<std::string> parts;
  if (a.figures == 0) parts.push_back(fmt::format("has no figures to compare with {} but times", name));
  const std::size_t wrong = a.differ.size() + a.apart.size();
  const std::string count =
      fmt::format("{} of {}", a.agrees() ? a.figures - wrong : wrong, counted(a.figures, "figure"));
  if (a.figures > 0 && a.agrees()) {
    parts.push_back(fmt::format("agrees with {}: {}", name, count));
    if (!a.apart.empty())
      parts.push_back(fmt::format("{} of {} differ by more than their noise, no more than chance explains",
                                  a.apart.size(), counted(a.noisy, "noisy figure")));
  } else if (a.figures > 0) {
    std::vector<Difference> all = a.differ;
    all.insert(all.end(), a.apart.begin(), a.apart.end());
    parts.push_back(fmt::format("DIFFERS from {}: {} ({})", name, some_of(all), count));
  }
  if (a.rows_here > 0) parts.push_back(counted(a.rows_here, "row") + " only here");
  if (a.rows_there > 0) parts.push_back(counted(a.rows_there, "row") + " only there");
  if (a.not_comparable > 0)
    parts.push_back(counted(a.not_comparable, "row") + " not compared, unavailable here or of another device");
  if (a.times)
    parts.push_back(
        fmt::format("times {:.2g} times as long ({:.2g} to {:.2g})", a.times->value, a.times->low, a.times->high));
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::optional<std::vector<Row>> recorded_rows(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  std::vector<Row> rows;
  try {
    const nlohmann::json record = read_json(file.string());
    for (nlohmann::json row : record.at("rows")) {
      row["times"] = nlohmann::json::array();  // a record leaves them out
      rows.push_back(row_from_json(row));
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("{}: not a record of this version: {}", file.string(), error.what()));
  }
  return rows;
}

std::optional<Agreement> agreement_with(const std::filesystem::path& results, const Outcome& outcome) {
  const Experiment& e = outcome.experiment;
  const auto committed = recorded_rows(results / results_name(e.id, e.profile) / "run.json");
  if (!committed) return std::nullopt;
  return compare_tables(outcome.rows, *committed, [kind = e.kind](const Row& row, const std::string& metric) {
    return kind->is_speed(row, metric);
  });
}

}  // namespace airlight::experiments
