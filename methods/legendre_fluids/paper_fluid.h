// The variants `paper` and `paper_repaired`.
//
//   paper            equations 13 to 21 as printed (the sign of 14 mended): no walls; energy grows without bound
//   paper_repaired   the same A and T, but the velocity is projected in L2 onto ConfinedSpace of n-1 coefficients, the largest that n hold,
//                    after advection and after forces; diffusion is that space's. First order in time; with T of L2 energy falls
//
// The velocity is n^d coefficients of L for each axis, one after the other.
#pragma once
#include <optional>

#include "methods/legendre_fluids/fluid.h"
#include "methods/legendre_fluids/paper_operators.h"

namespace airlight::legendre_fluids {

// Throws scene::Unstable where the energy grew more than tenfold in a step.
void require_tame(double growth, bool repaired);

class PaperFluid : public Fluid {
 public:
  // n >= 1, n^dimensions <= 1000 unless repaired. There n = 1 and n = 2 are fluids at rest.
  PaperFluid(int dimensions, int n, const Vec3& half, const Material&, Truncation, bool repaired);

  void begin(const VelocityFunction&) override;
  // Throws scene::Unstable where the energy grows tenfold in a step, forces aside.
  void advance(double dt) override;
  void push(const Components& change) override;
  void finish(double dt) override;
  double faded(double amount) const override { return 1 / (1 + amount); }  // equation 21
  Components at_points() const override;
  Array sampled(int component, const Components& positions) const override;
  Array sampled_gradient(int component, int axis, const Components& positions) const override;
  double at(int component, const Vec3& x) const override;
  std::map<std::string, double> counters() const override;

  // Operators, for other implementations. The last three are of the repaired variant: the space that the velocity is projected to (null in
  // the other variant), and the matrices along an axis from n coefficients of L to its coefficients, across walls and along them. The
  // matrices are empty where that space has no velocity.
  const PaperAdvection& advection() const { return advection_; }
  const PaperLaplacian& laplacian() const { return laplacian_; }
  const ConfinedSpace* confined() const { return confined_ ? &*confined_ : nullptr; }
  const Eigen::MatrixXd& to_wall() const { return to_wall_; }
  const Eigen::MatrixXd& to_free() const { return to_free_; }

 private:
  Array part(int a) const { return velocity.segment(a * space_.scalars(), space_.scalars()); }
  Components parts() const;
  void set_parts(const Components&);
  void project();
  Array to_confined() const;  // L2 projection, with divergence
  void from_confined(const Array& u);

  PaperAdvection advection_;
  PaperLaplacian laplacian_;
  std::optional<ConfinedSpace> confined_;  // of the repaired variant
  // Coefficients of L to those of the confined space. Across walls: the L2 projection (phi^T phi)^-1 phi^T; along the other axes the last
  // coefficient is left out.
  Eigen::MatrixXd to_wall_, to_free_;
  double growth_ = 1;              // of the energy in this step so far
  bool needs_projection_ = false;  // the velocity is what advection or forces left
};

}  // namespace airlight::legendre_fluids
