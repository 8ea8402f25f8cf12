// Where the project's own folders are: experiments/ is read, results/ is written.
#pragma once
#include <filesystem>
#include <string>

namespace airlight::experiments {

// Folders that a run of experiments reads and writes. A path alone stands for a project with its default folders.
struct Folders {
  // Empty: root/results, root/results/cache.
  Folders(std::filesystem::path root, std::filesystem::path results = {}, std::filesystem::path cache = {});

  std::filesystem::path root;     // experiments/ below it is read
  std::filesystem::path results;  // tables, plots, records; pictures in images/
  std::filesystem::path cache;    // references, sequences, samples: shared by all results folders
  std::filesystem::path
      rows;  // finished rows, for those who resume: each results folder has its own, as it has its pictures

  bool default_results() const;  // root/results
};

// The given folder; else the nearest folder above the current one, else above the program, that holds
// experiments/README.md. Throws Error if there is none.
std::filesystem::path project_root(const std::string& given);

// Makes the folder and those above it, where they are missing. Throws scene::CannotWrite.
void make_folder(const std::filesystem::path&);

// Throws scene::CannotWrite, which ends with the remedy, if the folder is there and cannot be written to, or cannot be made.
// Writes nothing.
void check_writable(const std::filesystem::path& folder, const std::string& remedy);

}  // namespace airlight::experiments
