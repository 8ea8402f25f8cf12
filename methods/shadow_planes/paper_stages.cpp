#include "methods/shadow_planes/paper_stages.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "methods/shadow_planes/general_position.h"
#include "scene/base/error.h"

namespace airlight::shadow_planes {
namespace {

constexpr double most_bytes = 1.5e9;

std::array<Vec3, 8> corners(const Box& box) {
  std::array<Vec3, 8> result;
  for (int i = 0; i < 8; ++i)
    result[i] = {i & 1 ? box.hi[0] : box.lo[0], i & 2 ? box.hi[1] : box.lo[1], i & 4 ? box.hi[2] : box.lo[2]};
  return result;
}

double farthest_corner(const Box& box, const Point3& from) {
  double most = 0;
  for (const Vec3& corner : corners(box)) most = std::max(most, (corner - from).norm());
  return most;
}

// Is the box on one side of the plane of an edge and the light, or beside or before the wedge behind the edge? Then the
// shadow plane cannot cut it.
bool misses(const SilhouetteEdge& edge, const Point3& light, const Box& box) {
  const Vec3 normal = edge.a.cross(edge.b), by_a = normal.cross(edge.a), by_b = edge.b.cross(normal);
  const Vec3 across = normal.cross(edge.b - edge.a);  // away from the edge, towards the light
  int above = 0, below = 0, outside_a = 0, outside_b = 0, before = 0;
  for (const Vec3& corner : corners(box)) {
    const Vec3 c = corner - light;
    above += normal.dot(c) > 0;
    below += normal.dot(c) < 0;
    outside_a += by_a.dot(c) < 0;
    outside_b += by_b.dot(c) < 0;
    before += across.dot(c - edge.a) > 0;
  }
  return above == 8 || below == 8 || outside_a == 8 || outside_b == 8 || before == 8;
}

// From where the ray enters the first medium to where it leaves the last: Gamma is constant elsewhere. Empty if
// nowhere.
Interval within(const std::vector<scene::Medium>& media, const Ray& ray, double end) {
  Interval all;
  for (const scene::Medium& m : media)
    if (const Interval one = clip(m.region, ray, {0, end}); !one.empty())
      all = {std::min(all.lo, one.lo), std::max(all.hi, one.hi)};
  return all;
}

}  // namespace

bool all_end(const std::vector<scene::Medium>& media) {
  return std::all_of(media.begin(), media.end(),
                     [](const scene::Medium& m) { return std::isfinite(bounding_box(m.region).size().sum()); });
}

double mesh_reach(const scene::Scene& scene, const scene::Region* region, const Point3& light, const Point3& camera,
                  int levels) {
  if (region) return farthest_corner(bounding_box(*region), light);
  if (all_end(scene.media)) {
    double most = 0;
    for (const scene::Medium& m : scene.media) most = std::max(most, farthest_corner(bounding_box(m.region), light));
    return most;
  }
  const double most = std::max((camera - light).norm(), farthest_corner(scene.geometry->bounds(), light));
  return most * std::max(1.0, levels / 4.0);
}

// Working memory for one light and one tile.
struct PaperStages::Work {
  std::vector<Crossing> crossings;
  std::vector<std::size_t> first;  // of a pixel's crossings, and of the next pixel's
  std::vector<Interval> domain;    // where the ray is in the air; empty: nowhere
  std::vector<int> stencil;
  std::vector<Rgb> sum;
};

PaperStages::PaperStages(const scene::Scene& scene, const std::vector<scene::Light>& lights, const Options& options,
                         const std::vector<AirlightTerm>& airlight_terms, const std::vector<ShadowVolumes>& shadows,
                         const scene::Camera& camera, int threads)
    : scene_(scene), lights_(lights), options_(options), airlight_terms_(airlight_terms), shadows_(shadows) {
  const bool vertices = options.evaluation == Options::Evaluation::vertices;
  scene::Stopwatch watch;
  for (std::size_t l = 0; l < lights.size(); ++l) {
    std::vector<Part>& of_light = parts_.emplace_back();
    for (const AirlightTerm& term : airlight_terms) {
      Part& part = of_light.emplace_back();
      part.medium = std::get_if<PaperMedium>(&term);
      if (vertices) part.at_vertices.emplace(term, lights[l], camera.position);
      part.planes_end = vertices && !part.medium && all_end(scene.media);
      if (l >= shadows.size()) continue;
      part.left_out.assign(shadows[l].edges().size(), false);
      for (std::size_t i = 0; i < part.left_out.size() && part.medium; ++i)
        part.left_out[i] = misses(shadows[l].edges()[i], shadows[l].light(), bounding_box(part.medium->region()));
      planes_ += options.edge_split * std::size_t(std::count(part.left_out.begin(), part.left_out.end(), false));
    }
  }
  check_memory();
  for (const ShadowVolumes& s : shadows) orders_.emplace_back(s, camera, options.edge_split);
  for (std::size_t l = 0; l < lights.size(); ++l) {
    const Point3 at = scene::ball(lights[l])->center;
    const Vec3 to_camera = (camera.position - at).normalized();
    for (Part& part : parts_[l]) {
      if (!part.medium) continue;
      part.boundary.emplace(part.medium->region(), options.boundary_cells);
      part.triangle_key.reserve(part.boundary->triangles().size());
      for (const auto& t : part.boundary->triangles()) {
        Vec3 middle = Vec3::Zero();
        for (const int v : t) middle += part.boundary->vertices()[v] / 3;
        part.triangle_key.push_back(order_key(middle - at, to_camera));
      }
    }
  }
  seconds_.sort = watch.lap();
  if (!vertices) return;
  for (std::vector<Part>& of_light : parts_)
    for (Part& part : of_light) {
      part.at_vertices->evaluate_surfaces(scene.surfaces,
                                          part.medium ? bounding_box(part.medium->region()) : everywhere, threads);
      if (part.boundary) part.at_vertices->evaluate_boundary(*part.boundary, threads);
    }
  seconds_.ends = watch.lap();
  for (std::size_t l = 0; l < shadows.size(); ++l)
    for (Part& part : parts_[l])
      part.at_vertices->evaluate_planes(PlaneMesh(shadows[l], part.left_out,
                                                  mesh_reach(scene, part.medium ? &part.medium->region() : nullptr,
                                                             shadows[l].light(), camera.position, options.plane_levels),
                                                  options.edge_split, options.plane_levels),
                                        threads);
  seconds_.planes = watch.lap();
}

// Checks the memory of all lights and media together; each mesh alone can be within its own limit.
void PaperStages::check_memory() const {
  const double cells = options_.boundary_cells, pieces = options_.edge_split, levels = options_.plane_levels;
  const bool vertices = options_.evaluation == Options::Evaluation::vertices;
  double bytes = 0;
  for (const ShadowVolumes& s : shadows_) bytes += double(s.edges().size()) * pieces * sizeof(double);
  double on_surfaces = 0;
  for (const scene::Surface& surface : scene_.surfaces)
    if (const auto* mesh = std::get_if<scene::TriangleMesh>(&surface.shape))
      on_surfaces += double(mesh->vertices.size());
  for (const std::vector<Part>& of_light : parts_)
    for (const Part& part : of_light) {
      const double on_boundary = part.medium ? 6 * (cells + 1) * (cells + 1) : 0;
      const double kept = double(std::count(part.left_out.begin(), part.left_out.end(), false));
      const double on_planes = vertices ? kept * (pieces + 1) * (levels + 2) : 0;
      bytes += on_boundary * sizeof(Point3) + on_planes * sizeof(Vertex);
      if (part.medium) bytes += 12 * cells * cells * (sizeof(std::array<int, 3>) + sizeof(double));
      if (vertices) bytes += (on_boundary + on_planes + on_surfaces) * sizeof(Rgb);
    }
  if (bytes > most_bytes)
    throw Error(
        fmt::format("{}: shadow_planes would hold {:.1f} GB for {} lights and {} media with edge_split = {}, "
                    "plane_levels = {} and boundary_cells = {}, expected at most {} GB: fewer plane_levels, "
                    "edge_split or boundary_cells",
                    scene_.name, bytes / 1e9, lights_.size(), scene_.media.size(), options_.edge_split,
                    options_.plane_levels, options_.boundary_cells, most_bytes / 1e9));
}

std::size_t PaperStages::vertices() const {
  std::size_t sum = 0;
  for (const std::vector<Part>& of_light : parts_)
    for (const Part& part : of_light) sum += part.at_vertices ? part.at_vertices->count() : 0;
  return sum;
}

void PaperStages::draw(std::size_t l, const EdgeFan* fan, std::optional<int> count, std::vector<Pixel>& pixels,
                       Counts& counts, StageSeconds& seconds) const {
  scene::Stopwatch watch;
  Work work;
  work.first.push_back(0);
  for (const Pixel& pixel : pixels) work.sum.push_back(pixel.airlight);  // the frame buffer is that of all lights
  std::vector<int> at_origin(pixels.size(), 0), edges;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!shadows_.empty() && in_air(airlight_terms_, pixels[i].ray, pixels[i].end.t)) {
      const Ray ray = ray_in_general_position(pixels[i].ray, shadows_[l].light());
      fan->of_ray(ray, edges);
      shadows_[l].cross_edges(ray, pixels[i].end.t, edges, work.crossings);
      shadows_[l].cross_spheres(ray, pixels[i].end.t, work.crossings);
      at_origin[i] = count ? *count : shadows_[l].count(ray.origin);
    }
    work.first.push_back(work.crossings.size());
  }
  counts.crossings += double(work.crossings.size());
  seconds.scene += watch.lap();
  // Stage 4, before 2 and 3, since it needs nothing of them.
  for (std::size_t i = 0; i < pixels.size() && !shadows_.empty(); ++i)
    orders_[l].sort(pixels[i].ray, work.crossings.data() + work.first[i], work.crossings.data() + work.first[i + 1]);
  seconds.sort += watch.lap();
  for (std::size_t a = 0; a < airlight_terms_.size(); ++a) {
    work.stencil = at_origin;
    draw_ends(l, a, pixels, work, counts);
    seconds.ends += watch.lap();
    draw_planes(l, a, pixels, work, counts);
    seconds.planes += watch.lap();
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i].airlight = work.sum[i];
}

// Stage 2: the stencil at the ray's end. Stage 3: light up to where the ray leaves the air, or ends, if the stencil is 0 there.
void PaperStages::draw_ends(std::size_t l, std::size_t a, const std::vector<Pixel>& pixels, Work& work,
                            Counts& counts) const {
  work.domain.resize(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const PaperMedium* medium = parts_[l][a].medium;
    work.domain[i] = {0, pixels[i].end.t};
    if (medium) work.domain[i] = clip(medium->region(), pixels[i].ray, work.domain[i]);
    if (parts_[l][a].planes_end) work.domain[i] = within(scene_.media, pixels[i].ray, pixels[i].end.t);
    if (!work.domain[i].empty() && extent(airlight_terms_[a], pixels[i].ray, work.domain[i]).empty())
      work.domain[i] = {};
    if (work.domain[i].empty()) continue;
    for (std::size_t k = work.first[i]; k < work.first[i + 1]; ++k)
      if (work.crossings[k].x < work.domain[i].hi) work.stencil[i] += work.crossings[k].change;
    if (work.stencil[i] == 0) add(work.sum[i], to_end(l, a, pixels[i], work.domain[i], counts));
  }
}

Rgb PaperStages::to_end(std::size_t l, std::size_t a, const Pixel& pixel, Interval domain, Counts& counts) const {
  const Part& part = parts_[l][a];
  counts.parts += 1;
  if (part.at_vertices) {
    if (part.medium && domain.hi < pixel.end.t)
      return part.at_vertices->on_boundary(*part.boundary, part.boundary->locate(pixel.ray.at(domain.hi)));
    if (pixel.end.hit)
      if (const auto value = part.at_vertices->on_surface(scene_.surfaces, *pixel.end.hit)) return *value;
  }
  counts.by_pixel += 1;
  return airlight(airlight_terms_[a], lights_[l], pixel.ray, {0, domain.hi});
}

// Stage 5: each plane adds or takes away all light in front of it. Sections 4 and 6 of the paper contradict each other: there, front faces
// increment the stencil; by its Figure 6 they subtract from it. The latter is right from back to front: a front face is where shadow ends.
void PaperStages::draw_planes(std::size_t l, std::size_t a, const std::vector<Pixel>& pixels, Work& work,
                              Counts& counts) const {
  const Part& part = parts_[l][a];
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (work.domain[i].empty() || work.first[i] == work.first[i + 1]) continue;
    // Where the ray enters a medium the stencil becomes 255 (end of section 5.2): nothing that is sorted in front of it is drawn. Light is
    // counted from there, so that there is none to take away.
    double entry = infinity;
    if (part.medium && work.domain[i].lo > 0)
      entry = part.triangle_key[part.boundary->locate(pixels[i].ray.at(work.domain[i].lo)).triangle];
    int& stencil = work.stencil[i];
    for (std::size_t k = work.first[i]; k < work.first[i + 1] && work.crossings[k].order < entry; ++k) {
      const Crossing& crossing = work.crossings[k];
      if (crossing.x >= work.domain[i].hi || (crossing.edge >= 0 && part.left_out[crossing.edge])) continue;
      // A front face, where the ray enters a shadow, is drawn where nothing else shades what lies behind it (the paper's stencil of 1); a back
      // face where that is lit. Closed meshes change the count by 2. The order is the paper's, not the ray's: counts below 0 may come out.
      const double sign = crossing.change > 0 && stencil == crossing.change ? 1
                          : crossing.change < 0 && stencil == 0             ? -1
                                                                            : 0;
      stencil = std::max(0, stencil - crossing.change);
      if (sign == 0 || (part.planes_end && crossing.x <= work.domain[i].lo)) continue;
      counts.parts += 1;
      if (part.at_vertices && crossing.edge >= 0) {
        add(work.sum[i], sign * part.at_vertices->on_plane(crossing));
      } else {
        counts.by_pixel += 1;
        add(work.sum[i], sign * airlight(airlight_terms_[a], lights_[l], pixels[i].ray, {0, crossing.x}));
      }
    }
  }
}

void PaperStages::add(Rgb& sum, const Rgb& value) const {
  sum += value;
  // The frame buffer has 8 bits and ends at 1 (section 6).
  if (options_.frame_buffer) sum = ((sum * 255).round() / 255).max(0.0).min(1.0);
}

}  // namespace airlight::shadow_planes
