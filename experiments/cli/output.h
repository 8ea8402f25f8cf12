// Names of files to write, judged before the work and not after an hour.
#pragma once
#include <string>

namespace airlight::experiments::cli {

// Throws Error unless the name ends so (".exr") and its folder exists.
void require_output(const std::string& file, const std::string& ending);

}  // namespace airlight::experiments::cli
