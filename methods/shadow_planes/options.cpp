#include "methods/shadow_planes/options.h"

#include <fmt/format.h>

#include <algorithm>

namespace airlight::shadow_planes {

namespace {

void bind(scene::SettingBinder& b, Options& o) {
  using Evaluator = Options::Evaluator;
  using Shadows = Options::Shadows;
  using Evaluation = Options::Evaluation;
  using Bounded = Options::Bounded;
  b.choice("evaluator", o.evaluator, {{"rule", Evaluator::rule}, {"polynomial", Evaluator::polynomial}},
           "of a lit part of a ray: a mapped Gauss-Legendre rule, or the paper's polynomial in theta");
  b.integer("nodes", o.nodes, 1, 1024, "of the rule").where("evaluator", {"rule"});
  b.integer("stretch", o.stretch, 1, 16, "m of the rule's map").where("evaluator", {"rule"});
  b.integer("degree", o.degree, 0, 60, "of the polynomial")
      .where("evaluator", {"polynomial"})
      .where("annex", {"false"});
  b.flag("annex", o.annex, "the polynomial with the coefficients that the annex prints, errors included")
      .where("evaluator", {"polynomial"});
  b.choice("shadows", o.shadows,
           {{"none", Shadows::none},
            {"counted", Shadows::counted},
            {"signed_sum", Shadows::signed_sum},
            {"stencil", Shadows::stencil}},
           "none; by counting surfaces along the ray; as a signed sum over shadow planes, wrong where "
           "shadows overlap; by the paper's order of planes and stencil");
  b.integer("edge_split", o.edge_split, 1, 4096, "pieces of every silhouette edge, for the stencil's order")
      .where("shadows", {"stencil"});
  b.choice("evaluation", o.evaluation, {{"pixels", Evaluation::pixels}, {"vertices", Evaluation::vertices}},
           "of a lit ray's airlight: for every pixel; or at the vertices of meshes, shadow planes and media, "
           "linear between them, as the paper has it (other surfaces have no vertices: by pixel)");
  b.integer("plane_levels", o.plane_levels, 1, 4096,
            "evaluation = vertices: strips of a shadow plane away from the light, in geometric progression")
      .where("evaluation", {"vertices"})
      .where("shadows", {"stencil"});
  // The stencil sorts entries into a medium by its triangles even where no vertex is evaluated.
  b.integer("boundary_cells", o.boundary_cells, 1, 1024,
            "evaluation = vertices, bounded = paper: cells along a side of the six faces of a medium's "
            "boundary; entries are sorted by its triangles")
      .where("bounded", {"paper"})
      .where("shadows", {"stencil"})
      .or_where("bounded", {"paper"})
      .where("evaluation", {"vertices"});
  b.choice("bounded", o.bounded, {{"exact", Bounded::exact}, {"paper", Bounded::paper}},
           "media in regions: exact; or as the paper has it, light through a mean length R of the medium, "
           "media that do not tint one another");
  b.flag("frame_buffer", o.frame_buffer, "the stencil's sums in a frame buffer of 8 bits that ends at radiance 1")
      .where("shadows", {"stencil"})
      .or_where("evaluation", {"vertices"});
  b.flag("printed_phases", o.printed_phases, "hazy and murky as printed, with means of 2 and 83/33");
  b.flag("ambient", o.ambient, "adds the scene's ambient_in_scatter");
}

}  // namespace

std::vector<scene::SettingSpec> setting_specs(const Options& defaults) { return scene::list_settings(bind, defaults); }

Options read_options(const scene::Settings& settings) { return scene::read_settings(bind, settings); }

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
