#include "scene/geometry/polygon_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace airlight::scene {
namespace {

struct Flat {
  double x, y;
  bool operator==(const Flat&) const = default;
};

// Terms that overlap nowhere, the smallest first: their sum is exact (Shewchuk 1997, GROW-EXPANSION).
class ExactSum {
 public:
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  int sign() const {
    for (int i = count_; i-- > 0;)
      if (terms_[i] != 0) return terms_[i] > 0 ? 1 : -1;
    return 0;
  }

 private:
  void add(double value) {
    for (int i = 0; i < count_; ++i) {
      const double sum = value + terms_[i], part = sum - value;
      terms_[i] = (value - (sum - part)) + (terms_[i] - part);
      value = sum;
    }
    terms_[count_++] = value;
  }
  std::array<double, 12> terms_;
  int count_ = 0;
};

// 1: from p over q to r it turns left; -1: right; 0: the three lie on a line.
int turn(const Flat& p, const Flat& q, const Flat& r) {
  const double left = (q.x - p.x) * (r.y - p.y), right = (q.y - p.y) * (r.x - p.x), difference = left - right;
  // Five roundings.
  if (std::abs(difference) > 4 * std::numeric_limits<double>::epsilon() * (std::abs(left) + std::abs(right)))
    return difference > 0 ? 1 : -1;
  ExactSum sum;
  sum.add_product(q.x, r.y);
  sum.add_product(-q.x, p.y);
  sum.add_product(-p.x, r.y);
  sum.add_product(-q.y, r.x);
  sum.add_product(q.y, p.x);
  sum.add_product(p.y, r.x);
  return sum.sign();
}

class Polygon {
 public:
  explicit Polygon(const std::vector<Point3>& corners)
      : size_(int(corners.size())), left_(size_), before_(size_), after_(size_) {
    // Newell's normal; from the first corner, so that a place far from the origin costs nothing.
    Vec3 normal = Vec3::Zero();
    for (int i = 0; i < size_; ++i)
      normal += Vec3(corners[i] - corners[0]).cross(Vec3(corners[(i + 1) % size_] - corners[0]));
    int axis;
    normal.cwiseAbs().maxCoeff(&axis);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const Point3& c : corners) flat_.push_back({c[u], normal[axis] < 0 ? -c[v] : c[v]});  // turns left as a whole
    for (int i = 0; i < size_; ++i) {
      before_[i] = (i + size_ - 1) % size_;
      after_[i] = (i + 1) % size_;
    }
  }

  std::optional<std::vector<std::array<int, 3>>> cut() {
    int at = 0;
    // Folds first, here and in remove(): an ear at a corner that they touch might lie on the other side.
    for (int tried = 0; tried < left_ && left_ > 3; ++tried) {
      if (is_fold(at)) {
        at = remove(at);
        tried = -1;
      } else {
        at = after_[at];
      }
    }
    for (int tried = 0; left_ > 3;) {
      if (is_ear(at)) {
        at = remove(at);
        tried = 0;
      } else if (++tried <= left_) {
        at = after_[at];
      } else {
        return std::nullopt;
      }
    }
    if (turn_at(at) < 0) return std::nullopt;
    remove(at);
    return std::move(triangles_);
  }

 private:
  int turn_of(int p, int q, int r) const { return turn(flat_[p], flat_[q], flat_[r]); }
  int turn_at(int i) const { return turn_of(before_[i], i, after_[i]); }
  bool same(int i, int j) const { return flat_[i] == flat_[j]; }

  // The edge runs back along itself, or nowhere: nothing is cut off.
  bool is_fold(int i) const {
    const Flat &p = flat_[before_[i]], &q = flat_[i], &r = flat_[after_[i]];
    return turn(p, q, r) == 0 && (p.x - q.x) * (r.x - q.x) + (p.y - q.y) * (r.y - q.y) >= 0;
  }

  // Makes a triangle of the corner and its neighbours; returns where to go on. Not at the next corner: its triangle
  // would be thin.
  int remove(int i) {
    const int a = before_[i], c = after_[i];
    triangles_.push_back({a, i, c});
    after_[a] = c;
    before_[c] = a;
    --left_;
    for (const int j : {a, c})
      if (left_ > 3 && is_fold(j)) return remove(j);
    return after_[c];
  }

  // The diagonal from a to c leaves nothing of the polygon on its other side within the triangle.
  bool is_ear(int b) const {
    const int a = before_[b], c = after_[b];
    if (turn_of(a, b, c) <= 0) return false;
    const auto [low_x, high_x] = std::minmax({flat_[a].x, flat_[b].x, flat_[c].x});
    const auto [low_y, high_y] = std::minmax({flat_[a].y, flat_[b].y, flat_[c].y});
    for (int p = after_[c]; p != a; p = after_[p]) {
      const Flat& f = flat_[p];
      if (f.x < low_x || f.x > high_x || f.y < low_y || f.y > high_y) continue;
      if (same(p, b)) {
        const auto leads_in = [&](int q) { return turn_of(b, c, q) > 0 && turn_of(b, q, a) > 0; };
        if (leads_in(before_[p]) || leads_in(after_[p])) return false;
      } else if (!same(p, a) && !same(p, c) && turn_of(a, b, p) >= 0 && turn_of(b, c, p) >= 0 &&
                 turn_of(c, a, p) >= 0) {
        return false;
      }
    }
    return true;
  }

  int size_, left_;  // corners, and those that no triangle has cut off yet
  std::vector<Flat> flat_;
  std::vector<int> before_, after_;
  std::vector<std::array<int, 3>> triangles_;
};

}  // namespace

std::optional<std::vector<std::array<int, 3>>> cut_polygon(const std::vector<Point3>& corners) {
  if (corners.size() == 3) return std::vector<std::array<int, 3>>{{0, 1, 2}};
  auto triangles = Polygon(corners).cut();
  if (!triangles && corners.size() == 4) return std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}};
  return triangles;
}

}  // namespace airlight::scene
