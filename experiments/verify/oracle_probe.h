// Oracle vectors of one kind, recomputed (verify.h): numbers, how many are out of tolerance, the worst.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

// Input: a file of vectors. Setting `kind`: which of them.
class OracleProbe : public Probe {
 public:
  std::string name() const override { return "oracle_vectors"; }
  std::string about() const override { return "vectors that were computed independently of this program, recomputed"; }
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
