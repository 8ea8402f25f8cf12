#include "methods/shadow_planes/plane_order.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/base/error.h"

namespace airlight::shadow_planes {
namespace {

constexpr int most_keys = 100'000'000;  // 0.8 GB

}  // namespace

PlaneOrder::PlaneOrder(const ShadowVolumes& shadows, const scene::Camera& camera, int pieces)
    : shadows_(shadows), pieces_(pieces) {
  if (camera.kind != scene::Camera::Kind::perspective) return;
  const double count = double(shadows.edges().size()) * pieces;
  if (count > most_keys)
    throw Error(fmt::format("{:.0f} pieces of shadow planes, expected at most {}: fewer edge_split", count, most_keys));
  const Vec3 to_camera = (camera.position - shadows.light()).normalized();
  keys_.reserve(shadows.edges().size() * std::size_t(pieces));
  for (int edge = 0; edge < int(shadows.edges().size()); ++edge)
    for (int k = 0; k < pieces; ++k) keys_.push_back(key(edge, k, to_camera));
}

double PlaneOrder::key(int edge, int piece, const Vec3& to_camera) const {
  const SilhouetteEdge& e = shadows_.edges()[edge];
  return order_key(e.a + (e.b - e.a) * ((piece + 0.5) / pieces_), to_camera);
}

void PlaneOrder::sort(const Ray& ray, Crossing* begin, Crossing* end) const {
  const auto before = [](const Crossing& a, const Crossing& b) {
    if (a.order != b.order) return a.order < b.order;
    return a.edge != b.edge ? unsigned(a.edge) < unsigned(b.edge) : a.x < b.x;  // spheres, -1, last
  };
  for (Crossing* one = begin; one < end; ++one) {
    if (one->edge < 0) continue;
    const int piece = std::min(int(one->share * pieces_), pieces_ - 1);
    one->order = keys_.empty() ? key(one->edge, piece, (ray.origin - shadows_.light()).normalized())
                               : keys_[one->edge * std::size_t(pieces_) + piece];
  }
  std::sort(begin, end, before);
}

}  // namespace airlight::shadow_planes
