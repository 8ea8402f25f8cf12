// A medium in another form: methods know forms, and each its own. Density alone changes; coefficients, colour and phase function stay.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "scene/base/settings.h"
#include "scene/renderer.h"
#include "scene/scene.h"

namespace airlight::scene {

enum class MediumForm { grid, gaussians, legendre, fogmap, homogeneous };
const Choices<MediumForm>& medium_forms();

struct MediumConversion {
  MediumForm to = MediumForm::grid;
  int voxels = 64;        // of a grid, along the longest side of the medium's box
  int gaussians = 600;    // fewer where fewer voxels are filled
  bool cut = true;        // Gaussians end at three widths, as they are fitted; else they go on, as closed forms need it
  int coefficients = 12;  // of a Legendre box, along each axis
  bool damped = true;  // by Lanczos' factors and the limiter; else the L2 projection, which swings below 0 beside jumps
  int pixels = 64;     // of a fogmap, along the longer side on the ground
  bool lamps = false;  // directional lights become point lights, far_lamp times as far away as the scene is large
};
inline constexpr double far_lamp = 1000;

// From `to = gaussians`, `count` and `cut`, `to = legendre`, `order` and `damped`, `to = fogmap` and `cells`, `to = grid` and `voxels`, or
// `to = homogeneous`; and `lamps`. Throws Error, which begins with `where`, for a key that another form has, and for a number out of range.
MediumConversion read_conversion(const std::map<std::string, std::string>& given, const std::string& where);
// "to=gaussians count=600"; what is as by default and has no size is left out.
std::string canonical(const MediumConversion&);

// Result of the conversion of one medium.
struct ConvertedMedium {
  std::string medium;        // its label
  std::size_t numbers = 0;   // that say the density: voxels, 5 a Gaussian, coefficients, pixels
  double density_error = 0;  // relative L2, at 48^3 points of the medium's box
  double mass_ratio = 1;     // sum over these points, over that of the medium
  double seconds = 0;        // wall clock of the conversion, as it was when the result was made
};

struct ConvertedScene {
  Scene scene;
  std::vector<ConvertedMedium> media;
};

// Converts all media. A fit of Gaussians is kept in the execution's store. Gaussians and fogmaps are made from a grid: the medium's own, or
// one of 96 voxels along the longest side. `program` names the sources, for the store. Throws Error for a medium without an end, and for one
// whose box is empty.
ConvertedScene convert_media(const Scene&, const MediumConversion&, const Execution&, const std::string& program);

}  // namespace airlight::scene
