// Where the project's own folders are: experiments/ is read, results/ is written.
#pragma once
#include <filesystem>
#include <string>

namespace airlight::experiments {

// The given folder; else the nearest folder above the current one, else above the program, that holds
// experiments/README.md. Throws Error if there is none.
std::filesystem::path project_root(const std::string& given);

// Makes the folder and those above it, where they are missing. Throws Error.
void make_folder(const std::filesystem::path&);

}  // namespace airlight::experiments
