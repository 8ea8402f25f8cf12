// Everything that measures what is no picture. A new probe joins the list in all_probes.cpp.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "experiments/application/probe.h"

namespace airlight::experiments {

// In the program `airlight` it throws NeedsStudies (studies.h).
const std::vector<std::unique_ptr<Probe>>& all_probes();

// Is it one of the words of a figure's name, as ms is of hash_ms?
bool has_word(const std::string& name, const std::string& word);

// Does the figure depend on how fast the machine is: one of speeds(), or named after s, ms or ns?
bool is_speed(const Probe&, const std::string& figure);

// Throws Error, beginning with `where`, that names the nearest probe.
const Probe& find_probe(const std::string& name, const std::string& where);

}  // namespace airlight::experiments
