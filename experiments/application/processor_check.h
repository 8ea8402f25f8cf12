// Whether the processor can run this program, which is compiled for x86-64-v3.
#pragma once

namespace airlight {

struct ProcessorFeature {
  const char* name;
  bool active;  // the processor has it, and the operating system lets it be used
};

// The name of the first of `count` features that is not active; null if all are.
const char* missing_feature(const ProcessorFeature* features, int count);

}  // namespace airlight
