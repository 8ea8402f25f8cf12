// What the program says of itself to shells (`airlight completion`) and to man (`airlight man`).
#include <catch2/catch.hpp>
#include <sstream>

#include "tests/experiments/run_program.h"

namespace cli_description_test {

using airlight::TemporaryFolder;
using namespace airlight::test;
using Catch::Contains;

namespace {

bool installed(const std::string& tool) {
  return std::system(("command -v " + tool + " >/dev/null 2>&1").c_str()) == 0;
}

}  // namespace

TEST_CASE("completion: bash completes commands, options and methods", "[cli]") {
  const TemporaryFolder folder;
  folder.write("airlight.bash", run("completion bash", folder).out);
  folder.write("try.bash", R"(source ./airlight.bash
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
_airlight
echo "${COMPREPLY[*]}"
)");
  const auto complete = [&](const std::string& words) {
    return run_command("bash try.bash airlight " + words, folder).out;
  };
  CHECK(complete("re") == "render results\n");
  CHECK(complete("experiment r") == "run reference\n");
  CHECK(complete("experiment run --res") == "--results --resume\n");
  CHECK(complete("experiment run headline --thr") == "--threads\n");
  CHECK(complete("render fog.toml --method shadow") == "shadow_planes shadow_planes_gpu\n");
  CHECK(complete("render fog.toml -m deter") == "deterministic\n");
  CHECK(complete("render fog.toml --out f") == "\n");  // bash completes the name of a file
  CHECK(complete("results --method f") == "\n");       // methods of tables are no renderers
}

TEST_CASE("completion: scripts for zsh and fish are valid, and complete", "[cli]") {
  const TemporaryFolder folder;
  folder.write("_airlight", run("completion zsh", folder).out);
  folder.write("airlight.fish", run("completion fish", folder).out);
  CHECK_THAT(airlight::read_bytes(folder.file("_airlight")), Contains("#compdef airlight") && Contains("'*--threads["));
  if (installed("zsh")) CHECK(run_command("zsh -n _airlight", folder).code == 0);
  if (installed("fish"))
    CHECK_THAT(
        run_command("fish --no-config -c 'source airlight.fish; complete -C \"airlight experiment run --res\"'", folder)
            .out,
        Contains("--results\tfolder of tables") && Contains("--resume\t"));
  for (const std::string wrong : {"completion", "completion ksh", "man nothing", "man render --out pages"}) {
    const Result refused = run(wrong, folder);
    CAPTURE(wrong, refused.err);
    CHECK(refused.code == 2);
    CHECK(refused.error_lines() == 1);
    CHECK(refused.out.empty());
  }
}

TEST_CASE("man: every command has a page with its options, which man reads without a warning", "[cli]") {
  const TemporaryFolder folder;
  REQUIRE(run("man --out pages", folder).code == 0);
  const std::string run_page = airlight::read_bytes(folder.file("pages/airlight-experiment-run.1"));
  CHECK(run("man experiment run", folder).out == run_page);
  CHECK_THAT(run_page, Contains(".SH SYNOPSIS\n.B airlight experiment run\n[OPTIONS]\n[NAME ...]\n") &&
                           Contains(".TP\n\\fB\\-\\-cache\\fR \\fIFOLDER\\fR\nfolder of references") &&
                           Contains(".TP\n\\fB\\-\\-resume\\fR\ncontinue an interrupted run"));
  std::istringstream help(run("--help", folder).out);
  int commands = 0;
  for (std::string line; std::getline(help, line);)
    if (line.starts_with("  ") && !line.starts_with("   ") && !line.starts_with("  -")) {
      const std::string name = line.substr(2, line.find(' ', 2) - 2);
      INFO(name);
      CHECK(std::filesystem::exists(folder.path() / "pages" / ("airlight-" + name + ".1")));
      ++commands;
    }
  CHECK(commands > 15);
  if (installed("groff")) {
    const Result read = run_command("groff -man -Tutf8 -ww pages/*.1", folder);
    CHECK(read.code == 0);
    CHECK(read.err.empty());
  }
}

}  // namespace cli_description_test
