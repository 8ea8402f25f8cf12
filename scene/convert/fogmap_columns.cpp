#include "scene/convert/fogmap_columns.h"

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/media/spline_map.h"

namespace airlight::scene {
namespace {

Box box_of(const DensityField& field) {
  Box box = varied_support(field);
  if (constant_part(field) > 0 || box.empty() || !std::isfinite(box.lo[1]) || !std::isfinite(box.hi[1]))
    throw Error("the medium has no end in height, expected one with finite columns");
  return box;
}

double column(const DensityField& field, const Box& box, double x, double z) {
  return density_integral(field, {Point3(x, box.lo[1], z), Vec3::UnitY()}, {0, box.hi[1] - box.lo[1]});
}

// Relative L2 difference, gathered.
struct Difference {
  double off = 0, all = 0;
  void add(double value, double exact) {
    off += (value - exact) * (value - exact);
    all += exact * exact;
  }
  double relative() const { return all > 0 ? std::sqrt(off / all) : 0; }
};

}  // namespace

GroundPixels ground_pixels(const DensityField& field, int longer) {
  const Box box = box_of(field);
  const Vec3 side = box.hi - box.lo;
  if (!std::isfinite(side[0]) || !std::isfinite(side[2])) throw Error("the medium has no end, expected one with a box");
  GroundPixels pixels;
  pixels.cell = std::max(side[0], side[2]) / longer;
  const auto count = [&](double length) { return std::clamp(int(std::ceil(length / pixels.cell - 1e-9)), 1, longer); };
  pixels.width = count(side[0]);
  pixels.height = count(side[2]);
  pixels.x0 = 0.5 * (box.lo[0] + box.hi[0] - pixels.width * pixels.cell);
  pixels.z0 = 0.5 * (box.lo[2] + box.hi[2] - pixels.height * pixels.cell);
  return pixels;
}

std::vector<double> column_densities(const DensityField& field, const GroundPixels& pixels, int samples) {
  const Box box = box_of(field);
  std::vector<double> columns;
  columns.reserve(std::size_t(pixels.width) * pixels.height);
  for (int j = 0; j < pixels.height; ++j)
    for (int i = 0; i < pixels.width; ++i) {
      double sum = 0;
      for (int b = 0; b < samples; ++b)
        for (int a = 0; a < samples; ++a)
          sum += column(field, box, pixels.x0 + (i + (a + 0.5) / samples) * pixels.cell,
                        pixels.z0 + (j + (b + 0.5) / samples) * pixels.cell);
      columns.push_back(sum / (double(samples) * samples));
    }
  return columns;
}

ColumnFogmap fogmap_from_columns(const DensityField& field, const GroundPixels& pixels, int samples, int degree) {
  const Box box = box_of(field);
  const double thickness = box.hi[1] - box.lo[1];
  ColumnFogmap result;
  result.heights = {box.lo[1], box.hi[1]};
  std::vector<double> values = column_densities(field, pixels, samples);
  for (double& value : values) value /= thickness;
  result.map.map = SplineMap(degree, {{0, 0}, {pixels.width, pixels.height}}, values);
  result.map.cell = pixels.cell;
  result.map.x0 = pixels.x0 - 0.5 * pixels.cell * degree;
  result.map.z0 = pixels.z0 - 0.5 * pixels.cell * degree;

  constexpr int across = 3, along = 32;  // upright rays a pixel and side; densities on each
  Difference of_columns, of_densities;
  double ours = 0, exact = 0;
  for (int j = 0; j < across * pixels.height; ++j)
    for (int i = 0; i < across * pixels.width; ++i) {
      // Off the thirds, which would meet the rays of three samples.
      const double x = pixels.x0 + (i + 0.27) / across * pixels.cell, z = pixels.z0 + (j + 0.61) / across * pixels.cell;
      const double f = density(result.map, Point3(x, box.lo[1], z)), whole = column(field, box, x, z);
      of_columns.add(f * thickness, whole);
      ours += f * thickness;
      exact += whole;
      for (int k = 0; k < along; ++k)
        of_densities.add(f, density(field, Point3(x, box.lo[1] + (k + 0.5) / along * thickness, z)));
    }
  result.column_error = of_columns.relative();
  result.density_error = of_densities.relative();
  result.column_ratio = exact > 0 ? ours / exact : 1;
  return result;
}

}  // namespace airlight::scene
