// What a run leaves in results/<group>/<name>/: table.csv (all figures), summary.csv and table.md (for people),
// run.json (the record). Written whole or not at all. experiments/README.md describes them.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/driver/outcome.h"

namespace airlight::experiments {

struct PlotFile {
  std::string file;  // SVG, relative to the experiment's folder in results
  std::string title;
};

std::string table_csv(const Outcome&);
std::string summary_csv(const Outcome&);
std::string stages_csv(const Outcome&);    // time of every stage; empty without `stages`
std::string expected_csv(const Outcome&);  // printed and measured; empty without [[expected]]
std::string speed_up_csv(const Outcome&);  // empty without [[speed_up]]
// `table` replaces the table of rows if it is not empty.
std::string table_markdown(const Outcome&, const std::vector<PlotFile>&, const std::string& table = "");
std::string run_record(const Outcome&, const std::vector<PlotFile>&);

// A field of a CSV file, quoted where it must be.
std::string csv_field(const std::string&);

}  // namespace airlight::experiments
