#include "scene/media/same_medium.h"

#include <algorithm>

namespace airlight::scene {
namespace {

bool same(const Gaussian& a, const Gaussian& b) {
  return a.center == b.center && a.width == b.width && a.amplitude == b.amplitude;
}

bool same(const Homogeneous& a, const Homogeneous& b) { return a.density == b.density; }
bool same(const GaussianSum& a, const GaussianSum& b) {
  return a.constant == b.constant && a.cutoff == b.cutoff &&
         std::equal(a.gaussians.begin(), a.gaussians.end(), b.gaussians.begin(), b.gaussians.end(),
                    [](const Gaussian& x, const Gaussian& y) { return same(x, y); });
}
template <class Shared>
bool same(const std::shared_ptr<Shared>& a, const std::shared_ptr<Shared>& b) {
  return a == b;
}

bool same(const Unbounded&, const Unbounded&) { return true; }
bool same(const Box& a, const Box& b) { return a.lo == b.lo && a.hi == b.hi; }
bool same(const Sphere& a, const Sphere& b) { return a.center == b.center && a.radius == b.radius; }
bool same(const Slab& a, const Slab& b) { return a.normal == b.normal && a.lo == b.lo && a.hi == b.hi; }

template <class... Kinds>
bool same(const std::variant<Kinds...>& a, const std::variant<Kinds...>& b) {
  return a.index() == b.index() &&
         std::visit([&](const auto& kind) { return same(kind, std::get<std::decay_t<decltype(kind)>>(b)); }, a);
}

bool same_phase(const PhaseFunction& a, const PhaseFunction& b) {
  const auto *x = std::get_if<HenyeyGreenstein>(&a), *y = std::get_if<HenyeyGreenstein>(&b);
  return a.index() == b.index() && (!x || x->g == y->g);
}

}  // namespace

bool same_medium(const Medium& a, const Medium& b) {
  return same(a.field, b.field) && same(a.region, b.region) && (a.sigma_t == b.sigma_t).all() &&
         (a.albedo == b.albedo).all() && same_phase(a.phase, b.phase);
}

bool same_media(const std::vector<Medium>& a, const std::vector<Medium>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_medium);
}

}  // namespace airlight::scene
