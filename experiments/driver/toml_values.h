// Values of an experiment file that a scene file does not have: lists of strings, settings, overrides.
#pragma once
#include <toml++/toml.h>

#include <string>
#include <vector>

#include "experiments/driver/experiment.h"
#include "scene/load/table_reader.h"

namespace airlight::experiments {

// A value as a setting takes it: strings without quotes.
std::string plain(const toml::node&);

// key = ["a", "b"]; empty if it is not there.
std::vector<std::string> strings(const toml::table&, const std::string& key, const scene::load::TableReader&);

// key = { name = value, ... }
Pairs settings(const toml::table&, const std::string& key, const scene::load::TableReader&);

// key = { "path.in.the.scene" = value, ... } or nested tables; values as TOML text.
Pairs overrides(const toml::table&, const std::string& key, const scene::load::TableReader&);

// key = { "path.in.the.scene" = [value, ...] }: the overrides that go with each of n values of a sweep, one list of n for each path.
std::vector<Pairs> overrides_of_each(const toml::table&, const std::string& key, std::size_t n,
                                     const scene::load::TableReader&);

}  // namespace airlight::experiments
