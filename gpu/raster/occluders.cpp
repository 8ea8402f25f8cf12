#include "gpu/raster/occluders.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace airlight::gpu {
namespace {

constexpr int most_in_leaf = 4, bins = 16;

double half_area(const Box& box) {
  const Vec3 s = box.size();
  return s[0] * s[1] + s[1] * s[2] + s[2] * s[0];
}

class Builder {
 public:
  Builder(const std::vector<std::array<Point3, 3>>& triangles, Occluders& out) : triangles_(triangles), out_(out) {
    Box all;
    for (const auto& t : triangles) {
      Box box;
      for (const Point3& p : t) box = unite(box, {p, p});
      boxes_.push_back(box);
      centers_.push_back(box.center());
      all = unite(all, box);
    }
    slack_ = 1e-6 * (all.size().maxCoeff() + all.lo.cwiseAbs().maxCoeff() + all.hi.cwiseAbs().maxCoeff());
    order_.resize(triangles.size());
    std::iota(order_.begin(), order_.end(), 0);
    build(0, int(order_.size()));
  }

 private:
  static std::array<float, 4> corner(const Point3& p, int number = 0) {
    return {float(p[0]), float(p[1]), float(p[2]), std::bit_cast<float>(number)};
  }

  // Where [begin, end) is cut, sorted accordingly: between bins of centres at the least sum of surface times triangles on
  // both sides (Wald 2007, "On fast construction of SAH-based bounding volume hierarchies"); at the median where all
  // centres share a bin.
  int cut(int begin, int end, int& axis) {
    Box centers;
    for (int i = begin; i < end; ++i) {
      const Point3& c = centers_[order_[i]];
      centers = unite(centers, {c, c});
    }
    double least = infinity;
    int best = 0;
    const Vec3 size = centers.size();
    const auto bin_of = [&](int triangle, int a) {
      const double share = (centers_[triangle][a] - centers.lo[a]) / size[a];
      return std::clamp(int(bins * share), 0, bins - 1);
    };
    std::array<std::array<Box, bins>, 3> boxes;
    std::array<std::array<int, bins>, 3> counts{};
    for (int i = begin; i < end; ++i)
      for (int a = 0; a < 3; ++a) {
        if (!(size[a] > 0)) continue;
        const int bin = bin_of(order_[i], a);
        boxes[a][bin] = unite(boxes[a][bin], boxes_[order_[i]]);
        ++counts[a][bin];
      }
    for (int a = 0; a < 3; ++a) {
      if (!(size[a] > 0)) continue;
      const std::array<Box, bins>& box = boxes[a];
      const std::array<int, bins>& count = counts[a];
      std::array<double, bins> below{};
      Box side;
      for (int bin = 0, n = 0; bin + 1 < bins; ++bin) {
        side = unite(side, box[bin]);
        n += count[bin];
        below[bin] = n > 0 ? n * half_area(side) : infinity;
      }
      side = {};
      for (int bin = bins - 1, n = 0; bin > 0; --bin) {
        side = unite(side, box[bin]);
        n += count[bin];
        const double cost = n > 0 ? below[bin - 1] + n * half_area(side) : infinity;
        if (cost < least) least = cost, best = bin, axis = a;
      }
    }
    const auto first = order_.begin() + begin, last = order_.begin() + end;
    if (least < infinity)
      return int(std::partition(first, last, [&](int t) { return bin_of(t, axis) < best; }) - order_.begin());
    size.maxCoeff(&axis);
    const int middle = begin + (end - begin) / 2;
    std::nth_element(first, order_.begin() + middle, last,
                     [&](int a, int b) { return centers_[a][axis] < centers_[b][axis]; });
    return middle;
  }

  void build(int begin, int end) {
    Box box;
    for (int i = begin; i < end; ++i) box = unite(box, boxes_[order_[i]]);
    const std::size_t self = out_.nodes.size();
    OccluderNode node{};
    for (int a = 0; a < 3; ++a) node.lo[a] = float(box.lo[a] - slack_), node.hi[a] = float(box.hi[a] + slack_);
    const bool is_leaf = end - begin <= most_in_leaf;
    if (is_leaf) node.leaf = 8 * begin + (end - begin);
    out_.nodes.push_back(node);
    if (is_leaf) {
      for (int i = begin; i < end; ++i) {
        const auto& c = triangles_[order_[i]];
        out_.triangles.push_back({corner(c[0], order_[i]), corner(c[1]), corner(c[2])});
      }
    } else {
      int axis = 0;
      const int middle = cut(begin, end, axis);
      build(begin, middle);
      out_.nodes[self].leaf = -1 - (4 * int(out_.nodes.size()) + axis);
      build(middle, end);
    }
    out_.nodes[self].behind = int(out_.nodes.size());
  }

  const std::vector<std::array<Point3, 3>>& triangles_;
  Occluders& out_;
  std::vector<Box> boxes_;
  std::vector<Point3> centers_;
  double slack_;
  std::vector<int> order_;
};

}  // namespace

Occluders make_occluders(const std::vector<scene::Surface>& surfaces, const Point3& middle) {
  Occluders occluders;
  std::vector<std::array<Point3, 3>> triangles;
  for (const scene::Surface& surface : surfaces)
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&surface.shape))
      for (const auto& t : mesh->triangles)
        triangles.push_back(
            {mesh->vertices[t[0]] - middle, mesh->vertices[t[1]] - middle, mesh->vertices[t[2]] - middle});
  if (!triangles.empty()) Builder(triangles, occluders);
  return occluders;
}

}  // namespace airlight::gpu
