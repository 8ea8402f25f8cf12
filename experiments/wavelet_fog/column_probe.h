// Error of a voxel grid as a fogmap of its columns.
#pragma once
#include "experiments/application/probe.h"

namespace airlight::experiments {

// Input: a scene whose first medium ends in height.
class ColumnFogmaps : public Probe {
 public:
  std::string name() const override { return "column_fogmap"; }
  std::string about() const override;
  std::vector<scene::SettingSpec> settings() const override;
  std::vector<std::string> figures() const override;
  Findings run(const ProbeInput&, const scene::Settings&, const scene::Execution&) const override;
};

}  // namespace airlight::experiments
