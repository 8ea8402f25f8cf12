#include "experiments/driver/parts.h"

#include <fmt/format.h>

#include <map>

#include "experiments/application/json_value.h"
#include "experiments/driver/agreement.h"
#include "experiments/driver/journal.h"
#include "experiments/driver/run.h"
#include "experiments/driver/tables.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

std::string processor_of(const Row& row) { return row.made_on.substr(0, row.made_on.rfind(" on ")); }

}  // namespace

void take_over_parts(const Folders& folders, const Experiment& e, const std::vector<std::string>& parts) {
  std::map<std::string, std::pair<Row, std::string>> all, by_figures;  // by key, with the folder
  for (const std::string& part : parts) {
    const Journal journal(journal_file({folders.root, part, folders.cache}, e), true);
    if (journal.rows().empty())
      throw Error(fmt::format("{}: no rows of {}; `airlight experiment run {} --rows I/N --journal {}` makes them",
                              part, results_name(e.id, e.profile), e.id, part));
    for (const auto& [key, row] : journal.rows()) {
      all.try_emplace(key, row, part);
      const auto [there, added] = by_figures.try_emplace(row.figures_key, row, part);
      const auto& [other, from] = there->second;
      // Other processors may round otherwise.
      const bool same =
          processor_of(row) == processor_of(other)
              ? to_json(other)["errors"] == to_json(row)["errors"]
              : compare_tables({row}, {other}, [](const Row&, const std::string&) { return false; }).agrees();
      if (!added && !same)
        throw Error(fmt::format("{} and {} contradict each other in row '{} {} {}'", from, part, row.scene, row.method,
                                row.setting));
    }
  }
  const std::string name = results_name(e.id, e.profile);
  for (const std::string& part : parts) {
    const fs::path images = fs::path(part) / "images" / name;
    if (!fs::is_directory(images)) continue;
    make_folder(folders.results / "images" / name);
    fs::copy(images, folders.results / "images" / name,
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }
  Journal journal(journal_file(folders, e), true);
  for (const auto& [key, row] : all)
    if (!journal.find(key)) journal.add(row.first);
}

}  // namespace airlight::experiments
