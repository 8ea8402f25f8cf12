// Everything that measures what is no picture. A new probe joins the list in probes.cpp.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "experiments/probe.h"

namespace airlight::experiments {

const std::vector<std::unique_ptr<Probe>>& all_probes();

// Throws Error, beginning with `where`, that names the nearest probe.
const Probe& find_probe(const std::string& name, const std::string& where);

}  // namespace airlight::experiments
