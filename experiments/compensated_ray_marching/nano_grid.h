// A sparse grid in NanoVDB's layout, as something to compare residuals with: its size and what a look-up takes.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

namespace airlight::experiments {

class NanoGrid {
 public:
  enum class Values {
    floats,
    eight_bits
  };  // eight_bits: Fp8, between the least and the greatest value of each 8^3 leaf

  // `values`: size.prod(), x fastest; those that are 0 stay inactive.
  NanoGrid(const Eigen::Vector3i& size, const std::vector<float>& values, Values);
  ~NanoGrid();
  NanoGrid(const NanoGrid&) = delete;

  std::size_t bytes() const;  // of the whole grid, nodes and all
  float at(const Eigen::Vector3i& position) const;
  // The sum of the values at these positions, through one accessor, which remembers the last nodes.
  double sum_at(const std::vector<Eigen::Vector3i>& positions) const;

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

}  // namespace airlight::experiments
