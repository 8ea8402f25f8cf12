// Rows, their records and their journals, worked by hand.
#include <catch2/catch.hpp>
#include <cmath>

#include "experiments/application/json_value.h"
#include "experiments/driver/journal.h"
#include "experiments/driver/outcome.h"
#include "experiments/driver/tables.h"
#include "tests/experiments/worked_row.h"
#include "tests/temporary_folder.h"

namespace rows_test {

using namespace airlight::experiments;
using airlight::test::row;

TEST_CASE("quantities of a row", "[driver]") {
  Row r = row("s", "m", "2.5", {3, 2, 4});
  r.seconds = {5, 4.5, 6};
  r.prepare_seconds = 0.125;
  r.counters = {{"rays", 12}};
  const auto of = [&](const char* name) { return quantity(r, name); };
  CHECK(of("rel_l2")->value == 3);
  CHECK(of("rel_l2")->low == 2);
  CHECK(of("rel_l2")->high == 4);
  CHECK(of("bias")->value == 7);
  CHECK_FALSE(of("rmse"));
  CHECK(of("seconds")->low == 4.5);
  CHECK(of("seconds")->high == 6);
  CHECK(of("prepare_seconds")->value == 0.125);
  CHECK(of("setting")->value == 2.5);
  CHECK_FALSE(of("parameter"));
  r.parameter = -1;
  CHECK(of("parameter")->value == -1);
  CHECK(of("counter.rays")->value == 12);
  CHECK_FALSE(of("counter.steps"));
  for (const char* word : {"", "2.5x", "S"}) {
    r.setting = word;
    CHECK_FALSE(of("setting"));
  }
  r.runs = 0;
  CHECK_FALSE(of("seconds"));
}

TEST_CASE("every figure of a row survives its record", "[driver]") {
  Row r = row("s", "m", "1", {3, 2, 4});
  r.measures[1].below_floor = true;
  r.seconds = {5, 4.5, 6};
  r.coverage = 0.96;
  r.mad = 0.25;
  r.prepare_seconds = 0.125;
  const Row back = row_from_json(nlohmann::json::parse(to_json(r).dump()));
  CHECK(back.measures[1].value == 3);
  CHECK(back.measures[1].low == 2);
  CHECK(back.measures[1].high == 4);
  CHECK(back.measures[1].floor == 0.25);
  CHECK(back.measures[1].below_floor);
  CHECK_FALSE(back.measures[0].below_floor);
  CHECK(back.seconds.value == 5);
  CHECK(back.seconds.low == 4.5);
  CHECK(back.seconds.high == 6);
  CHECK(back.coverage == 0.96);
  CHECK(back.mad == 0.25);
  CHECK(back.prepare_seconds == 0.125);
  CHECK(back.runs == 3);
}

TEST_CASE("rows survive their record", "[driver]") {
  Row r = row("s, with \"quotes\"", "m", "", {0.1, 0.05, 0.2});
  r.parameter = 0.3;
  r.seconds = {1, 0.5, 2};
  r.counters = {{"rays", 12}};
  r.width = 100;
  r.height = 75;
  r.stages = {{"slices", 0.25}};
  r.times = {0.5, 1, 2};
  r.group = "together";
  r.waited = 0.25;
  r.device = "somewhere";
  r.measures.push_back({"p95", std::nan(""), std::nan(""), std::nan(""), 0, false});
  const Row back = row_from_json(nlohmann::json::parse(to_json(r).dump()));
  CHECK(to_json(back).dump() == to_json(r).dump());
  CHECK(std::isnan(back.measures.back().value));
  CHECK(csv_field(r.scene) == "\"s, with \"\"quotes\"\"\"");
}

// A journal keeps what it was given, whatever was torn before it; a changed character takes one line only.
TEST_CASE("journals forget damaged lines alone", "[driver]") {
  const airlight::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "rows.jsonl";
  Row a = row("s", "a", "", {1, 1, 1}), b = row("s", "b", "", {2, 2, 2});
  a.key = "key a";
  b.key = "key b";
  {
    Journal journal(file, true);
    journal.add(a);
    journal.add(b);
    REQUIRE(journal.find("key a"));
  }
  CHECK(Journal(file, true).find("key b")->method == "b");
  CHECK_FALSE(Journal(file, true).find("key c"));
  std::string text = airlight::read_bytes(file.string());
  const std::size_t at = text.find("\"method\":\"a\"");
  REQUIRE(at != std::string::npos);
  text[at + 10] = 'x';
  std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
  const Journal damaged(file, true);
  CHECK_FALSE(damaged.find("key a"));
  CHECK(damaged.find("key b"));
  Journal anew(file, false);
  CHECK_FALSE(anew.find("key b"));
  anew.begin_anew();
  CHECK_FALSE(Journal(file, true).find("key b"));
  anew.add(a);
  CHECK_FALSE(Journal(file, true).find("key b"));
  CHECK(Journal(file, true).find("key a"));
}

}  // namespace rows_test
