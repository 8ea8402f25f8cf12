// A component of a list by its name.
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <string>
#include <vector>

#include "scene/base/component.h"
#include "scene/base/error.h"

namespace airlight::experiments {

// Throws Error, beginning with `where`, that says which there are and names the nearest. `what`: "renderer", "probe".
template <class T>
const T& find_component(const std::vector<std::unique_ptr<T>>& all, const char* what, const std::string& name,
                        const std::string& where) {
  std::vector<std::string> names;
  for (const auto& component : all) {
    if (component->name() == name) return *component;
    names.push_back(component->name());
  }
  throw Error(fmt::format("{}: unknown {} '{}', expected one of {} (nearest: {})", where, what, name,
                          fmt::join(names, ", "), scene::nearest(name, names)));
}

}  // namespace airlight::experiments
