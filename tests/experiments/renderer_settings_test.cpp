// What every renderer's settings must keep.
#include <catch2/catch.hpp>

#include "experiments/application/renderers.h"

namespace renderer_settings_test {

using namespace airlight::scene;

TEST_CASE("settings that others depend on exist and can have the values named", "[settings]") {
  for (const auto& renderer : airlight::experiments::all_renderers()) {
    const std::vector<SettingSpec> all = renderer->settings();
    for (const SettingSpec& spec : all)
      for (const auto& [other, values] : spec.read_where)
        for (const std::string& value : values) {
          std::map<std::string, std::string> given{{other, value}};
          for (const SettingSpec& depended : all)  // what the other one depends on in turn
            if (depended.name == other)
              for (const auto& [before, allowed] : depended.read_where) given.emplace(before, allowed.front());
          CAPTURE(renderer->name(), spec.name, other, value);
          CHECK_NOTHROW(Settings(all, given));
        }
  }
}

}  // namespace renderer_settings_test
