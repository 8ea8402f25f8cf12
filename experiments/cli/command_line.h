// How a command line is read, whatever the command: pairs, and words that are none of its options and commands.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "experiments/cli/commands.h"

namespace airlight::experiments::cli {

// An option key=value, several times; blanks around the "=" do not count. Parsing throws Error for what is no pair.
void add_pairs(CLI::App* command, const std::string& flag, Pairs&, const std::string& doc);

std::vector<std::string> command_names(const CLI::App&);

// Throws Error, with the nearest that there is, for the first word that the chosen command knows nothing of, and where it needs one more.
void refuse_extras(const CLI::App&);

}  // namespace airlight::experiments::cli
