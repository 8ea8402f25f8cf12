// A row with figures worked by hand.
#pragma once
#include <string>

#include "experiments/driver/outcome.h"

namespace airlight::test {

inline experiments::Row row(const std::string& scene, const std::string& method, const std::string& setting,
                            const experiments::Estimate& error) {
  experiments::Row r;
  r.scene = scene;
  r.method = method;
  r.setting = setting;
  r.runs = 3;
  r.measures = {{"bias", 7, 7, 7, 0, false}, {"rel_l2", error.value, error.low, error.high, 0.25, false}};
  return r;
}

// A row that was not rendered.
inline experiments::Row not_rendered(const std::string& scene, const std::string& method) {
  experiments::Row r = row(scene, method, "", {});
  r.runs = 0;
  r.measures.clear();
  return r;
}

}  // namespace airlight::test
