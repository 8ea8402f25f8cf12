// Files of a run in results/<group>/<name>/: table.csv (all figures), summary.csv and table.md (for people), run.json
// (the record). They are written whole or not at all. experiments/README.md describes them.
#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "experiments/driver/comparisons.h"

namespace airlight::experiments {

struct PlotFile {
  std::string file;  // SVG, relative to the experiment's folder in results
  std::string title;
};

struct NamedTable {
  std::string file;  // CSV, in the experiment's folder in results
  std::string title;
  TextTable lines;
};

// The tables for people: the rows (summary.csv) and, where the experiment asks for them, stages.csv (time of every stage),
// expected.csv (printed and measured), speed_up.csv and orders.csv.
std::vector<NamedTable> tables(const Outcome&);
std::string table_csv(const Outcome&);
nlohmann::json run_record(const Outcome&, const std::vector<NamedTable>&, const std::vector<PlotFile>&);
// The page of a run: what it shows, its plots and tables, then what they are about, gates and conditions.
std::string table_markdown(const Experiment&, const std::vector<NamedTable>&, const nlohmann::json& record);

// The text of table.csv, table.md and every table, by the name of its file.
std::map<std::string, std::string> table_files(const Outcome&, const std::vector<NamedTable>&,
                                               const nlohmann::json& record);
// The text of these files for an earlier run: rows from its record (run.json), the other tables from their files, since a
// record lacks the times of single runs, and claims from the experiment. Empty where there is no record. Throws Error.
std::map<std::string, std::string> recorded_tables(const Experiment&, const std::filesystem::path& folder);

// A field of a CSV file, quoted where it must be; and the fields of a line. `where` begins the message of an Error.
std::string csv_field(const std::string&);
std::vector<std::string> csv_fields(const std::string& line, const std::string& where);

}  // namespace airlight::experiments
