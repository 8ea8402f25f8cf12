// Settings as they are declared and given: names, values, variables, and what is not read beside the others.
#include "scene/base/settings.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

namespace settings_test {

using namespace airlight::scene;
using Given = std::map<std::string, std::string>;

namespace {

std::vector<SettingSpec> specs() {
  std::vector<SettingSpec> all = {choice_setting("variant", "grid", {"grid", "paper"}, "where light is known"),
                                  integer_setting("cells", "32", 1, 96, "cells of the grid"),
                                  flag_setting("sun", false, "with a sun"),
                                  real_setting("step", "0.5", 0, 1, "of the sun's map"),
                                  real_setting("keep", "1", 0, 1, "share that is kept"),
                                  integer_setting("levels", "3", 0, 9, "of what is kept, or of paper"),
                                  integer_setting("seed", "1", 0, 9, "where a number is 0"),
                                  flag_setting("far", false, "of a grid that is cut, or of a paper under a sun")};
  all[1].where("variant", {"grid"});
  all[3].where("sun", {"true"}).where("variant", {"grid", "paper"});
  all[5].where("variant", {"paper"}).or_where("keep", {"< 1"});
  all[6].where("levels", {"0"});
  all[7].where("keep", {"< 1"}).where("variant", {"grid"}).or_where("sun", {"true"}).where("variant", {"paper"});
  return all;
}

enum class Kind { coarse, fine };
struct Options {
  Kind kind = Kind::fine;
  std::optional<bool> dense;
  bool sun = true;
  int count = 24;
  unsigned seed = 7;
  double small = 1e-4, least = 1e-10, half = 0.5, thousandth = 0.001, great = 1e300, endless = INFINITY;
};
void bind(SettingBinder& b, Options& o) {
  b.choice("kind", o.kind, {{"coarse", Kind::coarse}, {"fine", Kind::fine}}, "a kind");
  b.choice("solver", o.dense, {{"auto", std::nullopt}, {"dense", true}, {"sparse", false}}, "a solver");
  b.flag("sun", o.sun, "with a sun");
  b.integer("count", o.count, 1, 99, "a count").where("sun", {"true"});
  b.integer("seed", o.seed, 0, 99, "a seed");
  b.real("small", o.small, 0, 1, "a number");
  b.real("least", o.least, 0, 1, "a number");
  b.real("half", o.half, 0, 1, "a number");
  b.real("thousandth", o.thousandth, 0, 1, "a number");
  b.real("great", o.great, 0, 1e300, "a number");
  b.real("endless", o.endless, 0, INFINITY, "a number");
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

TEST_CASE("settings are read where one of several alternatives holds", "[settings]") {
  CHECK_NOTHROW(Settings(specs(), {{"levels", "2"}, {"variant", "paper"}}));
  CHECK_NOTHROW(Settings(specs(), {{"levels", "2"}, {"keep", "0.5"}}));
  CHECK_THROWS_WITH(
      Settings(specs(), {{"levels", "2"}, {"keep", "1.0"}}, "fog"),
      "fog: levels = 2 is not read with variant = grid and keep = 1.0, expected variant = paper, or keep < 1");
  CHECK_THROWS_WITH(
      Settings(specs(), {{"far", "true"}, {"variant", "paper"}}, "fog"),
      "fog: far = true is not read with keep = 1 and variant = paper and sun = false, expected keep < 1 and "
      "variant = grid, or sun = true");
  // Numbers are equal as numbers.
  CHECK_NOTHROW(Settings(specs(), {{"seed", "2"}, {"levels", "0"}, {"variant", "paper"}}));
  CHECK_THROWS_WITH(Settings(specs(), {{"seed", "2"}}, "fog"),
                    "fog: seed = 2 is not read with levels = 3, expected levels = 0");
  CHECK(read_condition(specs()[0]).empty());
  CHECK(read_condition(specs()[7]) == "keep < 1 and variant = grid, or sun = true and variant = paper");
}

TEST_CASE("settings that are not read can be left out", "[settings]") {
  const Given all{{"cells", "8"}, {"step", "0.1"}, {"variant", "paper"}, {"unknown", "1"}};
  CHECK(without_unread(specs(), all) == Given{{"variant", "paper"}, {"unknown", "1"}});
}

TEST_CASE("settings of one component among those of another are passed on as given", "[settings]") {
  std::vector<SettingSpec> all = specs();
  all.push_back(integer_setting("frames", "8", 2, 1000, "pictures"));
  const Settings together(all, {{"variant", "paper"}, {"frames", "4"}});
  const auto given = together.given(specs());
  CHECK(given == Given{{"variant", "paper"}});
  CHECK_NOTHROW(Settings(specs(), given));  // the default of cells, which this variant does not read, is not among them
}

TEST_CASE("settings bound to variables have the variables' defaults, and are read into them", "[settings]") {
  const std::vector<SettingSpec> all = list_settings(bind);
  CHECK(Settings(all, {}).canonical() ==
        "kind=fine solver=auto sun=true count=24 seed=7 small=1e-4 least=1e-10 half=0.5 thousandth=0.001 great=1e300 "
        "endless=inf");
  CHECK(all[0].choices == std::vector<std::string>{"coarse", "fine"});
  CHECK(all[3].read_where.size() == 1);
  const Options same = read_settings(bind, Settings(all, {}));
  CHECK((same.kind == Kind::fine && !same.dense && same.count == 24 && same.small == 1e-4 && std::isinf(same.endless)));
  const Options read = read_settings(
      bind, Settings(all, {{"kind", "coarse"}, {"solver", "sparse"}, {"count", "3"}, {"seed", "0"}, {"half", "0.25"}}));
  CHECK((read.kind == Kind::coarse && read.dense == false && read.count == 3 && read.seed == 0 && read.half == 0.25));
  Options others;
  others.count = 16;
  CHECK(list_settings(bind, others)[3].fallback == "16");
}

}  // namespace settings_test
