// Which view depths the slices of a picture cover.
#pragma once
#include "reference/froxel_fog/options.h"
#include "scene/renderer.h"

namespace airlight::froxel_fog {

constexpr double fitted_depth = 16;  // optical depth at which endless media end: 1e-7 of the light comes from beyond

// View depth of a metre along a ray of this camera.
double depth_per_metre(const scene::Camera&, const Ray&);

// Where media begin and end in view depth, over the rays through all pixels up to what ends them; empty where no ray meets a medium. A ray
// ends where it is `fitted_depth` deep in media that have a constant density.
Interval media_depths(const lit_media::Plan&, const scene::View&, const scene::Execution&);

// The range of the slices as the options say; empty where it is fitted and there are no media in it.
Interval slice_range(const Options&, Interval media);

}  // namespace airlight::froxel_fog
