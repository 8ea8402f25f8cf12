#include "gpu/fogshop/surface_pass.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "gpu/fogshop/interface.h"
#include "gpu/view_uniforms.h"

namespace airlight::gpu::fogshop {
namespace {

constexpr int listed_bytes =
    32;  // that an invocation of the surfaces has in shared memory for Gaussians (light_lists.glsl)

std::vector<double> light_places(const airlight::fogshop::Model& model) {
  std::vector<double> places;
  for (const airlight::fogshop::LightModel& light : model.lights)
    places.insert(places.end(), light.position.data(), light.position.data() + 3);
  return places;
}

double magnitude(const scene::Scene& scene) {
  double most = 0;
  if (const Box box = scene.geometry->bounds(); !box.empty())
    most = std::max(box.lo.cwiseAbs().maxCoeff(), box.hi.cwiseAbs().maxCoeff());
  for (const scene::Surface& surface : scene.surfaces)
    if (const auto* plane = std::get_if<scene::Plane>(&surface.shape))
      most = std::max(most, plane->point.cwiseAbs().maxCoeff());
  return most;
}

// A lone plane or sphere shadows itself alone, where it is turned away from the light.
bool casts_shadows(const scene::Scene& scene) {
  return scene.surfaces.size() > 1 ||
         (scene.surfaces.size() == 1 && std::holds_alternative<scene::TriangleMesh>(scene.surfaces.front().shape));
}

// A cell's polynomial for shaders, without loops: the coefficients c(k) of CellPolynomial, `x` the place in the cell.
std::string horner() {
  int k = 0;
  // From the coefficient of highest order down: sum = sum * variable + next, as long as degrees are left.
  const auto series = [](int degree, char variable, const auto& next) {
    std::vector<std::string> terms;
    for (int i = 0; i <= degree; ++i) terms.push_back(next(degree - i));
    std::string sum = terms.back();
    for (int i = degree - 1; i >= 0; --i) sum = fmt::format("({} * x.{} + {})", sum, variable, terms[i]);
    return sum;
  };
  return series(airlight::fogshop::CellPolynomial::degree, 'x', [&](int left) {
    return series(left, 'y',
                  [&](int rest) { return series(rest, 'z', [&](int) { return fmt::format("c({})", k++); }); });
  });
}

}  // namespace

SurfaceShading::SurfaceShading(Context& context, const scene::Scene& scene, const airlight::fogshop::Model& model,
                               const airlight::fogshop::SurfaceLighting& lighting, const FogOnDevice& fog)
    : context_(context),
      model_(model),
      lighting_(lighting),
      magnitude_(magnitude(scene)),
      casts_shadows_(casts_shadows(scene)) {
  upload_tables(scene, fog);
  become(scene, fog, {});
}

bool SurfaceShading::become(const scene::Scene& scene, const FogOnDevice& fog,
                            const airlight::fogshop::Unchanged& same) {
  const Use use(context_);
  const bool tables_too = !(uploaded_ == lighting_);
  if (tables_too) upload_tables(scene, fog);
  std::vector<double> lights_at = light_places(model_);
  const bool moved = lights_at != lights_at_ || !light_places_;
  if (moved) refill(light_places_, context_, "light positions", lights_at);
  lights_at_ = std::move(lights_at);
  const bool lists = (moved || !same.gaussians) && !model_.lights.empty() && model_.gaussians.count > 0;
  if (lists) list_gaussians(fog);
  check_iterations(context_,
                   double(model_.lights.size()) * (model_.gaussians.count + 60 + light_iterations_) + iterations_ +
                       (lighting_.environment ? model_.gaussians.count : 0),
                   "light on surfaces");
  return tables_too || moved || lists;
}

void SurfaceShading::upload_tables(const scene::Scene& scene, const FogOnDevice& fog) {
  const Use use(context_);
  const SurfaceTables tables(scene, lighting_);
  refill(materials_, context_, "materials", tables.materials);
  refill(tables_, context_, "tables of surfaces", tables.values);
  if (!transfer_ || uploaded_.transfer != lighting_.transfer)
    refill(transfer_, context_, "radiance transfer", tables.transfer);
  uniforms_ = tables.uniforms;
  iterations_ = tables.iterations;
  light_iterations_ = tables.light_iterations;
  uploaded_ = lighting_;
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  const bool harmonics = lighting_.reflectances != nullptr, environment = lighting_.environment != nullptr,
             transfer = lighting_.transfer != nullptr;
  const bool tabulated =
      harmonics && std::any_of(lighting_.reflectances->tables().begin(), lighting_.reflectances->tables().end(),
                               [](const auto& table) { return table.has_value(); });
  const bool turned = tabulated && (environment || transfer);
  // The work group has as many rows of invocations as fit into shared memory (harmonics.glsl, transfer.glsl).
  const int order = model_.options.sh_order, rows = (turned ? 2 * (2 * order - 1) : 0) + order;
  const int held = 4 * (3 * rows + (transfer ? (tabulated ? 4 : 2) * order * order : 0));  // [B]
  int height = 8;
  while (height > 1 && 8 * height * (held + listed_bytes) > 32000) height /= 2;
  Definitions definitions{{"LOCAL_SIZE_X", "8"},
                          {"LOCAL_SIZE_Y", std::to_string(height)},
                          {"TABULATED", flag(tabulated)},
                          {"TURNED", flag(turned)},
                          {"SH_ORDER", std::to_string(order)},
                          {"HARMONICS", flag(harmonics)},
                          {"TRANSFER", flag(transfer)},
                          {"ENVIRONMENT", flag(environment)},
                          {"DEPTH_TREE", flag(lighting_.depths != nullptr)},
                          {"TREE_POLYNOMIAL", horner()},
                          {"TREE_COEFFICIENTS", std::to_string(airlight::fogshop::CellPolynomial::size)},
                          {"SUN", flag(lighting_.points && lighting_.points->sun())}};
  definitions.merge(dawson_definitions());
  program_ = &fog.program("fogshop/surfaces.comp", definitions);
}

// Lists the Gaussians by direction, with as many cells as the lists have room for.
void SurfaceShading::list_gaussians(const FogOnDevice& fog) {
  constexpr int group = 64;
  constexpr std::size_t most_bytes = std::size_t(64) << 20;
  const int lights = int(model_.lights.size());
  Program* const programs[] = {
      &fog.program("fogshop/light_lists.comp", {{"LOCAL_SIZE_X", std::to_string(group)}, {"FILL", "0"}}),
      &fog.program("fogshop/light_lists.comp", {{"LOCAL_SIZE_X", std::to_string(group)}, {"FILL", "1"}})};
  const auto run = [&](Program& p, const Buffer& buffer) {
    fog.use(p);
    fog.bind();
    buffer.bind(at::light_lists);
    p.set("cells", cells_);
    p.set("light_count", lights);
    p.dispatch(group * cells_ * lights, cells_);
  };
  std::vector<int> begins;
  for (cells_ = 32; begins.empty(); cells_ /= 2) {
    const int count = lights * cells_ * cells_;
    reserve(numbers_, context_, "numbers of Gaussians by direction", std::size_t(count) * 4);
    run(*programs[0], *numbers_);
    std::vector<int> each = numbers_->download<int>();
    each.resize(std::size_t(count));
    const double all = std::accumulate(each.begin(), each.end(), double(count + 1));
    if (4 * all > double(most_bytes) && cells_ > 2) continue;
    begins.assign(1, count + 1);
    for (const int n : each) begins.push_back(begins.back() + n);
    reserve(lists_, context_, "Gaussians by direction", std::size_t(begins.back()) * 4);
    lists_->upload(begins);
    run(*programs[1], *lists_);
    break;
  }
}

void SurfaceShading::shade(const FogOnDevice& fog, const FirstHits& hits, const scene::View& view,
                           const Buffer& primitives, const Buffer* pixels, const Buffer& surface,
                           const Buffer* scattered) {
  const Use use(context_);
  const SurfacesOnDevice& surfaces = hits.surfaces();
  Program& p = *program_;
  fog.use(p);
  fog.bind();
  surfaces.bind();
  materials_->bind(at::materials);
  light_places_->bind(at::light_places);
  tables_->bind(at::surface_tables);
  if (lighting_.transfer) transfer_->bind(at::transfer);
  primitives.bind(at::primitives);
  if (lists_) lists_->bind(at::light_lists);
  hits.tree().bind(p);
  if (pixels) pixels->bind(at::pixels);
  surface.bind(at::surface);
  if (scattered) scattered->bind(at::scattered);
  set_view(p, view);
  p.set("light_count", int(model_.lights.size()));
  p.set("cells", cells_);
  p.set("triangle_count", surfaces.triangles());
  p.set("loop_count", 3);
  p.set("casts_shadows", casts_shadows_);
  p.set("has_airlight", pixels != nullptr);
  p.set("has_scattered", scattered != nullptr);
  for (const auto& [name, place] : uniforms_) p.set(name, place);
  if (lighting_.reflectances) {
    p.set("sh_order", model_.options.sh_order);
    p.set("least_depth", airlight::fogshop::PsfBands::least_depth);
    p.set("greatest_depth", airlight::fogshop::PsfBands::greatest_depth);
  }
  const double constant = model_.fog.sum.constant;
  p.set("environment_depth", constant > 0 ? constant * model_.options.environment_distance : 0.0);
  if (const airlight::fogshop::DepthTree* tree = lighting_.depths.get()) {
    p.set_double("tree_corner", tree->corner());
    p.set_double("tree_scale", tree->side() > 0 ? 4294967296.0 / tree->side() : 0.0);
    p.set("tree_center", tree->center());
    p.set("tree_far", tree->far());
  }
  // Offset of Geometry::offset_origin: 32 ulp of the largest coordinate, the camera included.
  const double reach = std::max(magnitude_, view.camera.position.cwiseAbs().maxCoeff());
  p.set_double("nudge", 32 * std::numeric_limits<double>::epsilon() * reach);
  p.dispatch(view.width, view.height);
}

}  // namespace airlight::gpu::fogshop
