// How far a run of experiments is, and how long the rest will take.
#include "experiments/driver/run_progress.h"

#include <catch2/catch.hpp>
#include <chrono>

#include "experiments/application/progress.h"
#include "tests/temporary_folder.h"

using namespace airlight::experiments;
using Catch::Contains;

namespace {

// Content of an open file.
std::string written(std::FILE* file) {
  std::fflush(file);
  std::string text(4096, '\0');
  std::rewind(file);
  text.resize(std::fread(text.data(), 1, text.size(), file));
  return text;
}

struct File {
  std::FILE* file = std::tmpfile();
  ~File() { std::fclose(file); }
};

PlannedWork work(const std::string& name, double rows, const std::map<std::string, double>& references = {}) {
  return {name, rows, references};
}

// Waits until the file holds the text; false after ten seconds.
bool comes(std::FILE* file, const std::string& text) {
  for (int i = 0; i < 200; ++i) {
    if (written(file).find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

}  // namespace

TEST_CASE("the time left is the work left times how slow this machine is", "[progress]") {
  TimeLeft time(1000);
  CHECK(time.left(0, 0, 0) == 1000);  // nothing is measured: as there
  time.done(90, 190);
  CHECK(time.left(0, 0, 0) == Approx(910 * 2.0));  // (190 + 10) / (90 + 10)
  // Time of the work under way: the planned rest, or from a tenth on an extrapolation from the share that is done.
  CHECK(time.left(10, 0, 5) == Approx(900 * 2.0 + 15));
  CHECK(time.left(10, 0, 500) == Approx(900 * 2.0));
  CHECK(time.left(10, 0.25, 30) == Approx(900 * 2.0 + 90));
}

TEST_CASE("what is kept neither takes time nor says how slow the machine is", "[progress]") {
  TimeLeft time(1000);
  for (int i = 0; i < 99; ++i) time.spared(10);
  CHECK(time.left(0, 0, 0) == Approx(10));
  time.done(5, 5);
  CHECK(time.left(0, 0, 0) == Approx(5));
  time.spared(500);  // more than there was
  CHECK(time.left(0, 0, 0) == 0);
  // One quick row, or a piece of which no record tells, decides nothing.
  TimeLeft other(1000);
  other.done(1, 0);
  CHECK(other.left(0, 0, 0) > 900);
  other.done(0, 1e6);
  CHECK(other.left(0, 0, 0) < 1000);
}

TEST_CASE("time left in words", "[progress]") {
  CHECK(time_left_text(0) == "a few seconds left");
  CHECK(time_left_text(38) == "about 40 s left");
  CHECK(time_left_text(1290) == "about 22 min left");
  CHECK(time_left_text(7500) == "about 2 h 05 min left");
}

TEST_CASE("work is planned from the records, and a shared reference counted once", "[progress]") {
  const airlight::TemporaryFolder folder;
  const auto record = [&](const std::string& id, const std::string& seconds, const std::string& cached,
                          const std::string& committed = "") {
    folder.write(id + "/run.json", R"({"seconds": )" + seconds +
                                       R"(, "references": [{"scene": "s", "key": "k", "seconds": 4, "from_cache": )" +
                                       cached + R"(, "committed": ")" + committed + R"("}]})");
  };
  record("g/a", "10", "false");
  record("g/b", "20", "true");
  folder.write("g/damaged/run.json", "{");
  std::vector<Experiment> experiments(4);
  const char* names[] = {"g/a", "g/b", "g/damaged", "g/none"};
  for (int i = 0; i < 4; ++i) experiments[i].id = names[i], experiments[i].profile = "quick";
  const auto planned = planned_work(experiments, folder.path());
  REQUIRE(planned.size() == 4);
  CHECK(planned[0].name == "g/a (quick)");
  CHECK(planned[0].rows == 6);
  CHECK(planned[0].references == std::map<std::string, double>{{"s", 4}});
  CHECK(planned[1].total() == 20);  // its reference is that of g/a
  CHECK(planned[2].total() == 15);  // the mean of the known
  CHECK(planned[3].total() == 15);
  CHECK(planned_work({experiments[3]}, folder.path())[0].total() > 0);
  // A committed film is read in no time: the seconds of its making count neither in its own record nor in one that computed it.
  record("g/none", "3", "false", "references/k.exr");
  CHECK(planned_work({experiments[3]}, folder.path())[0].total() == 3);
  experiments[0].reference.committed = "references";
  CHECK(planned_work({experiments[0]}, folder.path())[0].total() == 6);
}

TEST_CASE("a run says where it is and how long all of it will take", "[progress]") {
  RunProgress progress({work("a (quick)", 100, {{"s", 20}}), work("b (quick)", 600)}, {nullptr, nullptr});
  progress.begin(0);
  CHECK(progress.line() == "[1 of 2] a (quick): 0 %; about 12 min left");
  progress.spare(50);
  CHECK(progress.line() == "[1 of 2] a (quick): 42 %; about 11 min left");
  {
    RunProgress::Step step(progress, "reference of s", progress.work_of_reference("s"));
    step.update(0.5);
    CHECK(progress.line() == "[1 of 2] a (quick): reference of s, 50 %; about 11 min left");
    step.spare();
  }
  CHECK_THAT(progress.line(), Contains("58 %"));
  CHECK(progress.work_of_reference("t") == 0);
  progress.begin(1);  // of the first nothing is left to do
  CHECK(progress.line() == "[2 of 2] b (quick): 0 %; about 10 min left");
  progress.spare(1e9);
  CHECK(progress.line() == "[2 of 2] b (quick): 100 %; a few seconds left");
}

TEST_CASE("without a terminal progress is lines, with one a line that is written over", "[progress]") {
  File lines, terminal;
  {
    RunProgress progress({work("a (quick)", 100)}, {nullptr, lines.file, true, 0.01});
    progress.begin(0);
    CHECK(written(lines.file) == "[1 of 1] a (quick): about 2 min left\n");
    const RunProgress::Step step(progress, "S on s", 50);
    CHECK(comes(lines.file, "\n[1 of 1] a (quick): S on s, 0 %; about 2 min left\n"));
  }
  {
    RunProgress progress({work("a (quick)", 100)}, {terminal.file, nullptr});
    progress.begin(0);
    CHECK(comes(terminal.file, "\r\033[K[1 of 1] a (quick): 0 %; about 2 min left"));
    const std::string before = written(terminal.file);
    const ProgressHidden hidden;
    CHECK_THAT(written(terminal.file), Catch::StartsWith(before) && Catch::EndsWith("\r\033[K"));
  }
  CHECK_THAT(written(terminal.file), !Contains("\n"));
}
