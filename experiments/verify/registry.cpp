// Names of the vector files, and the reader of each kind of vector.
#include <map>
#include <set>

#include "experiments/verify/readers.h"

namespace airlight::experiments::verification {
namespace {

using Kinds = std::map<std::string, Reader>;

Kinds references() {
  return {
      {"single_scattering_sphere", read_single_scattering_shape},
      {"single_scattering_box", read_single_scattering_shape},
      {"single_scattering_gaussians", read_single_scattering_gaussians},
      {"single_scattering_environment", read_single_scattering_environment},
      {"multiple_scattering_monte_carlo", read_multiple_scattering},
      {"slab_table", read_slab_table},
      {"slab_point", read_slab_point},
      {"slab_exit_radiance", read_slab_exit_radiance},
      {"slab_orders", read_slab_orders},
      {"halfspace", read_half_space},
      {"sphere_environment_all_orders", read_sphere_environment},
      {"sphere_central_point", read_sphere_central_point},
      {"identity", read_identity},
      {"optical_depth", read_optical_depth},
      {"field_bounds", read_field_bounds},
      {"phase_function", read_phase_function},
      {"sampling", read_sampling},
      {"random_numbers", read_random_numbers},
      {"statistics", read_statistics},
      {"fluid", read_fluid},
  };
}

Kinds fogshop() {
  return {
      {"line_integral", read_line_integral},
      {"depth", read_depth},
      {"F", read_f},
      {"airlight_homogeneous", read_airlight_homogeneous},
      {"airlight_scene", read_airlight_scene},
      {"airlight_paper", read_airlight_paper},
      {"avg_depth", read_average_depth},
      {"npsf", read_npsf},
      {"npsf_coef", read_npsf_coefficient},
  };
}

Kinds shadow_planes() {
  return {
      {"airlight", read_planes_airlight},
      {"taylor_coefficients", read_taylor_coefficients},
      {"taylor_integral", read_taylor_integral},
      {"spot", read_spot},
      {"shadow", read_shadow},
      {"bounded", read_bounded},
  };
}

Kinds compensated_ray_marching() {
  return {
      {"sh_basis", read_sh_basis},
      {"sh_triple_entry", read_sh_triple_entry},
      {"sh_triple_counts", read_sh_triple_counts},
      {"sh_triple_product", read_sh_triple_product},
      {"hg_zh", read_hg_zh},
      {"sh_convolution", read_sh_convolution},
      {"zh_rotation", read_zh_rotation},
      {"theta_of_d", read_theta_of_d},
      {"gaussian_optical_depth", read_gaussian_optical_depth},
      {"rbf_zh_optical_depth", read_rbf_zh_optical_depth},
      {"sh_exponential", read_sh_exponential},
      {"ol_table", read_ol_table},
      {"single_scattering_source", read_single_scattering_source},
      {"transmittance_environment", read_transmittance_environment},
      {"march_single_scattering", read_march_single_scattering},
      {"march_compensated", read_march_compensated},
      {"ray_march_homogeneous", read_ray_march_homogeneous},
      {"collocation_matrix", read_collocation_matrix},
      {"diffusion_point_source", read_diffusion_point_source},
      {"diffusion_uniform_source", read_diffusion_uniform_source},
      {"diffusion_slab_marshak", read_diffusion_slab},
      {"halfspace_albedo_isotropic", read_without_renderer},
      {"slab_albedo_mc", read_without_renderer},
      {"sn_slab", read_without_renderer},
      {"multiple_scattering_slab_hetero", read_without_renderer},
      {"multiple_scattering_sphere", read_multiple_scattering_ball},
      {"fit_objective", read_fit_objective},
      {"trilinear_border", read_trilinear_border},
      {"psh_address", read_psh_address},
      {"hash_round_trip", read_hash_round_trip},
  };
}

Kinds wavelet_fog() {
  return {
      {"sequence", read_sequence},
      {"family", read_family},
      {"basis", read_basis},
      {"analysis1d", read_analysis_1d},
      {"analysis2d", read_analysis_2d},
      {"restrict1d", read_restriction_1d},
      {"l2proj1d", read_projection_1d},
      {"optical_depth", read_fogmap_depth},
      {"multires", read_multiresolution},
      {"composite", read_composite},
      {"reject", read_reject},
  };
}

Kinds legendre_fluids() {
  return {
      {"derivative", read_legendre_derivative},
      {"integral", read_legendre_integral},
      {"derivative-samples", read_legendre_derivative_samples},
      {"integral-samples", read_legendre_integral_samples},
      {"triple", read_legendre_triple},
      {"triple-count", read_legendre_triple_count},
      {"product", read_legendre_product},
      {"truncation", read_legendre_truncation},
      {"phi-mass", read_legendre_phi_mass},
      {"scatter", read_legendre_scatter},
      {"airlight", read_legendre_airlight},
      {"image", read_legendre_image},
      {"project", read_legendre_project},
      {"coefficients", read_legendre_coefficients},
      {"evaluate", read_legendre_evaluate},
      {"advect", read_legendre_advect},
      {"diffuse", read_legendre_diffuse},
      {"rk4", read_legendre_rk4},
      {"step", read_legendre_step},
      {"density-advect", read_legendre_density},
      {"energy-identity", read_legendre_energy_identity},
      {"taylor-green", read_legendre_taylor_green},
      {"upwind-galerkin", read_legendre_upwind},
  };
}

const std::map<std::string, Kinds>& families() {
  static const std::map<std::string, Kinds> all = {
      {"references", references()},       {"fogshop", fogshop()},
      {"shadow_planes", shadow_planes()}, {"compensated_ray_marching", compensated_ray_marching()},
      {"wavelet_fog", wavelet_fog()},     {"legendre_fluids", legendre_fluids()},
  };
  return all;
}

bool says(const Value& file, const std::string& field, const std::string& text) {
  return file.has(field) && file[field].text() == text;
}

}  // namespace

std::string family_of(const Value& file) {
  if (says(file, "part", "references")) return "references";
  if (says(file, "format", "airlight-fogshop-vectors-1")) return "fogshop";
  if (says(file, "format", "airlight/shadow_planes/1")) return "shadow_planes";
  if (says(file, "format", "airlight-wavelet-fog-1")) return "wavelet_fog";
  if (says(file, "paper", "compensated_ray_marching_2008")) return "compensated_ray_marching";
  if (says(file, "topic", "legendre_fluids")) return "legendre_fluids";
  file.complain("a file of vectors that says what it is in 'part', 'format', 'paper' or 'topic'");
}

Reader find_reader(const std::string& family, const std::string& kind) {
  const Kinds& kinds = families().at(family);
  const auto found = kinds.find(kind);
  return found == kinds.end() ? Reader() : found->second;
}

std::vector<std::string> known_kinds(const std::string& family) {
  std::vector<std::string> names;
  for (const auto& [kind, reader] : families().at(family)) names.push_back(kind);
  return names;
}

std::vector<std::string> known_kinds() {
  std::set<std::string> names;
  for (const auto& [family, kinds] : families())
    for (const auto& [kind, reader] : kinds) names.insert(kind);
  return {names.begin(), names.end()};
}

}  // namespace airlight::experiments::verification
