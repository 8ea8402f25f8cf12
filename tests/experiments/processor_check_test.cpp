// Processor features that the program needs and a processor lacks. The C library can be told to hide a feature, as if
// the processor lacked it.
#include "experiments/application/processor_check.h"

#include <catch2/catch.hpp>

#include "tests/experiments/run_program.h"

namespace processor_check_test {

using namespace airlight;
using namespace airlight::test;

TEST_CASE("the first feature that a processor lacks is named", "[cli]") {
  const ProcessorFeature all[] = {{"AVX", true}, {"AVX2", true}},
                         old[] = {{"AVX", true}, {"AVX2", false}, {"FMA", false}};
  CHECK(missing_feature(all, 2) == nullptr);
  CHECK(missing_feature(old, 1) == nullptr);
  CHECK(std::string(missing_feature(old, 3)) == "AVX2");
}

TEST_CASE("a processor that lacks a feature is told in one line", "[cli]") {
  const TemporaryFolder folder;
  for (const std::string feature : {"AVX2", "FMA", "BMI2"})
    for (const std::string arguments : {"--version", "doctor", ""}) {
      CAPTURE(feature, arguments);
      const Result result =
          run_command("GLIBC_TUNABLES=glibc.cpu.hwcaps=-" + feature + " '" + program + "' " + arguments, folder);
      CHECK(result.code == 3);
      CHECK(result.out.empty());
      CHECK(result.err == "airlight: this processor lacks " + feature +
                              ": expected one of level x86-64-v3 (Intel since Haswell, AMD since Excavator)\n");
    }
}

}  // namespace processor_check_test
