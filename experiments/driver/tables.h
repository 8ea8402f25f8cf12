// Files of a run in results/<group>/<name>/: table.csv (all figures), summary.csv and table.md (for people), run.json
// (the record). They are written whole or not at all. experiments/README.md describes them.
#pragma once
#include <map>
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
std::string table_markdown(const Outcome&, const std::vector<PlotFile>&);
// All of them by name, with stages.csv (time of every stage), expected.csv (printed and measured), speed_up.csv where the
// experiment asks for them.
std::map<std::string, std::string> table_files(const Outcome&, const std::vector<PlotFile>&);
std::string run_record(const Outcome&, const std::vector<PlotFile>&);

// A field of a CSV file, quoted where it must be.
std::string csv_field(const std::string&);

}  // namespace airlight::experiments
