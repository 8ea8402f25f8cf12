// A residual on the device, as a grid, as bricks with an apron or as a perfect hash: what residual.glsl reads.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "scene/convert/perfect_hash.h"
#include "scene/convert/residual_bricks.h"

namespace airlight::gpu::compensated_ray_marching {

// Storage blocks of residual.glsl and residual_levels.comp, AT_RESIDUAL_... in shaders.
namespace at {
enum ResidualBinding {
  residual_index = 12,  // of bricks; offsets of a hash; a grid has none
  residual_values = 13,
  residual_members = 14,  // bits of the domain, or tags beside the values
  residual_points = 0,
  residual_result = 1
};
}  // namespace at

class ResidualOnDevice {
 public:
  // How a hash tells which positions are stored.
  enum class Membership { tags, domain };

  // The residual of a frame of `size` samples as all its levels, x fastest. Throws Unavailable in one line where the device has no room.
  ResidualOnDevice(Context&, const Eigen::Vector3i& size, const std::vector<std::int8_t>& levels);
  // The residual of a frame of `size` samples as bricks. Throws Unavailable in one line where the device has no room.
  ResidualOnDevice(Context&, const Eigen::Vector3i& size, const scene::ApronBricks&);
  // The residual of a frame of `size` samples as a hash; the frame begins at `tile` of the domain of its
  // sequence's hash.
  ResidualOnDevice(Context&, const Eigen::Vector3i& size, const scene::PerfectHash&, Membership,
                   const Eigen::Vector3i& tile = Eigen::Vector3i::Zero());

  // For programs that include residual.glsl: which kind of residual, and the bindings.
  std::map<std::string, std::string> definitions() const;
  // Buffers and uniforms of the shader.
  void bind(Program&) const;
  // Size of the buffers: on the device a hash's offsets take 4 bytes each.
  std::size_t bytes() const;

 private:
  enum class Kind { grid, bricks, tagged, tagged_wide, domain };
  Kind kind_;
  Eigen::Vector3i size_, domain_ = Eigen::Vector3i::Zero(), tile_ = Eigen::Vector3i::Zero();
  int m_ = 0, r_ = 0;
  std::unique_ptr<Buffer> index_, values_, members_;
};

// The levels of the box of samples that begins at `first` (x fastest; 0 outside the frame), and levels between samples at points.
std::vector<int> levels_on_device(Context&, const ResidualOnDevice&, const Eigen::Vector3i& first,
                                  const Eigen::Vector3i& box);
std::vector<float> levels_between_on_device(Context&, const ResidualOnDevice&,
                                            const std::vector<Eigen::Vector4f>& points);

}  // namespace airlight::gpu::compensated_ray_marching
