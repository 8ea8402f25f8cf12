// Particles in a picture: snow flakes and confetti, drawn as what a camera sees of them.
#pragma once
#include <vector>

#include "scene/backdrop.h"
#include "scene/math/types.h"

namespace airlight::scene {

// All of one kind. Each sends the same radiance in all directions, is not lit and casts no shadow.
struct Particles {
  enum class Shape { disc, sheet };  // a disc that faces the camera; a square sheet that tumbles
  Shape shape = Shape::disc;
  std::vector<Point3> positions;  // [m]
  double radius = 0.01;           // of the disc, half the side of the sheet [m]
  std::vector<Rgb> radiances;     // [W/m^2/sr]; particle i has number i modulo their count; not empty
  std::uint32_t seed = 0;         // of the sheets' attitudes
  double angle = 0;               // that a sheet has turned about an axis of its own [rad]
};

// Draws particles into a backdrop of the film's size. A particle covers the pixels whose centre rays
// meet it, and always the pixel that contains its middle, so that none is lost between pixels. The
// nearest particle of a pixel is seen.
Backdrop draw(const Particles&, const Camera&, int width, int height);

}  // namespace airlight::scene
