// Source radiance on a grid of nodes (ours, in place of the publication's at the centres of Gaussians): depths towards the light in
// fixed directions, in closed form, for single scattering; discrete ordinates or diffusion for the rest.
#pragma once
#include <array>
#include <functional>
#include <optional>

#include "methods/compensated_ray_marching/incoming_light.h"
#include "methods/compensated_ray_marching/node_grid.h"
#include "methods/compensated_ray_marching/options.h"
#include "methods/compensated_ray_marching/p1_grid.h"
#include "methods/compensated_ray_marching/warm_start.h"
#include "scene/renderer.h"

namespace airlight::compensated_ray_marching {

class LitGrid {
 public:
  // Computes everything that does not depend on the light: nodes, their mean densities, and depths towards the light's
  // fixed directions. A direction that surfaces block has no light. The scene must outlive this object. Throws
  // NotSupported if cells are too deep at any size.
  LitGrid(const scene::Scene&, const scene::Medium&, const Options&, const IncomingLight&, const scene::Execution&);

  // Sets where light comes from. Computes depths towards new directional lights; returns whether there were any.
  bool aim(const IncomingLight&, const scene::Execution&);
  // Sets the light and computes single and multiple scattering at the nodes. Iterations start from the
  // previous solution.
  void light(const IncomingLight&, const scene::Execution&);
  // Where the first light begins: with the solution of the last frame's smoke, which `solution` gives; diffusion begins with nothing. Light
  // without colour has one for all channels that have extinction and albedo in common.
  void begin_with(const Solution&, bool grey);
  Solution solution() const;

  // Logarithm of the source radiance [W/m^2/sr] towards the camera at every node. Single scattering uses as many bands
  // of the phase function as the light has, the rest uses `order`. Radiances below 1e-6 of the greatest are raised to
  // that value. Light decays exponentially in smoke, therefore logarithms are interpolated: errors between nodes are
  // 1.2 times (cells 0.4 deep) to 1.6 times smaller (1.6).
  std::vector<Rgb> towards(const scene::Camera&, const scene::Execution&) const;

  const NodeGrid& grid() const { return grid_; }
  std::size_t nodes_with_smoke() const { return nodes_.size(); }
  // For those who light it elsewhere: the nodes, mean densities of all cells, columns [m] of each direction at the nodes.
  const std::vector<Eigen::Index>& nodes() const { return nodes_; }
  const Eigen::ArrayXd& densities() const { return densities_; }
  const std::vector<std::vector<float>>& columns() const { return columns_; }
  // Visibility of the ordinates past surfaces (open_ways); empty without surfaces or without multiple scattering.
  const std::vector<std::vector<float>>& open() const { return open_; }
  const BeyondEdges& beyond() const { return beyond_; }
  // Factors on the swept radiance, for each channel and cell; empty: 1. Only smoke with hard edges has them.
  const std::array<Eigen::ArrayXd, 3>& balance() const { return balance_; }
  double deepest_cell() const { return deepest_; }
  const std::vector<scene::StageTime>& times() const { return times_; }  // of the last call that did something
  // Why multiple scattering is left out; empty where it is not.
  const std::string& single_only() const { return single_only_; }
  int iterations() const { return iterations_; }  // of the last light, over all channels
  double error() const { return error_; }         // of its solution, as it is estimated

 private:
  struct Channels {  // that have extinction and albedo in common
    std::vector<int> which;
    std::optional<DiscreteOrdinates> ordinates;
    std::optional<P1Grid> diffusion;  // one of the two
    std::optional<Moments> before;    // where to start from: a source, or radiance
  };
  void find_nodes(const IncomingLight&, const scene::Execution&);
  void find_channels();
  void add_depths(const IncomingLight&, std::size_t from, const scene::Execution&);
  double look_around(const IncomingLight&, const OrdinateOptions&, const scene::Execution&);
  void find_balance(const OrdinateOptions&, const scene::Execution&);
  void find_open_ways(const OrdinateOptions&, const scene::Execution&);
  using OfColumns =
      std::function<void(std::size_t first, std::size_t count, const std::function<void(const Vec3&, float*)>&)>;
  void in_columns(const scene::Execution&, const OfColumns&) const;
  Eigen::ArrayXXd left(std::size_t first, std::size_t count, double sigma_t) const;
  void in_runs(const scene::Execution&, const std::function<void(std::size_t, std::size_t)>&) const;
  Moments scatter_once(const Channels&, std::size_t lights, const Eigen::MatrixXd& scatters,
                       const scene::Execution&) const;
  void scatter_again(const IncomingLight&, const scene::Execution&);

  const scene::Scene& scene_;
  const scene::Medium& medium_;
  Options options_;
  NodeGrid grid_;
  BeyondEdges beyond_;
  Eigen::ArrayXd densities_;
  double deepest_ = 0;
  std::vector<Eigen::Index> nodes_;
  std::vector<double> phase_;  // moments, for light's bands
  std::vector<std::vector<float>>
      columns_;               // of each direction, at the nodes with smoke [m]; infinite where a surface is in the way
  std::vector<Vec3> toward_;  // the directions
  Eigen::ArrayX3d power_;     // of each
  std::vector<std::vector<float>> open_;
  Eigen::ArrayXXd even_;  // of an even light of 1 what the smoke leaves at each node with smoke, by channel
  std::array<Eigen::ArrayXd, 3> balance_;
  std::size_t fixed_ = 0;  // directions of environments
  std::vector<Channels> channels_;
  std::vector<std::vector<Rgb>> again_;  // J_ms of each node with smoke, order^2 coefficients; empty without
  std::string single_only_;
  int iterations_ = 0;
  double error_ = 0;
  std::vector<scene::StageTime> times_;
};

}  // namespace airlight::compensated_ray_marching
