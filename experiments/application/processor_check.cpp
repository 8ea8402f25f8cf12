// The only file that is compiled for every x86-64 processor (CMakeLists.txt), so nothing here may be a template or inline: the linker
// could take another file's copy of it.
#include "experiments/application/processor_check.h"

#include <stdio.h>
#include <string.h>
#include <sys/platform/x86.h>
#include <unistd.h>

namespace airlight {

const char* missing_feature(const ProcessorFeature* features, int count) {
  for (int i = 0; i < count; ++i)
    if (!features[i].active) return features[i].name;
  return nullptr;
}

}  // namespace airlight

// 101 is the first priority that programs may use: all other initialisers of the program run later.
__attribute__((constructor(101))) static void check_processor() {
  const airlight::ProcessorFeature x86_64_v3[] = {
      {"AVX", bool(CPU_FEATURE_ACTIVE(AVX))},     {"AVX2", bool(CPU_FEATURE_ACTIVE(AVX2))},
      {"FMA", bool(CPU_FEATURE_ACTIVE(FMA))},     {"BMI1", bool(CPU_FEATURE_ACTIVE(BMI1))},
      {"BMI2", bool(CPU_FEATURE_ACTIVE(BMI2))},   {"F16C", bool(CPU_FEATURE_ACTIVE(F16C))},
      {"LZCNT", bool(CPU_FEATURE_ACTIVE(LZCNT))}, {"MOVBE", bool(CPU_FEATURE_ACTIVE(MOVBE))}};
  const char* missing = airlight::missing_feature(x86_64_v3, int(sizeof x86_64_v3 / sizeof *x86_64_v3));
  if (!missing) return;
  char line[200];
  snprintf(line, sizeof line,
           "airlight: this processor lacks %s: expected one of level x86-64-v3 (Intel since Haswell, AMD since "
           "Excavator)\n",
           missing);
  const ssize_t lost = write(2, line, strlen(line));
  (void)lost;
  _exit(3);
}
