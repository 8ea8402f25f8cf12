#include "methods/shadow_planes/options.h"

#include <fmt/format.h>

#include <algorithm>

namespace airlight::shadow_planes {

std::vector<scene::SettingSpec> setting_specs() {
  return {
      scene::choice_setting("evaluator", "rule", {"rule", "polynomial"},
                            "of a lit part of a ray: a mapped Gauss-Legendre rule, or the paper's polynomial in theta"),
      scene::integer_setting("nodes", "64", 1, 1024, "of the rule"),
      scene::integer_setting("stretch", "6", 1, 16, "m of the rule's map"),
      scene::integer_setting("degree", "4", 0, 60, "of the polynomial"),
      scene::flag_setting("annex", false,
                          "the polynomial with the coefficients that the annex prints, errors included"),
      scene::choice_setting("shadows", "counted", {"none", "counted", "signed_sum", "stencil"},
                            "none; by counting surfaces along the ray; as a signed sum over shadow planes, wrong where "
                            "shadows overlap; by the paper's order of planes and stencil"),
      scene::integer_setting("edge_split", "1", 1, 4096, "pieces of every silhouette edge, for the stencil's order"),
      scene::choice_setting(
          "evaluation", "pixels", {"pixels", "vertices"},
          "of a lit ray's airlight: for every pixel; or at the vertices of meshes, shadow planes and media, "
          "linear between them, as the paper has it (other surfaces have no vertices: by pixel)"),
      scene::integer_setting(
          "plane_levels", "16", 1, 4096,
          "evaluation = vertices: strips of a shadow plane away from the light, in geometric progression"),
      scene::integer_setting(
          "boundary_cells", "16", 1, 1024,
          "evaluation = vertices, bounded = paper: cells along a side of the six faces of a medium's "
          "boundary; entries are sorted by its triangles"),
      scene::choice_setting(
          "bounded", "exact", {"exact", "paper"},
          "media in regions: exact; or as the paper has it, light through a mean length R of the medium, "
          "media that do not tint one another"),
      scene::flag_setting("frame_buffer", false,
                          "the stencil's sums in a frame buffer of 8 bits that ends at radiance 1"),
      scene::flag_setting("printed_phases", false, "hazy and murky as printed, with means of 2 and 83/33"),
      scene::flag_setting("ambient", false, "adds the scene's ambient_in_scatter"),
  };
}

Options read_options(const scene::Settings& settings) {
  Options o;
  o.evaluator = settings.choice<Options::Evaluator>("evaluator");
  o.nodes = int(settings.integer("nodes"));
  o.stretch = int(settings.integer("stretch"));
  o.degree = int(settings.integer("degree"));
  o.annex = settings.flag("annex");
  o.shadows = settings.choice<Options::Shadows>("shadows");
  o.edge_split = int(settings.integer("edge_split"));
  o.evaluation = settings.choice<Options::Evaluation>("evaluation");
  o.plane_levels = int(settings.integer("plane_levels"));
  o.boundary_cells = int(settings.integer("boundary_cells"));
  o.bounded = settings.choice<Options::Bounded>("bounded");
  o.frame_buffer = settings.flag("frame_buffer");
  o.printed_phases = settings.flag("printed_phases");
  o.ambient = settings.flag("ambient");
  return o;
}

std::string silhouettes_found(std::size_t edges, std::size_t lights) {
  return fmt::format("{} edges for {} light{}, found again where lights move", edges, lights, lights == 1 ? "" : "s");
}

std::vector<std::string> unsupported(const scene::Scene& scene, const Options& options) {
  std::vector<std::string> reasons;
  refuse_backdrops(scene, reasons);
  for (std::size_t i = 0; i < scene.media.size(); ++i)
    if (const std::string why = scene::unknown_field<scene::Homogeneous>(scene.media, i); !why.empty())
      reasons.push_back(why);
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (const std::string why = scene::unknown_light<scene::PointLight, scene::SpotLight>(scene.lights, i);
        !why.empty())
      reasons.push_back(why);
  const Point3& camera = scene.camera.position;
  const auto around_camera = [&](const scene::Medium& medium) {
    return (medium.sigma_t > 0).any() && contains(medium.region, camera);
  };
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (const auto ball = scene::ball(scene.lights[i]);
        ball && ball->center == camera && scene.camera.kind == scene::Camera::Kind::perspective &&
        std::any_of(scene.media.begin(), scene.media.end(), around_camera))
      reasons.push_back(fmt::format("light {} is at the camera inside a medium: its airlight is infinite", i));
  const bool paper = options.bounded == Options::Bounded::paper;
  if (options.evaluator == Options::Evaluator::rule && options.annex)
    reasons.push_back("annex = true is of the polynomial, expected evaluator = polynomial");
  if (options.frame_buffer && options.shadows != Options::Shadows::stencil &&
      options.evaluation != Options::Evaluation::vertices)
    reasons.push_back(
        "frame_buffer = true is of the paper's stages, expected shadows = stencil or evaluation = vertices");
  if (options.evaluator == Options::Evaluator::polynomial) {
    const bool whole = scene.media.size() == 1 && std::holds_alternative<scene::Unbounded>(scene.media.front().region);
    if (!scene.media.empty() && !whole && !paper)
      reasons.push_back("evaluator = polynomial is for one medium without a region, or bounded = paper");
    if (!scene.media.empty() && !whole && options.annex)
      reasons.push_back("annex = true: the annex has no coefficients for media in regions");
    for (const scene::Light& light : scene.lights)
      if (std::holds_alternative<scene::SpotLight>(light))
        reasons.push_back(
            "evaluator = polynomial is for point lights: the paper's series is of light alike in all directions, and a "
            "spot's edge has none");
    if (options.annex && scene.media.size() == 1 &&
        std::holds_alternative<scene::HenyeyGreenstein>(scene.media.front().phase))
      reasons.push_back("annex = true: the annex has no coefficients for Henyey-Greenstein");
  }
  if (paper)
    for (std::size_t i = 0; i < scene.media.size(); ++i)
      if (std::holds_alternative<scene::Slab>(scene.media[i].region))
        reasons.push_back(fmt::format("bounded = paper: medium {} is a slab, which has no mean distance R", i));
  if (options.evaluation == Options::Evaluation::vertices) {
    if (options.shadows != Options::Shadows::stencil && options.shadows != Options::Shadows::none)
      reasons.push_back("evaluation = vertices goes with shadows = stencil or none");
    if (scene.camera.kind != scene::Camera::Kind::perspective)
      reasons.push_back("evaluation = vertices is for perspective cameras: vertices are seen from one point");
  }
  return reasons;
}

bool same_media(const std::vector<scene::Medium>& all, const std::vector<scene::Medium>& others) {
  const auto g = [](const scene::PhaseFunction& phase) {
    const auto* hg = std::get_if<scene::HenyeyGreenstein>(&phase);
    return hg ? hg->g : 0;
  };
  const auto same_region = [](const scene::Region& a, const scene::Region& b) {
    return scene::match(
        a, [&](const scene::Unbounded&) { return std::holds_alternative<scene::Unbounded>(b); },
        [&](const Box& box) {
          const auto* other = std::get_if<Box>(&b);
          return other && box.lo == other->lo && box.hi == other->hi;
        },
        [&](const scene::Sphere& ball) {
          const auto* other = std::get_if<scene::Sphere>(&b);
          return other && ball.center == other->center && ball.radius == other->radius;
        },
        [&](const scene::Slab& slab) {
          const auto* other = std::get_if<scene::Slab>(&b);
          return other && slab.normal == other->normal && slab.lo == other->lo && slab.hi == other->hi;
        });
  };
  return std::equal(
      all.begin(), all.end(), others.begin(), others.end(), [&](const scene::Medium& a, const scene::Medium& b) {
        return (extinction_of(a) == extinction_of(b)).all() && (a.albedo == b.albedo).all() &&
               same_region(a.region, b.region) && a.phase.index() == b.phase.index() && g(a.phase) == g(b.phase);
      });
}

Rgb extinction_of(const scene::Medium& medium) { return medium.sigma_t * homogeneous_density(medium.field).value(); }

}  // namespace airlight::shadow_planes
