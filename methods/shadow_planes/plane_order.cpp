#include "methods/shadow_planes/plane_order.h"

#include <algorithm>
#include <numeric>

namespace airlight::shadow_planes {

PlaneOrder::PlaneOrder(const ShadowVolumes& shadows, const scene::Camera& camera, int pieces)
    : shadows_(shadows), pieces_(pieces) {
  const Vec3 to_camera = (camera.position - shadows.light()).normalized();
  const int count = int(shadows.edges().size());
  std::vector<double> middle;
  middle.reserve(count);
  if (camera.kind == scene::Camera::Kind::perspective) keys_.reserve(count * std::size_t(pieces));
  for (int edge = 0; edge < count; ++edge) {
    middle.push_back(order_key(shadows.edges()[edge].a + shadows.edges()[edge].b, to_camera));
    for (int k = 0; k < pieces && keys_.capacity() > 0; ++k) keys_.push_back(key(edge, k, to_camera));
  }
  std::vector<int> sorted(count);
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return middle[a] < middle[b]; });
  rank_.resize(count);
  for (int i = 0; i < count; ++i) rank_[sorted[i]] = i;
}

double PlaneOrder::key(int edge, int piece, const Vec3& to_camera) const {
  const SilhouetteEdge& e = shadows_.edges()[edge];
  return order_key(e.a + (e.b - e.a) * ((piece + 0.5) / pieces_), to_camera);
}

void PlaneOrder::sort(const Ray& ray, Crossing* begin, Crossing* end) const {
  const auto before = [](const Crossing& a, const Crossing& b) {
    return a.order != b.order ? a.order < b.order : unsigned(a.edge) < unsigned(b.edge);  // spheres, -1, last
  };
  for (Crossing* next = begin; next < end; ++next) {
    Crossing one = *next;
    if (one.edge >= 0) {
      const int piece = std::min(int(one.share * pieces_), pieces_ - 1);
      one.order = keys_.empty() ? key(one.edge, piece, (ray.origin - shadows_.light()).normalized())
                                : keys_[one.edge * std::size_t(pieces_) + piece];
    }
    Crossing* place = next;
    for (; place > begin && before(one, place[-1]); --place) *place = place[-1];
    *place = one;
  }
}

void PlaneOrder::sort(std::vector<int>& edges) const {
  std::sort(edges.begin(), edges.end(), [&](int a, int b) { return rank_[a] < rank_[b]; });
}

}  // namespace airlight::shadow_planes
