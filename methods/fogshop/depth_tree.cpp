#include "methods/fogshop/depth_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "methods/fogshop/average_depths.h"
#include "methods/fogshop/surface_boxes.h"

namespace airlight::fogshop {
namespace {

constexpr int deepest_level = 24;  // levels

struct Node {
  Point3 center;
  double half;  // [m] of its side
  int place;    // among the children; -1: the root
  int level = 0;
  double spent = 0;  // of the tolerance
  CellPolynomial resolved = {};
  std::vector<int> gaussians = {}, shapes = {};  // that are not resolved, that may touch it
};

struct Loss {
  double error;
  int gaussian;
};
// In ascending order.
std::vector<Loss> losses_of(const GaussianArrays& g, const Node& node) {
  std::vector<Loss> losses;
  for (const int i : node.gaussians) {
    const Vec3 beside = ((g.center(i) - node.center).cwiseAbs() - Vec3::Constant(node.half)).cwiseMax(0);
    losses.push_back({g.half_depth[i] * cell_error(2 * node.half, beside.norm(), g.a[i]), i});
  }
  std::sort(losses.begin(), losses.end(), [](const Loss& a, const Loss& b) {
    return std::pair(a.error, a.gaussian) < std::pair(b.error, b.gaussian);
  });
  return losses;
}

// Moves what costs least into the polynomial, until `allowed` is spent.
void resolve(const GaussianArrays& g, Node& node, const std::vector<Loss>& losses, double allowed) {
  std::vector<int> resolved;
  double spent = 0;
  for (; resolved.size() < losses.size(); resolved.push_back(losses[resolved.size()].gaussian)) {
    const double error = losses[resolved.size()].error;
    if (spent + error > allowed) break;
    spent += error;
  }
  if (resolved.empty()) return;
  node.spent += spent;
  node.gaussians.clear();
  for (std::size_t k = resolved.size(); k < losses.size(); ++k) node.gaussians.push_back(losses[k].gaussian);
  const GaussianArrays part = subset(g, resolved);
  std::vector<double> values;
  for (const Vec3& place : cell_points()) values.push_back(average_depth_of(part, node.center + node.half * place));
  const CellPolynomial sum = fit_cell(values);
  for (int i = 0; i < CellPolynomial::size; ++i) node.resolved.coefficients[i] += sum.coefficients[i];
}

// The polynomial in the coordinates of one of the cube's eight parts.
CellPolynomial part_of(const CellPolynomial& whole, const Vec3& middle) {
  std::vector<double> values;
  for (const Vec3& place : cell_points()) values.push_back(whole(middle + 0.5 * place));
  return fit_cell(values);
}

}  // namespace

// Level by level.
class DepthTreeMaker {
 public:
  DepthTreeMaker(DepthTree& tree, const GaussianArrays& gaussians, const SurfaceBoxes& boxes, double tolerance,
                 const scene::Execution& execution)
      : tree_(tree), gaussians_(gaussians), boxes_(boxes), tolerance_(tolerance), execution_(execution) {}

  void make(Node root) {
    std::vector<Node> open;
    open.push_back(std::move(root));
    while (!open.empty()) {
      std::vector<char> ends(open.size());
      scene::parallel_for(int(open.size()), execution_, [&](int k) { ends[k] = resolve_some(open[k]); });
      if (open.front().level == deepest_level || (open.front().level > 0 && crowded(open, ends))) {
        scene::parallel_for(int(open.size()), execution_, [&](int k) {
          if (!ends[k]) resolve_rest(open[k], losses_of(gaussians_, open[k]));
        });
        ends.assign(open.size(), 1);
      }
      std::vector<Node> next;
      for (std::size_t k = 0; k < open.size(); ++k) {
        const int number = ends[k] ? add_cell(open[k]) : split(open[k], next);
        if (open[k].place >= 0) tree_.children_[open[k].place] = number;
      }
      open = std::move(next);
    }
  }

 private:
  // Whether few are left then; if not, what costs next to nothing is resolved for all parts at once.
  bool resolve_some(Node& node) const {
    const std::vector<Loss> losses = losses_of(gaussians_, node);
    double sum = node.spent;
    for (std::size_t k = 0; k + DepthTree::most_listed < losses.size(); ++k) sum += losses[k].error;
    const bool ends = sum <= tolerance_ && node.level > 0;
    if (ends)
      resolve_rest(node, losses);
    else
      resolve(gaussians_, node, losses, std::min(tolerance_ / 32, 0.5 * tolerance_ - node.spent));
    return ends;
  }
  void resolve_rest(Node& node, const std::vector<Loss>& losses) const {
    resolve(gaussians_, node, losses, tolerance_ - node.spent);
  }

  bool crowded(const std::vector<Node>& open, const std::vector<char>& ends) const {
    std::size_t parts = 0, entries = 0;
    for (std::size_t k = 0; k < open.size(); ++k)
      if (!ends[k]) parts += 8, entries += open[k].gaussians.size();
    return tree_.cells_.size() + open.size() + parts > DepthTree::most_cells || entries > DepthTree::most_entries;
  }

  int add_cell(const Node& node) {
    std::vector<int>& listed = tree_.listed_;
    const std::size_t count = node.gaussians.size();
    if (2 * count > std::size_t(gaussians_.count) || listed.size() + count > DepthTree::most_entries) return -1;
    const int begin = int(listed.size());
    listed.insert(listed.end(), node.gaussians.begin(), node.gaussians.end());
    tree_.cells_.push_back({node.resolved, begin, int(listed.size())});
    return -int(tree_.cells_.size());
  }

  int split(const Node& node, std::vector<Node>& parts) {
    const int number = int(tree_.children_.size() / 8);
    tree_.children_.insert(tree_.children_.end(), 8, -1);
    for (int c = 0; c < 8; ++c) {
      const Vec3 middle = 0.5 * Vec3(c & 1 ? 1 : -1, c & 2 ? 1 : -1, c & 4 ? 1 : -1);
      Node part{node.center + node.half * middle, 0.5 * node.half, 8 * number + c, node.level + 1, node.spent};
      // A little more: places in a shader are multiples of side / 2^32.
      const Vec3 reach = Vec3::Constant(part.half + 1e-9 * tree_.side_);
      if (!boxes_.touch({part.center - reach, part.center + reach}, node.shapes, part.shapes)) continue;
      part.resolved = part_of(node.resolved, middle);
      part.gaussians = node.gaussians;
      parts.push_back(std::move(part));
    }
    return number;
  }

  DepthTree& tree_;
  const GaussianArrays& gaussians_;
  const SurfaceBoxes& boxes_;
  double tolerance_;
  const scene::Execution& execution_;
};

double cell_error(double side, double distance, double a) {
  // Near: sixth derivatives at the centre. Far: those of 1/(2 u^2), u from the middle of the cell, and somewhat more
  // where the Gaussian itself still shows.
  const double s = a * side, s2 = s * s, d = a * distance, u = std::min(d + 0.5 * s, 3 * d), u2 = u * u;
  const double far = 0.28 * (1 + 12 / u2) / (u2 * u2 * u2 * u2);
  return std::min(1.0, s2 * s2 * s2 * std::min(2.6e-3, far));
}

void DepthTree::look_from_afar(const GaussianArrays& g) {
  for (int i = 0; i < g.count; ++i) {
    const double strength = 0.5 * g.half_depth[i] / (g.a[i] * g.a[i]);
    far_ += strength;
    center_ += strength * g.center(i);
  }
  center_ /= far_;
}

// 1/|x - y|^2 in powers of |y|/|x| has Chebyshev's polynomials of the second kind for coefficients, not above 1, 2, 3...;
// about the centre the second term cancels. D(u)/u is within 1/(2 u^4) of 1/(2 u^2).
double DepthTree::far_error(const GaussianArrays& g, double distance) const {
  double sum = 0;
  for (int i = 0; i < g.count; ++i) {
    const double strength = 0.5 * g.half_depth[i] / (g.a[i] * g.a[i]), off = (g.center(i) - center_).norm();
    if (off >= distance) return infinity;
    const double x = off / distance, u = g.a[i] * (distance - off);
    sum += strength * (3 * x * x + 1 / (u * u)) / ((distance - off) * (distance - off));
  }
  return sum;
}

DepthTree::DepthTree(const GaussianArrays& g, const std::vector<scene::Surface>& surfaces, double tolerance,
                     const scene::Execution& execution)
    : listed_(g.count) {
  std::iota(listed_.begin(), listed_.end(), 0);
  cells_.push_back({{}, 0, g.count});
  look_from_afar(g);
  const double narrowest = 1 / *std::max_element(g.a.begin(), g.a.begin() + g.count);
  double radius = narrowest;
  while (far_error(g, radius) > tolerance) radius *= 1.25;
  const SurfaceBoxes boxes(surfaces);
  const Vec3 reach = Vec3::Constant(radius);
  if (const Box root = intersect(boxes.bounds(), {center_ - reach, center_ + reach}); !root.empty()) {
    // Room for the rounding of both.
    const double magnitude = root.lo.cwiseAbs().cwiseMax(root.hi.cwiseAbs()).maxCoeff();
    const double extent = root.size().maxCoeff(), margin = 1e-6 * (magnitude + extent) + 1e-3 * narrowest;
    side_ = extent + 2 * margin;
    corner_ = root.center() - Vec3::Constant(0.5 * side_);
    DepthTreeMaker(*this, g, boxes, tolerance, execution)
        .make({root.center(), 0.5 * side_, -1, 0, 0, {}, listed_, boxes.all()});
  }
  std::vector<int> padded = listed_;  // whole vectors are read from any place on
  padded.insert(padded.end(), GaussianArrays::padding, 0);
  listed_gaussians_ = subset(g, padded);
}

double DepthTree::operator()(const Point3& x) const {
  if (!(side_ > 0)) return far_ / (x - center_).squaredNorm();
  Vec3 place = (x - corner_) / side_;
  if ((place.array() < 0).any() || (place.array() >= 1).any()) return far_ / (x - center_).squaredNorm();
  int node = 0;
  while (node >= 0) {
    place *= 2;
    const auto upper = place.array() >= 1;
    const int child = int(upper[0]) + 2 * int(upper[1]) + 4 * int(upper[2]);
    for (int c = 0; c < 3; ++c) place[c] -= child >> c & 1;
    node = children_[8 * node + child];
  }
  const DepthCell& cell = cells_[-1 - node];
  return cell.polynomial(2 * place - Vec3::Ones()) + average_depth_of(listed_gaussians_, cell.begin, cell.end, x);
}

}  // namespace airlight::fogshop
