// Files of samples whose checksum is right and whose content is not: somebody's own, or made to do harm.
#include <catch2/catch.hpp>

#include "reference/path_tracer/accumulation.h"
#include "scene/base/error.h"
#include "tests/temporary_folder.h"

namespace range_file_test {

using namespace airlight;
using namespace airlight::path_tracer;

TEST_CASE("sample files that cannot be are refused before they are believed", "[path_tracer]") {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "made.samples";
  Accumulation good;
  good.width = good.height = 1;
  good.layout = {1, false};
  TallyNode node;
  node.count = 64;
  node.sums.assign(std::size_t(good.layout.doubles()), 1.0);
  good.tiles = {{node}};
  write_range_file(path, good);
  CHECK(read_range_file(path).least_samples() == 64);

  const auto refused = [&](const Accumulation& a, const char* what) {
    write_range_file(path, a);
    CHECK_THROWS_WITH(read_range_file(path), Catch::Contains(path) && Catch::Contains(what));
  };
  // A film of 2^48 pixels in a file of some hundred bytes: 2^42 tiles.
  Accumulation bad = good;
  bad.width = bad.height = 1 << 24;
  refused(bad, "ends too early");
  const auto with = [&](auto&& change) {
    Accumulation a = good;
    change(a.tiles[0][0]);
    return a;
  };
  const char* malformed = "a block of samples is malformed";
  refused(with([](TallyNode& n) { n.sums.clear(); }), malformed);
  refused(with([](TallyNode& n) { n.sums.push_back(0); }), malformed);
  refused(with([](TallyNode& n) { n.level = 5; }), malformed);
  refused(with([](TallyNode& n) { n.level = 60; }), malformed);
  refused(with([](TallyNode& n) { n.count = 0; }), malformed);
  refused(with([](TallyNode& n) { n.count = 65; }), malformed);
  refused(with([](TallyNode& n) { n.index = std::uint64_t(1) << 60; }), malformed);  // its end lies beyond 2^64
}

}  // namespace range_file_test
