// The list of kinds.
#include <fmt/format.h>

#include "experiments/choosing/choices.h"
#include "experiments/driver/flows.h"
#include "experiments/driver/images.h"
#include "experiments/driver/numbers.h"
#include "experiments/driver/sequence_images.h"
#include "scene/base/error.h"

namespace airlight::experiments {

const std::vector<const ExperimentKind*>& all_kinds() {
  static const Images images;
  static const Numbers numbers;
  static const Flows flows;
  static const SequenceImages sequence;
  static const Choices choices;
  static const std::vector<const ExperimentKind*> kinds{&images, &numbers, &flows, &sequence, &choices};
  return kinds;
}

const ExperimentKind& find_kind(const std::string& name) {
  for (const ExperimentKind* kind : all_kinds())
    if (kind->name() == name) return *kind;
  throw Error(fmt::format("unknown kind of experiment '{}'", name));
}

}  // namespace airlight::experiments
