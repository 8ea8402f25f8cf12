// A scene prepared and drawn: light first, then the march. Zhou et al. 2008, sections 5.3 to 5.6.
#pragma once
#include <memory>
#include <string>

#include "methods/compensated_ray_marching/options.h"
#include "scene/renderer.h"

namespace airlight::compensated_ray_marching {

// `settings` goes into the film's metadata.
std::unique_ptr<scene::Prepared> prepare_picture(std::shared_ptr<const scene::Scene>, const Options&,
                                                 std::string settings, const scene::Execution&);

}  // namespace airlight::compensated_ray_marching
