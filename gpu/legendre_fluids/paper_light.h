// Light of one medium by the paper's systems (equations 22 to 24) on the device: what PaperLight of methods/legendre_fluids is on the
// processor. Systems are solved without matrices, a work group each, in double precision: of upwind by GMRES, of least squares by
// conjugate gradients of its normal equations.
#pragma once
#include <memory>
#include <vector>

#include "gpu/frame.h"
#include "gpu/legendre_fluids/interface.h"
#include "gpu/legendre_fluids/legendre_fluids.h"
#include "methods/legendre_fluids/paper_light.h"
#include "scene/scene.h"

namespace airlight::gpu::legendre_fluids {

constexpr int most_intensities = 16;  // coefficients along an axis
constexpr double most_weight = 1000;  // of least squares: single precision's 7e-5 are lost at 1e4

class PaperSystems {
 public:
  // Needs a medium that extinguishes and at least one light, all of them shining. The object keeps references to medium and lights.
  // Throws Unavailable where the device has no room for its buffers.
  PaperSystems(Context&, const airlight::legendre_fluids::PaperMedium&, const std::vector<scene::DirectionalLight>&,
               const airlight::legendre_fluids::PaperOptions&, const std::array<bool, 3>& moving);

  // Medium and lights, which it keeps by reference, have become those of another frame. Uploads densities, where these are others, and
  // directions. False, and nothing is done: systems of another layout are needed. E_d is that of before.
  bool become(bool same_densities, const std::array<bool, 3>& moving);

  // E_d of all lights, to the end: waits. Throws Error where a system does not converge.
  void begin();
  // Its coefficients, 1 where light comes in, by light and extinction. Waits.
  std::vector<Eigen::VectorXd> direct() const;
  // The density becomes that of a flow, false where it has another box or other coefficients, or an albedo that is a field. E_d is that of
  // before.
  bool take(const DensityOnDevice&);

  // Runs as many steps as the last solve of each kind took. The statistics in frame.download go to keep_up().
  void solve_direct(Frame& frame) { solve(direct_, frame); }
  void solve_scattered(Frame&, const Vec3& direction);
  // True if all solves of this frame have converged. False: later solves take more steps. Throws Error
  // if more steps would not help.
  bool keep_up(const Frame&);
  int iterations() const { return direct_.iterations + scattered_.iterations; }  // of the frame that was looked at last

  // E_s towards the camera, for each channel, and the density: input of paper_image.comp.
  const Buffer& faces() const { return *faces_; }
  // E_d for paper_dim.comp, and where its series of a light begins for each channel.
  const Buffer& direct_values() const { return *direct_values_; }
  std::array<int, 3> first_of_direct(std::size_t light) const;
  const Definitions& definitions() const { return definitions_; }
  std::array<int, 3> system_of() const { return channels_.system_of; }
  Rgb scale() const { return channels_.scale; }
  const scene::TensorShape& shape() const { return shape_; }

 private:
  // Systems that are solved together.
  struct Kind {
    const char* name;
    int count = 0, rounds = 0, iterations = 0;  // steps: of a frame, of all systems of the last one
    std::unique_ptr<Buffer> status = {};
  };
  // What of medium and lights the layout depends on, beside their number.
  struct Channels {
    std::vector<double> extinctions;     // different ones
    std::array<int, 3> extinction_of{};  // of each channel
    std::array<int, 3> system_of{};      // of each channel, for E_s
    int systems = 0;                     // of E_s
    Rgb scale = Rgb::Ones();
  };
  Channels find_channels() const;
  void upload_density(const airlight::legendre_fluids::DensityProduct&);
  const scene::LegendreBox& field() const { return *media_.density; }
  const scene::Medium& medium() const { return *media_.medium; }
  void lay_out_tables(const airlight::legendre_fluids::DensityProduct&);
  void lay_out_work(const airlight::legendre_fluids::DensityProduct&);
  void number(const char* name, std::size_t value);  // a definition
  void set_directions(const Vec3& view);
  void density_from(const Buffer&, std::size_t first);
  void set(Program&, const Kind&) const;
  void start(const Kind&);
  void run(const Kind&, int steps);
  void keep(const Kind&);
  void solve(Kind&, Frame&);
  bool look(Kind&, const std::vector<float>& status);
  bool upwind() const { return options_.solver.closure == airlight::legendre_fluids::Closure::upwind; }
  int unknowns() const { return scene::tensor_size(shape_); }

  Context& context_;
  const airlight::legendre_fluids::PaperMedium& media_;
  const std::vector<scene::DirectionalLight>& lights_;
  airlight::legendre_fluids::PaperOptions options_;
  scene::TensorShape shape_;
  Definitions definitions_;
  Channels channels_;
  scene::TensorShape density_shape_;
  Box box_;
  bool albedo_is_field_ = false;
  std::vector<double> tables_;
  std::size_t directions_at_ = 0;
  Vec3 view_ = Vec3::Zero();  // that tables have
  double tolerance_;
  int most_steps_ = 0, together_ = 1, group_ = 128;
  std::unique_ptr<Buffer> table_, points_, work_, direct_values_, faces_, densities_;
  Kind direct_{"direct"}, scattered_{"scattered"};
  Program *density_, *right_, *steps_, *kept_;
};

}  // namespace airlight::gpu::legendre_fluids
