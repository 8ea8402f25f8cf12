// Terms of airlight: all media together, or each medium alone as in the paper.
#pragma once
#include <algorithm>
#include <variant>
#include <vector>

#include "methods/shadow_planes/lit_airlight.h"
#include "methods/shadow_planes/paper_medium.h"

namespace airlight::shadow_planes {

using AirlightTerm = std::variant<LitAirlight, PaperMedium>;

// Their sum is the airlight. bounded = exact: one, of all media; paper: one for each.
inline std::vector<AirlightTerm> airlight_terms(const std::vector<scene::Medium>& media, const Options& options) {
  std::vector<AirlightTerm> result;
  if (options.bounded == Options::Bounded::exact && !media.empty()) result.emplace_back(LitAirlight(media, options));
  if (options.bounded == Options::Bounded::paper)
    for (const scene::Medium& medium : media) {
      if (std::holds_alternative<scene::Unbounded>(medium.region))
        result.emplace_back(LitAirlight({medium}, options));
      else
        result.emplace_back(PaperMedium(medium, options));
    }
  return result;
}

// L [W/m^2/sr] of a point or spot light over a lit part of the ray, which may be infinite.
inline Rgb airlight(const AirlightTerm& term, const scene::Light& light, const Ray& ray, Interval lit) {
  return std::visit([&](const auto& a) { return Rgb(a(light, ray, lit)); }, term);
}

// Where on the ray the term's media are, within `t`; empty if nowhere.
inline Interval extent(const AirlightTerm& term, const Ray& ray, Interval t) {
  return std::visit([&](const auto& a) { return a.extent(ray, t); }, term);
}
inline bool in_air(const std::vector<AirlightTerm>& terms, const Ray& ray, double end) {
  return std::any_of(terms.begin(), terms.end(), [&](const auto& term) {
    return !extent(term, ray, {0, end}).empty();
  });
}

}  // namespace airlight::shadow_planes
