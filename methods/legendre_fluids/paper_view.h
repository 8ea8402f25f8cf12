// Light that one medium scatters to an orthographic camera, in coefficients: equation 24, and objects
// that end rays within the medium.
//
// E_s towards the camera solves  omega.grad E + sigma r E = q  along every ray. From x, nearer to the eye, to y the air between them sends
//
//   integral over [x, y] of q exp(-sigma column(x, .)) = E(x) - exp(-sigma column(x, y)) E(y)
//
// A particle at y is seen as this airlight plus exp(-sigma column(x, y)) times the particle's own radiance. The
// identity holds exactly for the series E that a system gives, with the q that it solves the equation for. x is where a
// ray enters the box, y where it ends. For a ray that leaves the box E(y) is 0, since no light comes in from behind.
// Columns are exact primitives of the density (light_columns.h), which is not clamped.
#pragma once
#include "methods/legendre_fluids/light_columns.h"
#include "methods/legendre_fluids/paper_light.h"
#include "scene/renderer.h"

namespace airlight::legendre_fluids {

// E_s towards the camera, of all lights together: a series for each channel, shared by those that differ by a factor.
struct Scattered {
  std::vector<Eigen::VectorXd> series;
  std::array<std::size_t, 3> of_channel{};
  Rgb scale = Rgb::Zero();
  int iterations = 0;
};

class PaperView {
 public:
  // View of a density under one or more lights. Keeps the references. `ends`: rays may end within the
  // box, or columns are asked for.
  PaperView(const scene::LegendreBox&, const PaperLight&, const Scattered&, const Rgb& sigma_t, const scene::View&,
            bool ends);

  // A row of the film, by pixel.
  struct Row {
    std::vector<double> end;     // given: where its ray ends, infinite where nothing ends it
    std::vector<Rgb> airlight;   // up to there [W/m^2/sr]; below 0 where the series is
    std::vector<char> seen;      // given: is its column asked for
    std::vector<double> column;  // of the density up to there [m], else 0
    long met = 0, negative = 0;  // rays that the medium is before the end of, those below 0
  };
  void row(int y, Row&) const;

 private:
  struct Clipped {
    std::vector<double> enter, leave;
    std::array<std::vector<int>, 4> pixels;  // by the axis of the face that they enter by; 3: the camera is within
  };
  void clip(int y, const Row&, Clipped&) const;
  // Calls then(pixels, how many, where they are at t(pixel)) for lanes of them.
  template <class T, class Then>
  void for_lanes(int y, const std::vector<int>& pixels, const T& t, const Then& then) const;

  const Scattered& scattered_;
  Rgb sigma_t_;
  int width_;
  scene::TensorShape shape_;                          // of the series
  std::vector<std::array<Eigen::VectorXd, 3>> face_;  // each series on the faces towards the camera
  std::optional<LightColumns> columns_;               // towards the camera
  Vec3 origin_, across_, down_, slope_;               // local: of the first pixel, per pixel, per metre of a ray
};

}  // namespace airlight::legendre_fluids
