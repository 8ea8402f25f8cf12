// From which sources, with which compiler and libraries this program was built.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace airlight::experiments {

std::string version();
std::string commit();        // git commit, "+changes" if the work tree differed
std::string reference_id();  // changes when a source of scene/ or reference/ does
std::string source_id();     // changes when any source of the program does
std::string compiler();      // with build type and flags

// Name and version of each library, as found when the program was configured.
std::vector<std::pair<std::string, std::string>> libraries();

}  // namespace airlight::experiments
