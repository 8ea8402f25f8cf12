// Changes to a parsed TOML table before it is interpreted: "medium.0.sigma_t" -> "[1, 2, 4]".
#pragma once
#include <toml++/toml.h>

#include <map>
#include <string>

namespace airlight::scene::load {

// Sets the value at each dotted path (keys, and indices of lists from 0 or `*` for all) to the value that its TOML text
// stands for. The last part may be a key that is not there yet; everything before it must be there, except for the
// tables named in `implied`, which are created. Throws Error, beginning "override PATH = TEXT of FILE:", for a text
// that is no TOML value or a path that leads nowhere. Values keep that beginning as their source: location() prints it
// for later errors.
void apply_overrides(toml::table&, const std::map<std::string, std::string>& overrides, const std::string& file,
                     const std::vector<std::string>& implied = {});

// Is this source path one that apply_overrides gave to its values?
bool is_override(const std::string& source_path);

}  // namespace airlight::scene::load
