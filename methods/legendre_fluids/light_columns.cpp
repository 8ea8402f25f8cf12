#include "methods/legendre_fluids/light_columns.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/math/gauss_legendre.h"
#include "scene/media/region.h"

namespace airlight::legendre_fluids {
namespace {

constexpr int checked_blocks = 16;  // of points of the box, where a polynomial is judged
constexpr int most_along = 48;      // coefficients: of more, rounding leaves nothing

}  // namespace

LightColumns::LightColumns(const scene::LegendreBox& box, const Vec3& to_light, double rounding, Below below)
    : box_(&box),
      clamped_(box.negative() && below == Below::zero),
      to_light_(to_light),
      rate_(2 * to_light.cwiseQuotient(box.box().size())) {
  int degree = 0;
  for (int axis = 0; axis < 3; ++axis) {
    side_[axis] = rate_[axis] > 0 ? 1 : -1;
    if (rate_[axis] != 0) degree += box.shape()[std::size_t(axis)] - 1;
  }
  const scene::GaussLegendre rule = scene::gauss_legendre(degree / 2 + 1);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    node_.push_back(0.5 + 0.5 * rule.node[i]);
    weight_.push_back(0.5 * rule.weight[i]);
  }
  if (clamped_ || degree + 2 > most_along) return;
  for (int axis = 0; axis < 3; ++axis)
    if (rate_[axis] != 0) face_[std::size_t(axis)] = polynomial(axis, degree + 2, rounding);
}

// By its values at Gauss points; nothing where it does not give, at points of which this is the nearest face, what they integrate.
LightColumns::Face LightColumns::polynomial(int axis, int along, double rounding) const {
  const scene::TensorShape& n = box_->shape();
  const auto a = std::size_t(axis);
  Face face{n, {}};
  face.shape[a] = along;
  const scene::LegendrePoints& nodes = scene::legendre_points(along);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(scene::tensor_size(face.shape));
  Eigen::Index inner = 1;
  for (int b = axis + 1; b < 3; ++b) inner *= n[std::size_t(b)];
  for (int p = 0; p < along; ++p) {
    const double length = (side_[axis] - nodes.node[p]) / rate_[axis];
    for (std::size_t q = 0; q < node_.size(); ++q) {
      std::array<Eigen::MatrixXd, 3> to;
      for (int b = 0; b < 3; ++b) {
        const int count = n[std::size_t(b)];
        const Eigen::VectorXd start =
            b == axis ? Eigen::VectorXd::Constant(1, nodes.node[p]) : scene::legendre_points(count).node;
        to[std::size_t(b)] = scene::legendre_values(count, start.array() + node_[q] * length * rate_[b]);
      }
      const Eigen::VectorXd plane = scene::along_axes(to[0], to[1], to[2], box_->coefficients(), n);
      for (Eigen::Index i = 0; i < plane.size(); ++i)
        values[(i / inner * along + p) * inner + i % inner] += weight_[q] * length * plane[i];
    }
  }
  std::array<const Eigen::MatrixXd*, 3> analysis;
  for (std::size_t b = 0; b < 3; ++b) analysis[b] = &scene::legendre_points(face.shape[b]).analysis;
  face.coefficients = scene::along_axes(*analysis[0], *analysis[1], *analysis[2], values, face.shape);
  if (!(rounding_of(face, axis) <= rounding)) face.coefficients.resize(0);
  return face;
}

// The greatest error [m] at points of which this is the nearest face.
double LightColumns::rounding_of(const Face& face, int axis) const {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double worst = 0;
  for (int block = 0; block < checked_blocks; ++block) {
    LocalLanes local;
    Lanes length;
    for (int lane = 0; lane < lanes; ++lane) {
      // Compilers evaluate the arguments of a call in any order.
      const double z = uniform(random), y = uniform(random), x = uniform(random);
      Vec3 at(x, y, z);
      at[axis] = side_[axis];
      double most = infinity;  // back from the face, to where the box ends
      for (int b = 0; b < 3; ++b)
        if (rate_[b] != 0) most = std::min(most, (at[b] + side_[b]) / rate_[b]);
      length[lane] = most * (0.5 + 0.5 * uniform(random));
      for (int b = 0; b < 3; ++b) local[std::size_t(b)][lane] = at[b] - length[lane] * rate_[b];
    }
    const Lanes exact = over(local, length);
    const Lanes got = series_values(face.shape, face.coefficients.data(), local[0], local[1], local[2]);
    worst = std::max(worst, (got - exact).abs().maxCoeff());
  }
  return worst;
}

Lanes LightColumns::over(const LocalLanes& local, const Lanes& length) const {
  Lanes sum = Lanes::Zero();
  for (std::size_t q = 0; q < node_.size(); ++q) {
    const Lanes way = node_[q] * length;
    sum += weight_[q] * series_values(box_->shape(), box_->coefficients().data(), local[0] + way * rate_[0],
                                      local[1] + way * rate_[1], local[2] + way * rate_[2]);
  }
  return sum * length;
}

Lanes LightColumns::to_face(int axis, const LocalLanes& local) const {
  const Face& face = face_[std::size_t(axis)];
  if (face.coefficients.size() > 0)
    return series_values(face.shape, face.coefficients.data(), local[0], local[1], local[2]);
  return over(local, ((side_[axis] - local[std::size_t(axis)]) / rate_[axis]).max(0));
}

int LightColumns::nearest_face(const Vec3& local) const {
  int nearest = -1;
  double least = infinity;
  for (int axis = 0; axis < 3; ++axis)
    if (rate_[axis] != 0 && way_to(axis, local, side_[axis]) < least)
      least = way_to(axis, local, side_[axis]), nearest = axis;
  return nearest;
}

// The last of the planes of the opposite faces that lie ahead; -1 within the box.
int LightColumns::first_face(const Vec3& local) const {
  int last = -1;
  double most = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (rate_[axis] != 0 && way_to(axis, local, -side_[axis]) > most)
      most = way_to(axis, local, -side_[axis]), last = axis;
  return last;
}

double LightColumns::at(const Point3& x) const {
  const double t = 0;
  double column = 0;
  along({x, Vec3::Zero()}, &t, 1, &column);
  return column;
}

void LightColumns::along(const Ray& ray, const double* t, int count, double* columns) const {
  std::fill(columns, columns + count, 0.0);
  const Point3 middle = ray.at(0.5 * (t[0] + t[count - 1]));
  const Interval lit = scene::extent(*box_, {middle, to_light_}, {0, infinity});
  if (lit.empty()) return;
  if (clamped_) {
    for (int i = 0; i < count; ++i)
      columns[i] = scene::density_integral(*box_, {ray.at(t[i]), to_light_}, {0, infinity});
    return;
  }
  const Vec3 local_middle = box_->local(middle);
  const int in = box_->box().contains(middle) ? -1 : first_face(local_middle), out = nearest_face(local_middle);
  const Vec3 origin = box_->local(ray.origin), slope = 2 * ray.direction.cwiseQuotient(box_->box().size());
  for (int begin = 0; begin < count; begin += lanes) {
    Lanes at;
    for (int lane = 0; lane < lanes; ++lane) at[lane] = t[std::min(begin + lane, count - 1)];
    LocalLanes local;
    for (int b = 0; b < 3; ++b) local[std::size_t(b)] = origin[b] + slope[b] * at;
    if (in >= 0) {
      const Lanes to_box = (-side_[in] - local[std::size_t(in)]) / rate_[in];
      for (int b = 0; b < 3; ++b) local[std::size_t(b)] += to_box * rate_[b];
    }
    const Lanes values = to_face(out, local);
    for (int lane = 0; lane < std::min(lanes, count - begin); ++lane)
      columns[begin + lane] = std::max(0.0, values[lane]);
  }
}

void LightColumns::cuts(const Ray& ray, bool inside, std::vector<double>& cuts) const {
  const Vec3 origin = box_->local(ray.origin), slope = 2 * ray.direction.cwiseQuotient(box_->box().size());
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    const double turn = slope[a] * rate_[b] - slope[b] * rate_[a];
    if (turn == 0) continue;
    for (int edge = inside ? 3 : 0; edge < 4; ++edge) {
      const double at_a = edge & 1 ? side_[a] : -side_[a], at_b = edge & 2 ? side_[b] : -side_[b];
      cuts.push_back(((at_a - origin[a]) * rate_[b] - (at_b - origin[b]) * rate_[a]) / turn);
    }
  }
}

int LightColumns::polynomials() const {
  return int(std::count_if(face_.begin(), face_.end(), [](const Face& f) { return f.coefficients.size() > 0; }));
}

}  // namespace airlight::legendre_fluids
