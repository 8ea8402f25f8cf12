// Disks that are full and folders that take no files, in the middle of a simulation: told in a line, and gone on with.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "scene/media/start_grids.h"
#include "tests/experiments/rising_smoke.h"

namespace simulation_disk_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;
using Catch::StartsWith;

namespace {

// A line, no half of a file, and no frame that differs from that of the run that had the space.
void check_stopped(const airlight::test::Result& result, const TemporaryFolder& folder, const std::string& why) {
  INFO(result.err);
  CHECK(result.code == 2);
  CHECK(result.error_lines() == 1);
  CHECK_THAT(result.err, StartsWith("airlight: broken/") && Contains("cannot write: " + why));
  const auto whole = files_of(folder.path() / "whole");
  for (const auto& [name, bytes] : files_of(folder.path() / "broken")) {
    INFO(name);
    REQUIRE(whole.contains(name));
    if (name.ends_with(".vdb")) CHECK(bytes == whole.at(name));
  }
}

// Commands in a namespace of mounts of their own; false where the system does not let us.
bool can_mount(const TemporaryFolder& folder) {
  return run_command("unshare -m sh -c 'mkdir -p disk && mount -t tmpfs none disk'", folder).code == 0;
}

}  // namespace

TEST_CASE("a simulation whose files grow too long stops with a line, and goes on with the same bits", "[simulation]") {
  const TemporaryFolder folder;
  folder.write("smoke.toml", rising_smoke);
  REQUIRE(run_command(simulate_smoke + "whole", folder).code == 0);
  // In KiB: no frame, frames of little smoke, all frames and no state.
  const auto size = [&](const char* name) {
    return int(std::filesystem::file_size(folder.path() / "whole" / name) / 1024);
  };
  const int first = size("smoke.0000.vdb"), last = size("smoke.0010.vdb"), state = size("state");
  REQUIRE(first < last);
  REQUIRE(last < state);
  for (const int most : {first / 2, (last + state) / 2}) {
    // A shell counts in blocks of 512 bytes.
    const auto result =
        run_command(fmt::format("trap '' XFSZ && ulimit -f {} && {}broken", 2 * most, simulate_smoke), folder);
    check_stopped(result, folder, "File too large");
    CHECK(files_of(folder.path() / "broken").contains("smoke.0000.vdb") == (most > first));
  }
  REQUIRE(run_command(simulate_smoke + "broken", folder).code == 0);
  CHECK(files_of(folder.path() / "broken") == files_of(folder.path() / "whole"));
}

TEST_CASE("a simulation on a disk that fills up stops with a line, and goes on with the same bits",
          "[simulation][skips]") {
  const TemporaryFolder folder;
  if (!can_mount(folder)) {
    WARN("test skipped: no file system can be mounted here");
    return;
  }
  folder.write("smoke.toml", rising_smoke);
  REQUIRE(run_command(simulate_smoke + "whole", folder).code == 0);
  std::uintmax_t all = 0;
  for (const auto& [name, bytes] : files_of(folder.path() / "whole")) all += bytes.size();
  // A simulation that was stopped by a full disk continues where there is space.
  for (const int percent : {3, 40, 60, 80}) {
    INFO(percent << " % of the space");
    const auto result = run_command(
        fmt::format("unshare -m sh -c 'mkdir -p broken copy && mount -t tmpfs -o size={}k none broken && {}broken; "
                    "code=$?; cp broken/* copy; exit $code'",
                    all * percent / 100 / 1024,
                    "\"" + airlight::test::program + "\" simulate smoke.toml --set n=24 --out "),
        folder);
    std::filesystem::remove_all(folder.path() / "broken");
    std::filesystem::rename(folder.path() / "copy", folder.path() / "broken");
    check_stopped(result, folder, "No space left on device");
    const auto resumed = run_command(simulate_smoke + "broken", folder);
    CHECK(resumed.code == 0);
    if (percent >= 40) CHECK_THAT(resumed.out, !Contains(" 0 of them from an earlier run"));
    CHECK(files_of(folder.path() / "broken") == files_of(folder.path() / "whole"));
    std::filesystem::remove_all(folder.path() / "broken");
  }
}

TEST_CASE("a simulation into a folder that takes no files stops with a line", "[simulation][skips]") {
  const TemporaryFolder folder;
  folder.write("smoke.toml", rising_smoke);
  REQUIRE(run_command(simulate_smoke + "whole", folder).code == 0);
  std::filesystem::create_directory(folder.path() / "broken");
  if (geteuid() != 0) {
    std::filesystem::permissions(folder.path() / "broken", std::filesystem::perms(0555));
    check_stopped(run_command(simulate_smoke + "broken", folder), folder, "Permission denied");
  } else if (can_mount(folder)) {  // root may write anywhere but there
    const std::string command = "\"" + airlight::test::program + "\" simulate smoke.toml --set n=24 --out ";
    check_stopped(run_command("unshare -m sh -c 'mount -t tmpfs -o ro none broken && " + command + "broken'", folder),
                  folder, "Read-only file system");
    const auto below =
        run_command("unshare -m sh -c 'mount -t tmpfs -o ro none broken && " + command + "broken/new'", folder);
    CHECK(below.code == 2);
    CHECK(below.err == "airlight: broken/new: Read-only file system\n");
  } else {
    WARN("test skipped: root may write anywhere, and no file system can be mounted here");
  }
}

}  // namespace simulation_disk_test
