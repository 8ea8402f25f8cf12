// One sweep of discrete ordinates: each direction goes through the planes that it crosses fastest, one after the other, and carries its
// light from each plane to the next. Rows of nodes are done together.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "methods/compensated_ray_marching/discrete_ordinates.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {
namespace {

using Row = Eigen::Map<Eigen::ArrayXd>;
using ConstRow = Eigen::Map<const Eigen::ArrayXd>;
constexpr double thin = 0.02;  // an optical depth below which a series stands for differences that would cancel

// Planes of one axis: nodes as [plane][row][along the row].
struct Planes {
  std::array<int, 3> axes;  // of planes, of rows, along rows
  int count, rows, across;
  std::array<Eigen::Index, 3> stride;  // in the grid

  Planes(const OrdinateGrid& grid, int axis)
      : axes{axis, axis == 2 ? 1 : 2, axis == 0 ? 1 : 0},
        count(grid.size[std::size_t(axes[0])]),
        rows(grid.size[std::size_t(axes[1])]),
        across(grid.size[std::size_t(axes[2])]) {
    const std::array<Eigen::Index, 3> of_axis{1, grid.size[0], Eigen::Index(grid.size[0]) * grid.size[1]};
    for (std::size_t i = 0; i < 3; ++i) stride[i] = of_axis[std::size_t(axes[i])];
  }
  Eigen::Index in_grid(int plane, int row) const { return plane * stride[0] + row * stride[1]; }
  Eigen::Index row(int plane, int row) const { return (Eigen::Index(plane) * rows + row) * across; }

  // Calls of(index in planes, index in the grid) for every node.
  template <class Of>
  void each(const Of& of) const {
    tbb::parallel_for(0, count, [&](int plane) {
      for (int r = 0; r < rows; ++r)
        for (int i = 0; i < across; ++i) of(row(plane, r) + i, in_grid(plane, r) + i * stride[2]);
    });
  }
};

// Where a ray meets a neighbouring plane: between two nodes along an axis of that plane.
struct Meeting {
  int first;     // offset of the lower of the two, -1 or 0
  double share;  // of the upper
  explicit Meeting(double offset) : first(offset < 0 ? -1 : 0), share(offset - first) {}
};

// A plane of rows that are one longer at either end; what lies beyond its rows is one row more.
class Padded {
 public:
  Padded(int rows, int across) : across_(across + 2), values_((rows + 1) * (across + 2)) { values_.setZero(); }
  void fill(double value) { values_.setConstant(value); }
  double* row(int r) { return values_.data() + Eigen::Index(r) * across_ + 1; }
  const double* row(int r) const { return values_.data() + Eigen::Index(r) * across_ + 1; }

 private:
  Eigen::Index across_;
  Eigen::ArrayXd values_;
};

// Values where the rays of a row meet a plane, from the two rows and the two columns around.
void meet(const double* lower, const double* upper, const Meeting& along, const Meeting& row, Row& out) {
  const auto n = out.size();
  const double w00 = (1 - row.share) * (1 - along.share), w01 = (1 - row.share) * along.share,
               w10 = row.share * (1 - along.share), w11 = row.share * along.share;
  const double *a = lower + along.first, *b = upper + along.first;
  out = w00 * ConstRow(a, n) + w01 * ConstRow(a + 1, n) + w10 * ConstRow(b, n) + w11 * ConstRow(b + 1, n);
}

// Integrals of x^k e^-t x t over x in [0, 1], k = 0, 1, 2.
void source_integrals(const Row& t, const Row& passed, Row& i0, Row& i1, Row& i2) {
  i0 = (t < thin).select(t * (1 - t * (0.5 - t * (1. / 6 - t / 24))), 1 - passed);
  i1 = (t < thin).select(t * (0.5 - t * (1. / 3 - t * (1. / 8 - t / 30))), (1 - (1 + t) * passed) / t);
  i2 = (t < thin).select(t * (1. / 3 - t * (0.25 - t * (0.1 - t / 36))), (2 - (2 + t * (2 + t)) * passed) / t.square());
}

// Boundary values for the rows beyond the first and the last.
enum class Beyond { outside, last_row };

// A direction, as the planes of its axis see it.
struct Way {
  std::vector<double> harmonics, weighted;
  double step;  // to the plane before [m]
  Meeting row, along, row_after, along_after;
};

Way way_of(const Ordinate& d, const OrdinateGrid& grid, const Planes& planes, int order) {
  const double step = grid.cell[planes.axes[0]] / std::abs(d.direction[planes.axes[0]]);
  const auto offset = [&](int axis) {
    return grid.endless[std::size_t(axis)] ? 0 : -d.direction[axis] * step / grid.cell[axis];
  };
  std::vector<double> y = scene::evaluate_sh(order, d.direction), weighted = y;
  for (double& value : weighted) value *= d.weight;
  const double down = offset(planes.axes[1]), across = offset(planes.axes[2]);
  return {y, weighted, step, Meeting(down), Meeting(across), Meeting(-down), Meeting(-across)};
}

// Working memory for one row.
struct RowWork {
  Row depth, beyond;       // optical depths to the planes before and after
  Row passed, i0, i1, i2;  // what passes the depth, and source_integrals of it
  Row up, down, middle;    // of the planes before and after, and of the parabola between

  static constexpr int count = 9;
  RowWork(double* free, Eigen::Index n)
      : depth(free, n),
        beyond(free + n, n),
        passed(free + 2 * n, n),
        i0(free + 3 * n, n),
        i1(free + 4 * n, n),
        i2(free + 5 * n, n),
        up(free + 6 * n, n),
        down(free + 7 * n, n),
        middle(free + 8 * n, n) {}
};

}  // namespace

// Goes through the planes of an axis, one after the other, with all directions that cross them fastest on one side. Sources and moments
// have the order of nodes of `planes`.
class DiscreteOrdinates::GroupSweep {
 public:
  GroupSweep(const DiscreteOrdinates& all, const Planes& planes, bool forward,
             const std::vector<std::size_t>& directions, const Moments& source, double inflow);
  void add_to(Moments& radiance);

 private:
  int place(int k) const { return forward_ ? k : planes_.count - 1 - k; }
  bool first(int k) const { return k == 0; }
  bool last(int k) const { return k + 1 == planes_.count; }
  std::size_t which(std::size_t d, int l) const { return d * std::size_t(lights_) + std::size_t(l); }
  int bounded(int row, Beyond beyond) const {
    if (beyond == Beyond::last_row) return std::clamp(row, 0, planes_.rows - 1);
    return row < 0 || row >= planes_.rows ? planes_.rows : row;
  }
  // Values of a plane where the rays of row r come from, and where they go.
  void before(const Padded& plane, Beyond beyond, const Way& way, int r, Row& out) const {
    const int low = r + way.row.first;
    meet(plane.row(bounded(low, beyond)), plane.row(bounded(low + 1, beyond)), way.along, way.row, out);
  }
  void after(const Padded& plane, Beyond beyond, const Way& way, int r, Row& out) const {
    const int low = r + way.row_after.first;
    meet(plane.row(bounded(low, beyond)), plane.row(bounded(low + 1, beyond)), way.along_after, way.row_after, out);
  }
  void emit(int k);
  void cross(int k, int r, Moments& radiance);
  void find_depths(int k, int r, const Way& way, RowWork& w) const;
  void cross(int k, int r, std::size_t d, int l, RowWork& w);

  const DiscreteOrdinates& all_;
  const Planes& planes_;
  const bool forward_;
  const std::vector<std::size_t>& directions_;
  const Moments& source_;
  const double inflow_;
  const int bands_, lights_;
  std::vector<Way> ways_;
  // Plane k and its neighbours are kept at k % 3, light at k % 2. Boundary condition: outside the box extinction is 0,
  // the inflow radiance is given, and the source is extended by its last value.
  std::array<Padded, 3> extinction_;
  std::array<std::vector<Padded>, 3> emitted_;
  std::array<std::vector<Padded>, 2> light_;
};

DiscreteOrdinates::GroupSweep::GroupSweep(const DiscreteOrdinates& all, const Planes& planes, bool forward,
                                          const std::vector<std::size_t>& directions, const Moments& source,
                                          double inflow)
    : all_(all),
      planes_(planes),
      forward_(forward),
      directions_(directions),
      source_(source),
      inflow_(inflow),
      bands_(all.options_.order * all.options_.order),
      lights_(int(source.cols()) / bands_),
      extinction_{Padded(planes.rows, planes.across), Padded(planes.rows, planes.across),
                  Padded(planes.rows, planes.across)} {
  for (const std::size_t one : directions)
    ways_.push_back(way_of(all.directions_[one], all.grid_, planes, all.options_.order));
  const std::size_t count = directions.size() * std::size_t(lights_);
  for (auto& planes_of : emitted_) planes_of.assign(count, Padded(planes.rows, planes.across));
  for (auto& planes_of : light_) {
    planes_of.assign(count, Padded(planes.rows, planes.across));
    for (Padded& plane : planes_of) plane.fill(inflow);
  }
}

void DiscreteOrdinates::GroupSweep::add_to(Moments& radiance) {
  emit(0);
  for (int k = 0; k < planes_.count; ++k) {
    if (!last(k)) emit(k + 1);
    tbb::parallel_for(0, planes_.rows, [&](int r) { cross(k, r, radiance); });
  }
}

// Sets extinction of plane k, and the light that its nodes emit along each direction.
void DiscreteOrdinates::GroupSweep::emit(int k) {
  const int across = planes_.across;
  tbb::parallel_for(0, planes_.rows, [&](int r) {
    const Eigen::Index at = planes_.row(place(k), r);
    for (int i = 0; i < across; ++i)
      extinction_[k % 3].row(r)[i] = all_.extinction_[planes_.in_grid(place(k), r) + i * planes_.stride[2]];
    for (std::size_t d = 0; d < ways_.size(); ++d)
      for (int l = 0; l < lights_; ++l) {
        Row emits(emitted_[k % 3][which(d, l)].row(r), across);
        const double* coefficients = source_.data() + Eigen::Index(l) * bands_ * source_.rows() + at;
        emits = ways_[d].harmonics[0] * ConstRow(coefficients, across);
        for (int b = 1; b < bands_; ++b)
          emits += ways_[d].harmonics[std::size_t(b)] * ConstRow(coefficients + b * source_.rows(), across);
        emits.data()[-1] = emits[0];
        emits.data()[across] = emits[across - 1];
      }
  });
}

// Light of all ways to row r of plane k, into its moments.
void DiscreteOrdinates::GroupSweep::cross(int k, int r, Moments& radiance) {
  const int across = planes_.across;
  thread_local Eigen::ArrayXd scratch;
  if (scratch.size() < RowWork::count * across) scratch.resize(RowWork::count * across);
  RowWork w(scratch.data(), across);
  const Eigen::Index at = planes_.row(place(k), r);
  for (std::size_t d = 0; d < ways_.size(); ++d) {
    const Way& way = ways_[d];
    find_depths(k, r, way, w);
    w.passed = (-w.depth).exp();
    source_integrals(w.depth, w.passed, w.i0, w.i1, w.i2);
    for (int l = 0; l < lights_; ++l) {
      cross(k, r, d, l, w);
      const ConstRow out(light_[k % 2][which(d, l)].row(r), across);
      double* moments = radiance.data() + Eigen::Index(l) * bands_ * radiance.rows() + at;
      for (int b = 0; b < bands_; ++b) Row(moments + b * radiance.rows(), across) += way.weighted[std::size_t(b)] * out;
    }
  }
}

void DiscreteOrdinates::GroupSweep::find_depths(int k, int r, const Way& way, RowWork& w) const {
  const ConstRow extinct(extinction_[k % 3].row(r), planes_.across);
  if (first(k)) {
    w.depth = 0.5 * way.step * extinct;
  } else {
    before(extinction_[(k + 2) % 3], Beyond::outside, way, r, w.up);
    w.depth = 0.5 * way.step * (extinct + w.up);
  }
  if (last(k)) {
    w.beyond = 0.5 * way.step * extinct;
  } else {
    after(extinction_[(k + 1) % 3], Beyond::outside, way, r, w.down);
    w.beyond = 0.5 * way.step * (extinct + w.down);
  }
  w.beyond = w.beyond.max(1e-6 * w.depth + 1e-30);
}

// One light of one way to row r of plane k: what comes in from the plane before, and what is emitted in between.
void DiscreteOrdinates::GroupSweep::cross(int k, int r, std::size_t d, int l, RowWork& w) {
  const Way& way = ways_[d];
  Row &up = w.up, &down = w.down, &middle = w.middle;
  Row out(light_[k % 2][which(d, l)].row(r), planes_.across);
  const ConstRow here(emitted_[k % 3][which(d, l)].row(r), planes_.across);
  if (last(k))
    down = here;
  else
    after(emitted_[(k + 1) % 3][which(d, l)], Beyond::last_row, way, r, down);
  if (first(k)) {  // at the face, half a step away
    out = inflow_ * w.passed;
    up = (1.5 * here - 0.5 * down).max(here.min(0));
  } else {
    before(light_[1 - k % 2][which(d, l)], Beyond::outside, way, r, up);
    if (!all_.open_.empty()) {
      const float* open = all_.open_[directions_[d]].data() + planes_.in_grid(place(k), r);
      for (int i = 0; i < planes_.across; ++i) up[i] *= double(open[i * planes_.stride[2]]);
    }
    out = up * w.passed;
    before(emitted_[(k + 2) % 3][which(d, l)], Beyond::last_row, way, r, up);
  }
  // A parabola through the three sources, as a Bezier curve whose middle point stays between its ends.
  middle =
      here + 0.5 * (w.beyond * (up - here) + w.depth * (w.depth / w.beyond) * (here - down)) / (w.depth + w.beyond);
  middle = middle.max(up.min(here)).min(up.max(here));
  out += here * (w.i0 - 2 * w.i1 + w.i2) + up * w.i2 + middle * (2 * (w.i1 - w.i2));
}

Moments DiscreteOrdinates::sweep(const Moments& source, double inflow) const {
  std::array<std::vector<std::size_t>, 6> sides;
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    const int axis = fastest_axis(grid_, directions_[d].direction);
    sides[std::size_t(2 * axis + (directions_[d].direction[axis] > 0))].push_back(d);
  }
  Moments total = Moments::Zero(source.rows(), source.cols());
  Moments from(source.rows(), source.cols()), to(source.rows(), source.cols());
  for (int axis = 0; axis < 3; ++axis) {
    if (sides[std::size_t(2 * axis)].empty() && sides[std::size_t(2 * axis + 1)].empty()) continue;
    const Planes planes(grid_, axis);
    for (Eigen::Index c = 0; c < source.cols(); ++c)
      planes.each([&](Eigen::Index in_planes, Eigen::Index in_grid) { from(in_planes, c) = source(in_grid, c); });
    to.setZero();
    for (const bool forward : {false, true})
      if (const auto& directions = sides[std::size_t(2 * axis + forward)]; !directions.empty())
        GroupSweep(*this, planes, forward, directions, from, inflow).add_to(to);
    for (Eigen::Index c = 0; c < source.cols(); ++c)
      planes.each([&](Eigen::Index in_planes, Eigen::Index in_grid) { total(in_grid, c) += to(in_planes, c); });
  }
  return total;
}

}  // namespace airlight::compensated_ray_marching
