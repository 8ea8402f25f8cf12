#include "scene/geometry/city.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/base/error.h"
#include "scene/geometry/shapes.h"
#include "scene/math/random.h"

namespace airlight::scene {
namespace {

void check(const City& city) {
  if (city.boxes < 1 || city.boxes > 100'000 || city.columns < 1 || city.columns > 10'000 || city.block < 1)
    throw Error(
        fmt::format("city of {} boxes in {} columns, {} lots to a block, expected 1 to 100000, 1 to 10000, at "
                    "least 1",
                    city.boxes, city.columns, city.block));
  if (!(city.lot > 0) || !std::isfinite(city.lot) || !(city.street >= 0) || !std::isfinite(city.street))
    throw Error(fmt::format("city with lots of {} m and streets of {} m, expected finite values above 0", city.lot,
                            city.street));
  if (!(city.least_height > 0) || !(city.greatest_height >= city.least_height) || !std::isfinite(city.greatest_height))
    throw Error(fmt::format("city with heights from {} to {} m, expected finite values above 0 in this order",
                            city.least_height, city.greatest_height));
}

// A box whose sides share no vertices.
void add_box(TriangleMesh& mesh, const Box& box) {
  const TriangleMesh shared = make_box(box);
  // Triangles come in pairs, one side of the box each: (a, b, c) and (a, c, d).
  for (std::size_t side = 0; side < shared.triangles.size(); side += 2) {
    const auto &one = shared.triangles[side], &two = shared.triangles[side + 1];
    const int first = int(mesh.vertices.size());
    for (const int corner : {one[0], one[1], one[2], two[2]}) mesh.vertices.push_back(shared.vertices[corner]);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
}

}  // namespace

TriangleMesh make_city(const City& city) {
  check(city);
  const int rows = (city.boxes + city.columns - 1) / city.columns;
  const double middle_x = 0.5 * lot_begin(city, city.columns), middle_z = 0.5 * lot_begin(city, rows);
  const double reach = std::max(middle_x, middle_z);
  TriangleMesh mesh;
  for (int n = 0; n < city.boxes; ++n) {
    const SampleRandom random(city.seed, 0, std::uint32_t(n), 0);
    const RandomBlock u = random.block(0, Purpose::camera, 0), v = random.block(0, Purpose::camera, 1);
    const double x = lot_begin(city, n % city.columns), z = lot_begin(city, n / city.columns);
    const double width = city.lot * (0.7 + 0.25 * u.coarse(0)), depth = city.lot * (0.7 + 0.25 * u.coarse(1));
    const double distance = std::hypot(x - middle_x, z - middle_z) / reach;
    const double tall = std::pow(u.coarse(2), 3) * std::exp(-4 * distance * distance) + 0.08 * u.coarse(3);
    const double height = city.least_height + (city.greatest_height - city.least_height) * std::min(1.0, tall);
    const Point3 lo = city.origin + Vec3(x + (city.lot - width) * v.coarse(0), 0, z + (city.lot - depth) * v.coarse(1));
    add_box(mesh, {lo, lo + Vec3(width, height, depth)});
  }
  return mesh;
}

}  // namespace airlight::scene
