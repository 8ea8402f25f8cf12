// Rows that are finished, kept line by line so that a run that was killed can be resumed.
//
// Every line ends with a checksum; a torn or damaged line counts as not there.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "experiments/driver/row.h"

namespace airlight::experiments {

class Journal {
 public:
  // Reads what is there, or with `resume` false nothing. Writes nothing.
  Journal(const std::filesystem::path& file, bool resume);

  // Removes what is there. Throws scene::CannotWrite.
  void begin_anew();

  // The row of that key, if it was finished.
  const Row* find(const std::string& key) const;

  const std::map<std::string, Row>& rows() const { return rows_; }  // by key

  // Appends and flushes to the disk; makes the folder. Throws scene::CannotWrite.
  void add(const Row&);

 private:
  std::filesystem::path file_;
  std::map<std::string, Row> rows_;
};

}  // namespace airlight::experiments
