#include "experiments/application/renderers.h"

#include <algorithm>

#include "experiments/application/find_component.h"
#include "gpu/compensated_ray_marching/compensated_ray_marching.h"
#include "gpu/fogshop/fogshop.h"
#include "gpu/froxel_fog/froxel_fog.h"
#include "gpu/half_resolution_march/half_resolution_march.h"
#include "gpu/legendre_fluids/light.h"
#include "gpu/ray_marcher/ray_marcher.h"
#include "gpu/shadow_planes/shadow_planes.h"
#include "gpu/wavelet_fog/wavelet_fog.h"
#include "methods/compensated_ray_marching/compensated_ray_marching.h"
#include "methods/fogshop/fogshop.h"
#include "methods/legendre_fluids/light.h"
#include "methods/shadow_planes/shadow_planes.h"
#include "methods/wavelet_fog/wavelet_fog.h"
#include "reference/deterministic/renderer.h"
#include "reference/froxel_fog/froxel_fog.h"
#include "reference/half_resolution_march/half_resolution_march.h"
#include "reference/path_tracer/renderer.h"
#include "reference/ray_marcher/ray_marcher.h"
#include "scene/base/content_key.h"
#include "scene/base/read_file.h"

namespace airlight::experiments {

namespace {

using Renderers = std::vector<std::unique_ptr<scene::Renderer>>;

Renderers& the_list() {
  static Renderers renderers = [] {
    Renderers list;
    list.push_back(deterministic::make_renderer());
    list.push_back(std::make_unique<path_tracer::PathTracer>());
    list.push_back(std::make_unique<ray_marcher::RayMarcher>());
    list.push_back(std::make_unique<gpu::ray_marcher::RayMarcher>());
    list.push_back(std::make_unique<half_resolution_march::HalfResolutionMarch>());
    list.push_back(std::make_unique<gpu::half_resolution_march::HalfResolutionMarch>());
    list.push_back(std::make_unique<froxel_fog::FroxelFog>());
    list.push_back(std::make_unique<gpu::froxel_fog::FroxelFog>());
    list.push_back(std::make_unique<fogshop::Fogshop>());
    list.push_back(std::make_unique<gpu::fogshop::Fogshop>());
    list.push_back(std::make_unique<airlight::shadow_planes::ShadowPlanes>());
    list.push_back(std::make_unique<gpu::shadow_planes::ShadowPlanes>());
    list.push_back(std::make_unique<wavelet_fog::WaveletFog>());
    list.push_back(std::make_unique<gpu::wavelet_fog::WaveletFog>());
    list.push_back(std::make_unique<legendre_fluids::LegendreLight>());
    list.push_back(std::make_unique<gpu::legendre_fluids::LegendreLight>());
    list.push_back(std::make_unique<compensated_ray_marching::CompensatedRayMarching>());
    list.push_back(std::make_unique<gpu::compensated_ray_marching::CompensatedRayMarching>());
    return list;
  }();
  return renderers;
}

// How many renderers the program has of its own; those beyond were added.
std::size_t listed() {
  static const std::size_t count = the_list().size();
  return count;
}

}  // namespace

const Renderers& all_renderers() { return the_list(); }

AddedRenderer::AddedRenderer(std::unique_ptr<scene::Renderer> renderer) : renderer_(renderer.get()) {
  listed();
  the_list().push_back(std::move(renderer));
}

AddedRenderer::~AddedRenderer() {
  std::erase_if(the_list(), [this](const auto& renderer) { return renderer.get() == renderer_; });
}

std::string added_code(const std::string& renderer) {
  const auto& all = the_list();
  const auto added = all.begin() + std::ptrdiff_t(listed());
  if (std::none_of(added, all.end(), [&](const auto& one) { return one->name() == renderer; })) return "";
  static const std::string key = content_key(scene::read_whole_file("/proc/self/exe"));
  return key;
}

bool is_reference(const scene::Renderer& renderer) {
  for (const char* name : {"deterministic", "path_tracer", "ray_marcher", "froxel_fog", "half_resolution_march"})
    if (renderer.name() == name) return true;
  return false;
}

std::vector<std::string> renderer_names() {
  std::vector<std::string> names;
  for (const auto& renderer : all_renderers()) names.push_back(renderer->name());
  return names;
}

const scene::Renderer& find_renderer(const std::string& name, const std::string& where) {
  return find_component(all_renderers(), "renderer", name, where);
}

}  // namespace airlight::experiments
