#include "reference/froxel_fog/doubt.h"

#include "reference/froxel_fog/fit.h"
#include "reference/lit_media/doubt.h"

namespace airlight::froxel_fog {

std::string doubt_of(const lit_media::LitMedia& media, const Options& options, Interval range,
                     const scene::Scene& scene, const scene::View& view) {
  const Slices slices = slices_of(options, range);
  return lit_media::doubt_of_steps(media, scene, view, [&](const Ray& ray, double t_end, std::vector<double>& ends) {
    const double along = depth_per_metre(view.camera, ray);
    for (int k = 0; k <= slices.count(); ++k) {
      ends.push_back(slices.decode(double(k) / slices.count()) / along);
      if (ends.back() >= t_end) break;
    }
  });
}

}  // namespace airlight::froxel_fog
