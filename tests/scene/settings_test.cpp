// Settings as they are declared and given: names, values, and what is not read beside the others.
#include "scene/base/settings.h"

#include <catch2/catch.hpp>

namespace settings_test {

using namespace airlight::scene;

namespace {

std::vector<SettingSpec> specs() {
  return {
      choice_setting("variant", "grid", {"grid", "paper"}, "where light is known"),
      integer_setting("cells", "32", 1, 96, "cells of the grid").where("variant", {"grid"}),
      flag_setting("sun", false, "with a sun"),
      real_setting("step", "0.5", 0, 1, "of the sun's map").where("sun", {"true"}).where("variant", {"grid", "paper"})};
}

}  // namespace

TEST_CASE("settings that nothing reads are refused with what would read them", "[settings]") {
  CHECK(Settings(specs(), {{"cells", "8"}}).integer("cells") == 8);
  CHECK(Settings(specs(), {{"variant", "paper"}}).integer("cells") == 32);  // a default is not asked for
  CHECK_THROWS_WITH(Settings(specs(), {{"cells", "8"}, {"variant", "paper"}}, "compensated"),
                    "compensated: cells = 8 is not read with variant = paper, expected variant = grid");
  CHECK_THROWS_WITH(Settings(specs(), {{"step", "0.1"}}, "fog"),
                    "fog: step = 0.1 is not read with sun = false, expected sun = true");
  CHECK(Settings(specs(), {{"step", "0.1"}, {"sun", "true"}, {"variant", "paper"}}).real("step") == 0.1);
}

TEST_CASE("settings of one component among those of another are passed on as given", "[settings]") {
  std::vector<SettingSpec> all = specs();
  all.push_back(integer_setting("frames", "8", 2, 1000, "pictures"));
  const Settings together(all, {{"variant", "paper"}, {"frames", "4"}});
  const auto given = together.given(specs());
  CHECK(given == std::map<std::string, std::string>{{"variant", "paper"}});
  CHECK_NOTHROW(Settings(specs(), given));  // the default of cells, which this variant does not read, is not among them
}

}  // namespace settings_test
