// Precomputed input of the surface shader: materials, and one buffer with all tables.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "gpu/material_tables.h"
#include "methods/fogshop/surface_lighting.h"

namespace airlight::gpu::fogshop {

struct SurfaceTables {
  SurfaceTables(const scene::Scene&, const airlight::fogshop::SurfaceLighting&);

  std::vector<MaterialData> materials;  // by surface, their places in harmonics too
  std::vector<float> values;
  std::map<std::string, int> uniforms;  // places in `values` and sizes, by the shader's names
  // Visibility of every vertex of all meshes, order^2 each, then what other surfaces reflect onto it in each channel,
  // where that is known; empty: none.
  std::vector<float> transfer;
  double iterations = 0;  // of the shader's loops over them: apart from lights, for each light
  double light_iterations = 0;

 private:
  int add(const std::vector<double>&);
  int add(const std::vector<Rgb>&);
  void add_materials(const scene::Scene&, const airlight::fogshop::SurfaceLighting&);
  void add_sun(const airlight::fogshop::SunReflection&);
  void add_harmonics(const airlight::fogshop::SurfaceLighting&);
  void add_depth_tree(const airlight::fogshop::DepthTree&);
  void add_transfer(const airlight::fogshop::RadianceTransfer&, int order);
};

}  // namespace airlight::gpu::fogshop
