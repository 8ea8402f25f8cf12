// The grid of froxels (voxels of a frustum) and what is done with all of them: history, filter, integration, look-up.
#pragma once
#include <vector>

#include "reference/froxel_fog/options.h"
#include "scene/renderer.h"

namespace airlight::froxel_fog {

// How the film is divided. The last column and row may reach beyond the film.
struct Cells {
  int columns = 0, rows = 0;
  double width = 0, height = 0;  // of a cell [pixels]
};
Cells cells_of(const Options&, int film_width, int film_height);
double count_froxels(const Options&, int film_width, int film_height);

struct Froxel {
  // In-scattered radiance per length [W/m^3/sr]; after integration the airlight [W/m^2/sr] from the camera to the froxel's far end.
  Eigen::Array3f light = Eigen::Array3f::Zero();
  // Extinction [1/m]; after integration the transmittance from the camera to the froxel's far end.
  Eigen::Array3f media = Eigen::Array3f::Zero();
};

class Volume {
 public:
  // Throws Error where it does not fit into memory.
  Volume(const Cells&, const Slices&);

  const Cells& cells() const { return cells_; }
  const Slices& slices() const { return slices_; }
  // The froxels of a column, front to back.
  Froxel* column(int x, int y) { return froxels_.data() + place(x, y); }
  const Froxel* column(int x, int y) const { return froxels_.data() + place(x, y); }

  // Replaces light and media by weighted means of neighbours; beyond the grid its outermost froxels go on.
  void filter(Filter, const scene::Execution&);

  // Light and media become airlight and transmittance up to the far end of each froxel: exact for what is constant in a froxel (Hillaire
  // 2015, slide 28). Lengths are those along the ray through the middle of the cell.
  void integrate(const scene::View&, const scene::Execution&);

  // Before integration, trilinear between the middles of froxels: at a place of the film [pixels] and u of Slices.
  Froxel froxel_at(double film_x, double film_y, double u) const;

  // After integration, trilinear: at a place of the film [pixels] and u of Slices.
  struct Seen {
    Rgb airlight, transmittance;
  };
  Seen look_up(double film_x, double film_y, double u) const;

 private:
  std::size_t place(int x, int y) const {
    return (std::size_t(y) * std::size_t(cells_.columns) + std::size_t(x)) * std::size_t(slices_.count());
  }

  Cells cells_;
  Slices slices_;
  std::vector<Froxel> froxels_;
};

// Weights of a filter from its middle outwards, along one axis: w0 + 2 (w1 + ...) = 1.
std::vector<float> filter_weights(Filter);

}  // namespace airlight::froxel_fog
