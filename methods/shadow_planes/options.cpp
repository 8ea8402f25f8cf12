#include "methods/shadow_planes/options.h"

namespace airlight::shadow_planes {

std::vector<scene::SettingSpec> setting_specs() {
  using Type = scene::SettingSpec::Type;
  return {
      {"evaluator",
       Type::choice,
       "rule",
       "of a lit part of a ray: a mapped Gauss-Legendre rule, or the paper's polynomial in theta",
       0,
       0,
       {"rule", "polynomial"}},
      {"nodes", Type::integer, "64", "of the rule", 1, 1024, {}},
      {"stretch", Type::integer, "6", "m of the rule's map", 1, 16, {}},
      {"degree", Type::integer, "4", "of the polynomial", 0, 60, {}},
      {"centred",
       Type::flag,
       "false",
       "the polynomial about the middle of each lit part, not about theta = 0",
       0,
       0,
       {}},
      {"annex",
       Type::flag,
       "false",
       "the polynomial with the coefficients that the annex prints, errors included",
       0,
       0,
       {}},
      {"shadows",
       Type::choice,
       "counted",
       "none; by counting surfaces along the ray; as a signed sum over shadow planes, wrong where shadows overlap; by "
       "the "
       "paper's order of planes and stencil",
       0,
       0,
       {"none", "counted", "signed_sum", "stencil"}},
      {"edge_split", Type::integer, "1", "pieces of every silhouette edge, for the stencil's order", 1, 4096, {}},
      {"frame_buffer",
       Type::flag,
       "false",
       "the stencil's sums in a frame buffer of 8 bits that ends at radiance 1",
       0,
       0,
       {}},
      {"printed_phases", Type::flag, "false", "hazy and murky as printed, with means of 2 and 83/33", 0, 0, {}},
      {"ambient", Type::flag, "false", "adds the scene's ambient_in_scatter", 0, 0, {}},
      {"lights",
       Type::choice,
       "static",
       "static: silhouettes are found once, in preparation; moving: for every picture",
       0,
       0,
       {"static", "moving"}},
  };
}

Options read_options(const scene::Settings& settings) {
  Options o;
  o.evaluator = settings.text("evaluator") == "rule" ? Options::Evaluator::rule : Options::Evaluator::polynomial;
  o.nodes = int(settings.integer("nodes"));
  o.stretch = int(settings.integer("stretch"));
  o.degree = int(settings.integer("degree"));
  o.centred = settings.flag("centred");
  o.annex = settings.flag("annex");
  const std::string& shadows = settings.text("shadows");
  o.shadows = shadows == "none"      ? Options::Shadows::none
              : shadows == "counted" ? Options::Shadows::counted
              : shadows == "stencil" ? Options::Shadows::stencil
                                     : Options::Shadows::signed_sum;
  o.edge_split = int(settings.integer("edge_split"));
  o.frame_buffer = settings.flag("frame_buffer");
  o.printed_phases = settings.flag("printed_phases");
  o.ambient = settings.flag("ambient");
  o.moving_lights = settings.text("lights") == "moving";
  return o;
}

}  // namespace airlight::shadow_planes
