#include "experiments/verify/verify.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>
#include <map>
#include <set>

#include "experiments/application/interrupt.h"
#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/verify/check.h"
#include "gpu/context.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"
#include "scene/base/settings.h"

namespace airlight::experiments {
namespace {

using namespace verification;

struct Vector {
  std::string id, kind;
  Check check;
};

// Everything of a file is read before anything is computed: a malformed last entry is not found after minutes of work.
std::vector<Vector> read_file(const std::string& path) {
  const nlohmann::json json = read_json(path);
  const Value file(json, path);
  const std::string family = family_of(file);
  const Value vectors = file["vectors"];
  std::vector<Vector> vectors_read;
  std::set<std::string> ids;
  std::string unknown;  // the first vector of an unknown kind
  std::size_t unknown_count = 0;
  if (file.has("count") && file["count"].integer() != int(vectors.size()))
    file["count"].complain(fmt::format("{}, the number of vectors", vectors.size()));
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const Value entry = vectors[i];
    const std::string id = entry["id"].text();
    const Value named(entry.json(), fmt::format("{}: vector {} '{}'", path, i, id));
    if (!ids.insert(id).second) named["id"].complain("an id that no other vector has");
    const std::string kind = named["kind"].text();
    const Reader read = find_reader(family, kind);
    if (!read) {
      const std::vector<std::string> kinds = known_kinds(family);
      if (++unknown_count == 1)
        unknown = fmt::format("{}: unknown kind '{}', expected one of {}{}", named.where(), kind,
                              fmt::join(kinds, ", "), scene::nearest_hint(kind, kinds));
      continue;
    }
    vectors_read.push_back({id, kind, read(named)});
  }
  if (unknown_count)
    throw Error(fmt::format("{}; {} of {} vectors are of unknown kinds", unknown, unknown_count, vectors.size()));
  return vectors_read;
}

// Errors of a job are reported with the vector's position.
Outcome computed(const Vector& w, const std::string& path, VerifyProfile profile, VerifyOn on) try {
  if (on == VerifyOn::processor) return w.check.job(profile);
  const gpu::Use use(gpu::Context::get());
  return w.check.on_device(profile);
} catch (const Error& e) {
  throw Error(fmt::format("{}: vector '{}': {}", path, w.id, e.what()), e.exit_code());
}

double relative_error(const Comparison& c) {
  return c.expected == c.got ? 0 : std::abs(c.got - c.expected) / std::abs(c.expected);
}

// Relative to 0 nothing is.
std::string relative_text(const Comparison& c) {
  return c.expected == 0 && c.got != 0 ? "-" : fmt::format("{:.1e}", relative_error(c));
}

// The line of a table for this file and kind, made if it is not there.
VerifyKind& line_of(std::vector<VerifyKind>& table, const std::string& file, const std::string& kind) {
  for (VerifyKind& line : table)
    if (line.file == file && line.kind == kind) return line;
  VerifyKind line;
  line.file = file;
  line.kind = kind;
  return table.emplace_back(line);
}

void count(VerifyKind& line, const std::string& id, const Outcome& outcome) {
  line.vectors += !outcome.comparisons.empty();
  line.left_out += outcome.left_out;
  for (const Comparison& c : outcome.comparisons) {
    ++line.numbers;
    line.out += !c.ok();
    if (c.expected != 0) line.worst_relative_error = std::fmax(line.worst_relative_error, relative_error(c));
    const double share = c.expected == c.got ? 0 : std::abs(c.got - c.expected) / c.tolerance;
    if (!(share <= line.worst_share)) {
      line.worst_share = share;
      line.worst = c.what.empty() ? id : id + " " + c.what;
    }
  }
}

// Results for the vectors of one file, or of all.
struct Totals {
  int vectors = 0, numbers = 0, out = 0, not_yet = 0, left_out = 0;
  void add(const VerifyKind& line) {
    vectors += line.vectors;
    numbers += line.numbers;
    out += line.out;
    not_yet += line.not_yet;
    left_out += line.left_out;
  }
};

std::string text(const Totals& t, VerifyOn on) {
  return fmt::format(
      "{} vectors, {} numbers compared: {} ok, {} out; {} numbers left out by the profile; {} vectors {}", t.vectors,
      t.numbers, t.numbers - t.out, t.out, t.left_out, t.not_yet,
      on == VerifyOn::device ? "that no device code computes" : "that no renderer computes");
}

}  // namespace

int verify(const std::vector<std::string>& files, const std::string& kind, VerifyProfile profile, std::ostream& out,
           std::vector<VerifyKind>* table, VerifyOn on) {
  if (on == VerifyOn::device) out << "device: " << gpu::Context::get().description() << "\n";
  std::vector<std::pair<std::string, std::vector<Vector>>> all;
  std::set<std::string> kinds;
  for (const std::string& path : files) {
    all.push_back({path, read_file(path)});
    for (const Vector& w : all.back().second) kinds.insert(w.kind);
  }
  if (!kind.empty() && !kinds.count(kind))
    throw Error(fmt::format("no vector of kind '{}', expected one of {}{}", kind, fmt::join(kinds, ", "),
                            scene::nearest_hint(kind, {kinds.begin(), kinds.end()})));

  std::vector<VerifyKind> kinds_found;
  std::map<std::string, int> waiting;
  std::vector<std::string> failures;
  for (const auto& [path, vectors] : all) {
    out << path << "\n";
    out << fmt::format("{:<42} {:<32} {:<22} {:>20} {:>20} {:>9}  {:<26} {}\n", "id", "kind", "number", "expected",
                       "got", "rel.err", "tolerance", "");
    for (const Vector& w : vectors) {
      if (!kind.empty() && w.kind != kind) continue;
      VerifyKind& line = line_of(kinds_found, path, w.kind);
      if (!(on == VerifyOn::device ? w.check.on_device : w.check.job)) {
        const std::string& why = on == VerifyOn::device ? w.check.not_on_device : w.check.not_here;
        out << fmt::format("{:<42} {:<32} {}\n", w.id, w.kind, why);
        ++waiting[why];
        ++line.not_yet;
        continue;
      }
      check_interrupted();
      const auto start = std::chrono::steady_clock::now();
      const Outcome outcome = computed(w, path, profile, on);
      line.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      count(line, w.id, outcome);
      for (const Comparison& c : outcome.comparisons) {
        out << fmt::format("{:<42} {:<32} {:<22} {:>20.13g} {:>20.13g} {:>9}  {:<26} {}\n", w.id, w.kind, c.what,
                           c.expected, c.got, relative_text(c), c.tolerance_text, c.ok() ? "ok" : "OUT");
        if (!c.ok()) failures.push_back(w.id + (c.what.empty() ? "" : " " + c.what));
      }
      if (outcome.left_out)
        out << fmt::format("{:<42} {:<32} {} numbers left out: {}\n", w.id, w.kind, outcome.left_out,
                           outcome.left_out_because);
      out.flush();
    }
  }
  for (const auto& [what, count] : waiting) out << fmt::format("{} vectors: {}\n", count, what);
  for (const std::string& f : failures) out << "OUT: " << f << "\n";
  Totals totals;
  for (const VerifyKind& line : kinds_found) totals.add(line);
  for (const auto& [path, vectors] : all) {
    Totals of_file;
    for (const VerifyKind& line : kinds_found)
      if (line.file == path) of_file.add(line);
    out << path << ": " << text(of_file, on) << "\n";
  }
  if (all.size() > 1) out << "all files: " << text(totals, on) << "\n";
  if (totals.numbers == 0) out << "FAILED: no number was compared\n";
  if (table) *table = kinds_found;
  return totals.out || totals.numbers == 0 ? 1 : 0;
}

}  // namespace airlight::experiments
