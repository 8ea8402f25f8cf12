// The readers of all kinds, grouped by the file that defines them; registry.cpp lists them.
#pragma once
#include "experiments/verify/check.h"

namespace airlight::experiments::verification {

// fields.cpp
Check read_line_integral(const Value&);  // fogshop
Check read_depth(const Value&);          // fogshop
Check read_optical_depth(const Value&);
Check read_field_bounds(const Value&);
Check read_phase_function(const Value&);

// single_scattering.cpp
Check read_airlight_scene(const Value&);  // fogshop
Check read_single_scattering_shape(const Value&);
Check read_single_scattering_gaussians(const Value&);

// fogshop_kinds.cpp
Check read_f(const Value&);
Check read_average_depth(const Value&);
Check read_npsf(const Value&);
Check read_npsf_coefficient(const Value&);
Check read_airlight_homogeneous(const Value&);
Check read_airlight_paper(const Value&);

// shadow_plane_kinds.cpp
Check read_planes_airlight(const Value&);
Check read_taylor_coefficients(const Value&);
Check read_taylor_integral(const Value&);
Check read_spot(const Value&);
Check read_shadow(const Value&);
Check read_bounded(const Value&);

// wavelet_kinds.cpp
Check read_sequence(const Value&);
Check read_family(const Value&);
Check read_basis(const Value&);
Check read_analysis_1d(const Value&);
Check read_analysis_2d(const Value&);
Check read_restriction_1d(const Value&);
Check read_projection_1d(const Value&);
Check read_fogmap_depth(const Value&);
Check read_multiresolution(const Value&);
Check read_composite(const Value&);
Check read_reject(const Value&);

// residual_kinds.cpp: compensated ray marching's residual, and the media that it works on
Check read_psh_address(const Value&);
Check read_hash_round_trip(const Value&);
Check read_gaussian_optical_depth(const Value&);
Check read_trilinear_border(const Value&);

// harmonic_kinds.cpp: compensated ray marching in spherical harmonics
Check read_sh_basis(const Value&);
Check read_sh_triple_entry(const Value&);
Check read_sh_triple_counts(const Value&);
Check read_sh_triple_product(const Value&);
Check read_hg_zh(const Value&);
Check read_sh_convolution(const Value&);
Check read_zh_rotation(const Value&);
Check read_theta_of_d(const Value&);
Check read_rbf_zh_optical_depth(const Value&);
Check read_sh_exponential(const Value&);
Check read_ol_table(const Value&);

// source_kinds.cpp: its source radiance, its diffusion system
Check read_single_scattering_source(const Value&);
Check read_transmittance_environment(const Value&);
Check read_collocation_matrix(const Value&);

// march_kinds.cpp: its march
Check read_march_single_scattering(const Value&);
Check read_march_compensated(const Value&);
Check read_ray_march_homogeneous(const Value&);

// transport_kinds.cpp: multiple scattering that it is compared with
Check read_without_renderer(const Value&);
Check read_diffusion_point_source(const Value&);
Check read_diffusion_slab(const Value&);
Check read_diffusion_uniform_source(const Value&);
Check read_multiple_scattering_ball(const Value&);

// legendre_kinds.cpp: the basis
Check read_legendre_derivative(const Value&);
Check read_legendre_integral(const Value&);
Check read_legendre_derivative_samples(const Value&);
Check read_legendre_integral_samples(const Value&);
Check read_legendre_triple(const Value&);
Check read_legendre_triple_count(const Value&);
Check read_legendre_truncation(const Value&);
Check read_legendre_phi_mass(const Value&);
Check read_legendre_product(const Value&);

// legendre_light.cpp: single scattering in a Legendre box
Check read_legendre_scatter(const Value&);
Check read_legendre_airlight(const Value&);
Check read_legendre_image(const Value&);
Check read_legendre_upwind(const Value&);

// sampling_kinds.cpp
Check read_sampling(const Value&);
Check read_random_numbers(const Value&);

// slab_kinds.cpp
Check read_slab_table(const Value&);
Check read_slab_point(const Value&);
Check read_slab_exit_radiance(const Value&);
Check read_slab_orders(const Value&);
Check read_half_space(const Value&);

// sphere_kinds.cpp
Check read_sphere_environment(const Value&);
Check read_sphere_central_point(const Value&);
Check read_single_scattering_environment(const Value&);
Check read_multiple_scattering(const Value&);

// identity_kinds.cpp
Check read_identity(const Value&);

// fluid_kinds.cpp, fluid_flows.cpp
Check read_fluid(const Value&);
Check read_fluid_flow(const Value&);  // of a whole flow

// legendre_fluid_kinds.cpp: the fluid in a box of coefficients
Check read_legendre_project(const Value&);
Check read_legendre_coefficients(const Value&);
Check read_legendre_evaluate(const Value&);
Check read_legendre_advect(const Value&);
Check read_legendre_diffuse(const Value&);
Check read_legendre_rk4(const Value&);
Check read_legendre_step(const Value&);
Check read_legendre_density(const Value&);
Check read_legendre_energy_identity(const Value&);
Check read_legendre_taylor_green(const Value&);

// fit_kinds.cpp: smoke as Gaussians
Check read_fit_objective(const Value&);

// statistics_kinds.cpp
Check read_statistics(const Value&);

}  // namespace airlight::experiments::verification
