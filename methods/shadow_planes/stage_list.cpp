#include "methods/shadow_planes/stage_list.h"

#include <fmt/format.h>

#include "scene/light/scattered_lights.h"

namespace airlight::shadow_planes {

std::vector<scene::Stage> stage_list(const scene::Scene& scene, const Options& options, const StageNeeds& needs) {
  const std::string clear = scene::why_nothing_scatters(scene);
  const auto unless = [](const std::string& reason, const std::string& otherwise) {
    return reason.empty() ? otherwise : reason;
  };
  const std::string no_shadows =
      unless(clear, scene.surfaces.empty()                      ? "there are no surfaces"
                    : options.shadows == Options::Shadows::none ? "shadows = none"
                                                                : "no surface stands between a light and the media");
  const std::string evaluator = options.evaluator == Options::Evaluator::rule ? fmt::format("{} nodes", options.nodes)
                                : options.annex ? std::string("the polynomials of the annex")
                                                : fmt::format("polynomials of degree {}", options.degree);
  const std::string surfaces = scene.surfaces.empty() ? "there are none"
                               : needs.surfaces       ? "direct light through the media"
                                                      : "no light shines";
  std::vector<scene::Stage> result{
      {"silhouettes", needs.shadows, needs.shadows ? silhouettes_found(needs.edges, needs.lights) : no_shadows}};
  if (needs.paper_stages) {
    const bool vertices = options.evaluation == Options::Evaluation::vertices;
    const std::string by_pixel = evaluator + " for every pixel";
    result.push_back({"surfaces and stencil", true, surfaces});
    result.push_back({"medium on surfaces", true,
                      vertices ? evaluator + " at the vertices of meshes and of media in the paper's way; for every "
                                             "pixel on spheres and planes, and where a ray meets nothing"
                               : by_pixel});
    result.push_back(
        {"sort", needs.shadows,
         needs.shadows ? fmt::format("{} planes once per picture", needs.edges * options.edge_split) : no_shadows});
    result.push_back({"shadow planes", needs.shadows,
                      !needs.shadows ? no_shadows
                      : vertices     ? fmt::format("{} on {} levels and at infinity; by pixel for spheres", evaluator,
                                                   options.plane_levels + 1)
                                     : by_pixel});
  } else {
    result.push_back({"airlight", needs.lights > 0, unless(clear, evaluator + " on each lit part")});
    result.push_back({"surfaces", needs.surfaces, surfaces});
  }
  result.push_back({"ambient in-scatter", options.ambient,
                    options.ambient ? "asked for" : "ambient = false: not a part of single scattering"});
  return result;
}

}  // namespace airlight::shadow_planes
