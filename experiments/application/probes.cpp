#include "experiments/application/probes.h"

#include <algorithm>

#include "experiments/application/find_component.h"

namespace airlight::experiments {

bool has_word(const std::string& name, const std::string& word) {
  return ("_" + name + "_").find("_" + word + "_") != std::string::npos;
}

bool is_speed(const Probe& probe, const std::string& figure) {
  for (const char* unit : {"seconds", "ms", "ns", "second"})
    if (has_word(figure, unit)) return true;
  const auto speeds = probe.speeds();
  return std::find(speeds.begin(), speeds.end(), figure) != speeds.end();
}

const Probe& find_probe(const std::string& name, const std::string& where) {
  return find_component(all_probes(), "probe", name, where);
}

}  // namespace airlight::experiments
