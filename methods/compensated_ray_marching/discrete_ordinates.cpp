#include "methods/compensated_ray_marching/discrete_ordinates.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/math/dense.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::compensated_ray_marching {
namespace {

using Row = Eigen::Map<Eigen::ArrayXd>;
using ConstRow = Eigen::Map<const Eigen::ArrayXd>;
constexpr int kept = 5;        // iterations that are combined
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

}  // namespace

struct DiscreteOrdinates::Group {
  int axis;
  bool forward;  // along the axis
  std::vector<std::size_t> directions;
};

int fastest_axis(const OrdinateGrid& grid, const Vec3& direction) {
  int axis = -1;
  double fastest = -1;
  for (int a = 0; a < 3; ++a)
    if (const double speed = std::abs(direction[a]) / grid.cell[a]; !grid.endless[std::size_t(a)] && speed > fastest)
      fastest = speed, axis = a;
  return axis;
}

std::vector<std::vector<float>> open_ways(const OrdinateGrid& grid, const std::vector<Ordinate>& directions,
                                          const std::function<bool(Eigen::Index, const Vec3&)>& objects) {
  std::vector<std::vector<float>> open(directions.size(), std::vector<float>(std::size_t(grid.nodes()), 1.0f));
  tbb::parallel_for(std::size_t(0), directions.size(), [&](std::size_t d) {
    const int axis = fastest_axis(grid, directions[d].direction);
    const Vec3 back = -directions[d].direction * (grid.cell[axis] / std::abs(directions[d].direction[axis]));
    for (Eigen::Index node = 0; node < grid.nodes(); ++node)
      if (objects(node, back)) open[d][std::size_t(node)] = 0;
  });
  return open;
}

DiscreteOrdinates::DiscreteOrdinates(const OrdinateGrid& grid, Eigen::ArrayXd extinction, double albedo,
                                     std::vector<double> phase, const OrdinateOptions& options,
                                     std::vector<std::vector<float>> open)
    : grid_(grid),
      extinction_(std::move(extinction)),
      albedo_(albedo),
      phase_(std::move(phase)),
      options_(options),
      directions_(ordinate_directions(options.levels, options.azimuths, options.hemispheres)),
      open_(std::move(open)) {
  int ends = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    if (grid.size[a] < 1 || !(grid.cell[Eigen::Index(a)] > 0) || (grid.endless[a] && grid.size[a] != 1))
      throw Error("discrete ordinates: a grid without cells, or of several along an endless axis");
    ends += !grid.endless[a];
  }
  if (ends == 0) throw Error("discrete ordinates: a grid without ends");
  if (extinction_.size() != grid.nodes() || !extinction_.allFinite() || !(extinction_ >= 0).all())
    throw Error(fmt::format("discrete ordinates: found {} extinctions, expected {}, finite and not below 0",
                            extinction_.size(), grid.nodes()));
  if (!(albedo >= 0 && albedo <= 1)) throw Error(fmt::format("discrete ordinates: albedo {}, expected 0 to 1", albedo));
  if (options.order < 1 || options.order > 6 || int(phase_.size()) < options.order)
    throw Error("discrete ordinates: expected an order of 1 to 6, and a moment of the phase function for each band");
  for (const std::vector<float>& one : open_)
    if (open_.size() != directions_.size() || one.size() != std::size_t(grid.nodes()))
      throw Error("discrete ordinates: expected open ways for every direction and node, or none");
}

double DiscreteOrdinates::deepest_cell() const {
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a)
    if (!grid_.endless[a]) longest = std::max(longest, grid_.cell[Eigen::Index(a)]);
  return extinction_.maxCoeff() * longest;
}

void DiscreteOrdinates::sweep(const Group& group, const Moments& source, double inflow, Moments& radiance) const {
  const Planes planes(grid_, group.axis);
  const int bands = options_.order * options_.order, lights = int(source.cols()) / bands;
  const int rows = planes.rows, across = planes.across;
  const std::size_t count = group.directions.size();
  struct Way {
    std::vector<double> harmonics, weighted;
    double step;  // to the plane before [m]
    Meeting row, along, row_after, along_after;
  };
  std::vector<Way> ways;
  for (const std::size_t which : group.directions) {
    const Ordinate& d = directions_[which];
    const double step = grid_.cell[group.axis] / std::abs(d.direction[group.axis]);
    const auto offset = [&](int axis) {
      return grid_.endless[std::size_t(axis)] ? 0 : -d.direction[axis] * step / grid_.cell[axis];
    };
    std::vector<double> y = scene::evaluate_sh(options_.order, d.direction), weighted = y;
    for (double& value : weighted) value *= d.weight;
    const double down = offset(planes.axes[1]), across_it = offset(planes.axes[2]);
    ways.push_back({y, weighted, step, Meeting(down), Meeting(across_it), Meeting(-down), Meeting(-across_it)});
  }

  // Of three planes, of which one is the one before, one this, one the next. Beyond the box nothing absorbs, light comes in, and the source
  // goes on.
  std::array<Padded, 3> extinction{Padded(rows, across), Padded(rows, across), Padded(rows, across)};
  std::array<std::vector<Padded>, 3> emitted;
  std::array<std::vector<Padded>, 2> light;
  for (auto& planes_of : emitted) planes_of.assign(count * std::size_t(lights), Padded(rows, across));
  for (auto& planes_of : light) {
    planes_of.assign(count * std::size_t(lights), Padded(rows, across));
    for (Padded& plane : planes_of) plane.fill(inflow);
  }
  const auto place = [&](int k) { return group.forward ? k : planes.count - 1 - k; };
  const auto emit = [&](int k) {
    tbb::parallel_for(0, rows, [&](int r) {
      const Eigen::Index at = planes.row(place(k), r);
      for (int i = 0; i < across; ++i)
        extinction[k % 3].row(r)[i] = extinction_[planes.in_grid(place(k), r) + i * planes.stride[2]];
      for (std::size_t d = 0; d < count; ++d)
        for (int l = 0; l < lights; ++l) {
          Row emits(emitted[k % 3][d * std::size_t(lights) + std::size_t(l)].row(r), across);
          const double* coefficients = source.data() + Eigen::Index(l) * bands * source.rows() + at;
          emits = ways[d].harmonics[0] * ConstRow(coefficients, across);
          for (int b = 1; b < bands; ++b)
            emits += ways[d].harmonics[std::size_t(b)] * ConstRow(coefficients + b * source.rows(), across);
          emits.data()[-1] = emits[0];
          emits.data()[across] = emits[across - 1];
        }
    });
  };
  emit(0);
  for (int k = 0; k < planes.count; ++k) {
    const bool first = k == 0, last = k + 1 == planes.count;
    if (!last) emit(k + 1);
    const int now = k % 3, before = (k + 2) % 3, after = (k + 1) % 3;
    tbb::parallel_for(0, rows, [&](int r) {
      thread_local Eigen::ArrayXd scratch;
      if (scratch.size() < 9 * across) scratch.resize(9 * across);
      double* free = scratch.data();
      const auto row = [&] { return Row(std::exchange(free, free + across), across); };
      Row depth = row(), beyond = row(), passed = row(), i0 = row(), i1 = row(), i2 = row(), up = row(), down = row(),
          middle = row();
      const Eigen::Index at = planes.row(place(k), r);
      const ConstRow extinct(extinction[now].row(r), across);
      const auto outside = [&](int other) { return other < 0 || other >= rows ? rows : other; };
      const auto clamped = [&](int other) { return std::clamp(other, 0, rows - 1); };
      for (std::size_t d = 0; d < count; ++d) {
        const Way& way = ways[d];
        const int low = r + way.row.first, high = r + way.row_after.first;
        const auto neighbour = [&](const Padded& p, const auto& bounded, bool behind, Row& out) {
          if (behind)
            meet(p.row(bounded(low)), p.row(bounded(low + 1)), way.along, way.row, out);
          else
            meet(p.row(bounded(high)), p.row(bounded(high + 1)), way.along_after, way.row_after, out);
        };
        if (first) {
          depth = 0.5 * way.step * extinct;
        } else {
          neighbour(extinction[before], outside, true, up);
          depth = 0.5 * way.step * (extinct + up);
        }
        if (last) {
          beyond = 0.5 * way.step * extinct;
        } else {
          neighbour(extinction[after], outside, false, down);
          beyond = 0.5 * way.step * (extinct + down);
        }
        beyond = beyond.max(1e-6 * depth + 1e-30);
        passed = (-depth).exp();
        source_integrals(depth, passed, i0, i1, i2);
        for (int l = 0; l < lights; ++l) {
          const std::size_t which = d * std::size_t(lights) + std::size_t(l);
          Row out(light[k % 2][which].row(r), across);
          const ConstRow here(emitted[now][which].row(r), across);
          if (last)
            down = here;
          else
            neighbour(emitted[after][which], clamped, false, down);
          if (first) {  // at the face, half a step away
            out = inflow * passed;
            up = (1.5 * here - 0.5 * down).max(here.min(0));
          } else {
            neighbour(light[1 - k % 2][which], outside, true, up);
            if (!open_.empty()) {
              const float* open = open_[group.directions[d]].data() + planes.in_grid(place(k), r);
              for (int i = 0; i < across; ++i) up[i] *= double(open[i * planes.stride[2]]);
            }
            out = up * passed;
            neighbour(emitted[before][which], clamped, true, up);
          }
          // A parabola through the three sources, as a Bezier curve whose middle point stays between its ends.
          middle = here + 0.5 * (beyond * (up - here) + depth * (depth / beyond) * (here - down)) / (depth + beyond);
          middle = middle.max(up.min(here)).min(up.max(here));
          out += here * (i0 - 2 * i1 + i2) + up * i2 + middle * (2 * (i1 - i2));
          double* moments = radiance.data() + Eigen::Index(l) * bands * radiance.rows() + at;
          for (int b = 0; b < bands; ++b)
            Row(moments + b * radiance.rows(), across) += way.weighted[std::size_t(b)] * out;
        }
      }
    });
  }
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
        sweep({axis, forward, directions}, from, inflow, to);
    for (Eigen::Index c = 0; c < source.cols(); ++c)
      planes.each([&](Eigen::Index in_planes, Eigen::Index in_grid) { total(in_grid, c) += to(in_planes, c); });
  }
  return total;
}

// J = J_ss + albedo p_l M_lm(J): iterated, each time from the combination of the last few that leaves the least (Anderson 1965, which is
// GMRES for a linear problem), so that thick smoke of albedo 1 takes tens of iterations instead of thousands.
OrdinateSolution DiscreteOrdinates::solve(const Moments& source, double inflow, const Moments* before,
                                          const std::function<bool()>& interrupted) const {
  const int bands = options_.order * options_.order;
  if (source.rows() != grid_.nodes() || source.cols() % bands != 0 || !source.allFinite() ||
      (before && (before->rows() != source.rows() || before->cols() != source.cols())))
    throw Error("discrete ordinates: a source that does not fit the grid and the order, or is not finite");
  const int lights = int(source.cols()) / bands;
  // Of the light's mean alone, weighted with what scatters it.
  const auto product = [&](const Moments& a, const Moments& b) {
    double sum = 0;
    for (int l = 0; l < lights; ++l) sum += (extinction_.square() * a.col(l * bands) * b.col(l * bands)).sum();
    return sum;
  };
  OrdinateSolution solution;
  Moments& at = solution.source;
  at = before ? *before : source;
  std::vector<Moments> steps, misses;  // differences of results and of what they missed
  Moments last_at, last_result, last_missed;
  double least = 1;  // by how much of its own size a part of the error shows in what is missed
  while (solution.iterations < options_.iterations && !(interrupted && interrupted())) {
    solution.radiance = sweep(at, inflow);
    if (factors_.size() > 0) solution.radiance.colwise() *= factors_;
    ++solution.iterations;
    Moments result = source;
    for (Eigen::Index c = 0; c < source.cols(); ++c)
      result.col(c) += albedo_ * phase_[std::size_t(std::sqrt(double(c % bands)))] * solution.radiance.col(c);
    Moments missed = result - at;
    if (solution.iterations > 1) {
      steps.push_back(result - last_result);
      misses.push_back(missed - last_missed);
      if (int(steps.size()) > kept) steps.erase(steps.begin()), misses.erase(misses.begin());
      last_at = at - last_at;
      if (const double moved = product(last_at, last_at); moved > 0)
        least = std::min(least, std::sqrt(product(misses.back(), misses.back()) / moved));
    }
    const double size = product(missed, missed), whole = product(result, result);
    solution.error = size == 0 ? 0 : std::sqrt(size / whole) / std::max(least, 1e-6);
    if (size == 0 || (solution.iterations > 1 && solution.error <= options_.tolerance)) {
      at = std::move(result);
      break;
    }
    last_at = std::move(at);
    last_missed = missed;
    at = last_result = std::move(result);
    if (steps.empty()) continue;
    const int n = int(steps.size());
    Eigen::MatrixXd gram(n, n);
    Eigen::VectorXd right(n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j) gram(i, j) = gram(j, i) = product(misses[std::size_t(i)], misses[std::size_t(j)]);
      right[i] = product(misses[std::size_t(i)], missed);
    }
    const Eigen::VectorXd shares = scene::LeastNormFactors(gram).solve(right);
    for (int i = 0; i < n; ++i) at -= shares[i] * steps[std::size_t(i)];
  }
  return solution;
}

}  // namespace airlight::compensated_ray_marching
