#include "experiments/driver/left_out.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace airlight::experiments {
namespace {

// A stage that is left out although the scene has what it computes: what the picture lacks then.
struct Lack {
  const char* stage;
  const char* reason;  // how its reason begins where it is lacking
  const char* text;
};
constexpr Lack lacks[] = {
    {"light_maps", "self_shadow = none", "the shadow of media on themselves"},
    {"shadows of surfaces in the medium", "the method does not know", "shadows of surfaces in media"},
    {"media_outside_range", "", "media outside its range"}};

}  // namespace

std::string left_out(const std::vector<scene::Stage>& stages) {
  std::vector<std::string> lacking;
  const bool all_orders = std::any_of(stages.begin(), stages.end(), [](const scene::Stage& stage) {
    return stage.kept && stage.name == "multiple scattering";
  });
  if (!all_orders) lacking.emplace_back("orders of scattering above one");
  for (const scene::Stage& stage : stages)
    for (const Lack& lack : lacks)
      if (!stage.kept && stage.name == lack.stage && stage.reason.starts_with(lack.reason))
        lacking.emplace_back(lack.text);
  return fmt::format("{}", fmt::join(lacking, ", "));
}

}  // namespace airlight::experiments
