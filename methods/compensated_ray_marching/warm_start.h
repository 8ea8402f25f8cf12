// Where the iterations of multiple scattering begin when the smoke has changed: with the solution in the last frame's smoke, taken along with
// the smoke or interpolated at the new centres or nodes. Zhou et al. 2008, section 5.4.
#pragma once
#include <array>

#include "methods/compensated_ray_marching/node_grid.h"
#include "scene/renderer.h"

namespace airlight::compensated_ray_marching {

// The solution of one frame, by channel: at the centres of Gaussians one column, the mean radiance; at the nodes of a grid the coefficients
// that its solver starts from. A channel without a solution has no rows.
struct Solution {
  std::vector<scene::Gaussian> centres;
  NodeGrid nodes;
  std::array<Eigen::ArrayXXd, 3> of_channel;
  bool empty() const;
};

// At other centres: the mean of the values weighted with the Gaussians (Eq. 7), 0 where none of them has a weight. Gaussians that are the
// same but for their places take their values along. Nothing where the solution is not one at centres.
Eigen::VectorXd at_centres(const Solution&, int channel, const std::vector<scene::Gaussian>&);

// At the nodes of another grid: trilinear, 0 beyond the nodes. A grid that is the same but for its place takes its values along: it goes with
// the smoke. Nothing where the solution is not
// one of `columns` columns at nodes.
Eigen::ArrayXXd at_nodes(const Solution&, int channel, const NodeGrid&, Eigen::Index columns);

// A preparation that becomes that of other smoke: everything but the start of the iterations is made anew. Picture::next knows of other
// lights; Picture::in_other_smoke(scene, execution) is null where there is no solution to begin with.
template <class Picture>
class PreparedSequence final : public scene::Prepared {
 public:
  explicit PreparedSequence(std::unique_ptr<Picture> first) : now_(std::move(first)) {}
  std::vector<scene::Stage> stages() const override { return now_->stages(); }
  std::vector<scene::StageTime> prepare_times() const override { return now_->prepare_times(); }
  scene::Rendering render(const scene::View& view, const scene::Execution& execution) const override {
    return now_->render(view, execution);
  }
  std::optional<std::vector<scene::StageTime>> next(std::shared_ptr<const scene::Scene> scene,
                                                    const scene::Execution& execution) override {
    if (auto times = now_->next(scene, execution)) return times;
    std::unique_ptr<Picture> other = now_->in_other_smoke(std::move(scene), execution);
    if (!other) return std::nullopt;
    now_ = std::move(other);
    return now_->prepare_times();
  }

 private:
  std::unique_ptr<Picture> now_;
};

}  // namespace airlight::compensated_ray_marching
