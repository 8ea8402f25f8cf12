#include "reference/stable_fluids/frames.h"

#include <algorithm>

namespace airlight::stable_fluids {
namespace {

template <class Real>
std::vector<float> by_cell(const Field<Real>* field) {
  std::vector<float> values;
  if (!field) return values;
  values.reserve(count_of(field->n));
  for (int k = 0; k < field->n[2]; ++k)
    for (int j = 0; j < field->n[1]; ++j) {
      const Real* row = field->row(j, k);
      values.insert(values.end(), row, row + field->n[0]);
    }
  return values;
}

}  // namespace

template <class Real>
scene::GridPointer density_grid(const Lattice& l, const Field<Real>* density) {
  auto grid = std::make_shared<scene::VoxelGrid>();
  grid->size = {l.n[0], l.n[1], l.n[2]};
  grid->voxel_size = l.h;
  grid->translation = l.low + 0.5 * l.h * Vec3::Ones();
  grid->values = by_cell(density);
  grid->values.resize(count_of(l.n), 0.0f);
  for (float& value : grid->values) value = std::max(0.0f, value);
  return grid;
}

template <class Real>
scene::Frame frame_of(const Lattice& l, const Velocity<Real>& u, const Field<Real>* density,
                      const Field<Real>* temperature) {
  scene::Frame f;
  f.size = {l.n[0], l.n[1], l.n[2]};
  f.cell = l.h;
  f.low = l.low;
  f.density = by_cell(density);
  f.temperature = by_cell(temperature);
  const int nx = l.n[0] + 1, ny = l.n[1] + 1;
  f.velocity.assign(3 * std::size_t(nx) * ny * (l.n[2] + 1), 0.0f);
  for (int a = 0; a < l.dimensions; ++a)
    for (int k = 0; k < l.n[2] + (a == 2); ++k)
      for (int j = 0; j < l.n[1] + (a == 1); ++j)
        for (int i = 0; i < l.n[0] + (a == 0); ++i)  // of a periodic axis the last face is a ghost
          f.velocity[3 * (i + std::size_t(nx) * (j + std::size_t(ny) * k)) + a] = float(u[a].at(i, j, k));
  return f;
}

#define AIRLIGHT_OF(Real)                                                       \
  template scene::GridPointer density_grid(const Lattice&, const Field<Real>*); \
  template scene::Frame frame_of(const Lattice&, const Velocity<Real>&, const Field<Real>*, const Field<Real>*);
AIRLIGHT_OF(float)
AIRLIGHT_OF(double)
#undef AIRLIGHT_OF

}  // namespace airlight::stable_fluids
