#include "experiments/verify/oracle_probe.h"

#include <fmt/format.h>

#include <cmath>
#include <ostream>

#include "experiments/verify/check.h"
#include "scene/base/error.h"

namespace airlight::experiments {

std::vector<scene::SettingSpec> OracleProbe::settings() const {
  static const std::vector<std::string> kinds = verification::known_kinds();
  return {scene::choice_setting("kind", kinds.front(), kinds, "of the vectors that are recomputed")};
}

std::vector<std::string> OracleProbe::figures() const {
  return {"worst_share", "worst_relative_error", "vectors", "numbers", "out_of_tolerance", "left_out"};
}

Findings OracleProbe::run(const ProbeInput& input, const scene::Settings& settings, const scene::Execution&) const {
  if (input.file.empty()) throw Error("oracle_vectors needs a [[scene]] whose file holds vectors");
  std::vector<VerifyKind> kinds;
  std::ostream nowhere(nullptr);
  verify({input.file.string()}, settings.text("kind"), input.quick ? VerifyProfile::quick : VerifyProfile::paper,
         nowhere, &kinds);
  const VerifyKind& kind = kinds.at(0);
  Findings found;
  found.figures = {exactly("vectors", kind.vectors), exactly("numbers", kind.numbers),
                   exactly("out_of_tolerance", kind.out), exactly("left_out", kind.left_out)};
  if (kind.numbers > 0) {
    found.figures.push_back(exactly("worst_share", kind.worst_share));
    if (!std::isnan(kind.worst_relative_error))
      found.figures.push_back(exactly("worst_relative_error", kind.worst_relative_error));
    if (!kind.worst.empty()) found.note = "worst: " + kind.worst;
  }
  return found;
}

}  // namespace airlight::experiments
