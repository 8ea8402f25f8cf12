#include "scene/media/medium.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/media/voxel_grid.h"
#include "tests/scene/media/legendre_fields.h"
#include "tests/scene/media/random_points.h"

namespace medium_test {

using namespace airlight;
using namespace airlight::scene;

namespace {

const Ray along_z{{0, 0, -5}, Vec3::UnitZ()};
const Interval everywhere{0, infinity};

std::shared_ptr<const VoxelGrid> small_grid() {
  auto grid = std::make_shared<VoxelGrid>();
  grid->size = {3, 3, 3};
  grid->origin_index = {-1, -1, -1};
  grid->voxel_size = 0.5;
  grid->rotation = Eigen::AngleAxisd(0.4, Vec3(0, 1, 1).normalized()).toRotationMatrix();
  for (int i = 0; i < 27; ++i) grid->values.push_back(float(i % 5));
  return grid;
}

std::vector<Medium> some_media() {
  const std::vector<DensityField> fields = {
      Homogeneous{0.4}, GaussianSum{{{{0.2, 0.1, 0.3}, 0.6, 2}, {{-0.5, 0, 0}, 0.3, -1}}, 0.05, infinity},
      GaussianSum{{{{0.2, 0.1, 0.3}, 0.6, 2}}}, small_grid(),
      test::modular_box(5, 1, 0.4, {{-0.9, -0.7, -0.8}, {0.6, 0.8, 1}})};
  const std::vector<Region> regions = {Unbounded{}, Box{{-0.7, -0.6, -0.5}, {0.4, 0.5, 0.9}},
                                       Sphere{{0.1, 0, 0.2}, 0.8}, Slab{Vec3(1, 1, 0).normalized(), -0.3, 0.5}};
  std::vector<Medium> media;
  for (const auto& field : fields)
    for (const auto& region : regions) {
      Medium medium;
      medium.field = field;
      medium.region = region;
      medium.sigma_t = {1, 2, 0.5};
      media.push_back(medium);
    }
  return media;
}

}  // namespace

TEST_CASE("a homogeneous medium in each region", "[media]") {
  Medium medium;
  medium.field = Homogeneous{2};
  CHECK(density_integral(medium, along_z, everywhere) == infinity);
  CHECK(density_integral(medium, along_z, {1, 4}) == 6);
  medium.region = Sphere{{0, 0, 0}, 1.5};
  CHECK(density_integral(medium, along_z, everywhere) == Approx(6));
  CHECK(density(medium, {0, 0, 1.4}) == 2);
  CHECK(density(medium, {0, 0, 1.6}) == 0);
  medium.region = Box{Point3::Constant(-1), Point3::Constant(1)};
  CHECK(density_integral(medium, along_z, everywhere) == Approx(4));
  medium.region = Slab{Vec3::UnitZ(), 0, 0.5};
  CHECK(density_integral(medium, along_z, everywhere) == Approx(1));
  CHECK(bounding_box(medium).hi[2] == 0.5);
  CHECK(field_name(medium.field) == "homogeneous");
}

// Vacuum and infinite lengths: 0 times infinity must not be NaN.
TEST_CASE("nothing over an infinite length", "[media]") {
  Medium medium;
  medium.field = Homogeneous{0};
  CHECK(density_integral(medium, along_z, everywhere) == 0);
  CHECK((transmittance({medium}, along_z, everywhere) == 1).all());
  medium.field = Homogeneous{1};
  medium.sigma_t = {0, 1, 2};
  const Rgb depth = optical_depth({medium}, along_z, everywhere);
  CHECK(depth[0] == 0);
  CHECK(depth[1] == infinity);
  CHECK(transmittance({medium}, along_z, everywhere)[0] == 1);
  CHECK(transmittance({medium}, along_z, everywhere)[2] == 0);
  CHECK((optical_depth({}, along_z, everywhere) == 0).all());
}

// Density, its integral, its bounds, its extent and its box must tell one story. Quadrature finds the jumps at the
// region's faces by bisection: 4 metres halved 40 times, times a density below 5.
TEST_CASE("density, integral, bounds and extent agree", "[media]") {
  RandomPoints random(1);
  const Box arena{Point3::Constant(-1.5), Point3::Constant(1.5)};
  for (const Medium& medium : some_media()) {
    INFO(field_name(medium.field) << " in region " << medium.region.index());
    for (int i = 0; i < 12; ++i) {
      const Ray ray{random.in(arena), random.direction()};
      const auto along = [&](double t) { return density(medium, ray.at(t)); };
      const double expected = adaptive_integral(along, -2, 2, 1e-11);
      CHECK(density_integral(medium, ray, {-2, 2}) == Approx(expected).margin(1e-9));
      const Interval part = extent(medium, ray, {-2, 2});
      CHECK(density_integral(medium, ray, part) == Approx(expected).margin(1e-9));
    }
    for (int i = 0; i < 200; ++i) {
      const Box box = random.box(arena);
      const Interval bounds = density_bounds(medium, box);
      for (int k = 0; k < 30; ++k) {
        Point3 x = random.in(box);
        for (int axis = 0; axis < 3; ++axis) {
          const double u = random.uniform(0, 3);
          if (u < 1) x[axis] = u < 0.5 ? box.lo[axis] : box.hi[axis];
        }
        const double value = density(medium, x);
        CHECK(value >= bounds.lo);
        CHECK(value <= bounds.hi);
        // Outside its box a medium is nothing (for Gaussians: negligible).
        if (!bounding_box(medium).contains(x)) CHECK(value <= 2e-17);
      }
    }
  }
}

TEST_CASE("stress 21: overlapping media add", "[media]") {
  RandomPoints random(2);
  const std::vector<Medium> media = some_media();
  const Box arena{Point3::Constant(-1.5), Point3::Constant(1.5)};
  for (int i = 0; i < 100; ++i) {
    const Ray ray{random.in(arena), random.direction()};
    Rgb extinction_sum = Rgb::Zero(), depth_sum = Rgb::Zero(), product = Rgb::Ones();
    for (const Medium& medium : media) {
      extinction_sum += extinction({medium}, ray.origin);
      depth_sum += optical_depth({medium}, ray, {0, 1});
      product *= transmittance({medium}, ray, {0, 1});
    }
    CHECK(extinction(media, ray.origin).isApprox(extinction_sum, 1e-14));
    CHECK(optical_depth(media, ray, {0, 1}).isApprox(depth_sum, 1e-14));
    CHECK(transmittance(media, ray, {0, 1}).isApprox(product, 1e-12));
  }
  // Two equal media are twice as dense as one, bit for bit.
  const Ray ray{{0, 0, 0}, Vec3::UnitZ()};
  CHECK((optical_depth({media[3], media[3]}, ray, {0, 1}) == 2 * optical_depth({media[3]}, ray, {0, 1})).all());
}

// Scaled by 2^-13 with sigma_t times 2^13: the same optical depth, bit for bit.
TEST_CASE("stress 16: a medium scaled by a power of two", "[media]") {
  const double s = 0x1p-13;
  Medium medium = some_media()[5];
  Medium scaled = medium;
  scaled.sigma_t /= s;
  auto& box = std::get<Box>(scaled.region);
  box.lo *= s;
  box.hi *= s;
  for (Gaussian& g : std::get<GaussianSum>(scaled.field).gaussians) {
    g.center *= s;
    g.width *= s;
  }
  RandomPoints random(3);
  for (int i = 0; i < 100; ++i) {
    const Ray ray{random.in({Point3::Constant(-1), Point3::Constant(1)}), random.direction()};
    CHECK((optical_depth({scaled}, {s * ray.origin, ray.direction}, {0, infinity}) ==
           optical_depth({medium}, ray, {0, infinity}))
              .all());
  }
}

TEST_CASE("a field is its constant part where nothing varies", "[media]") {
  for (const Medium& medium : some_media()) {
    const DensityField& field = medium.field;
    CAPTURE(field_name(field));
    const Box varied = varied_support(field);
    const double constant = constant_part(field);
    // Gaussians end where they are 1e-17 of their amplitude, here at most 2: less than a rounding of the constant.
    for (const Point3& x : {Point3(9, 0, 0), Point3(0, -9, 3), Point3(-4, 5, 6)}) {
      REQUIRE_FALSE(varied.contains(x));
      CHECK(std::abs(density(field, x) - constant) <= 4e-17);
    }
    CHECK(homogeneous_density(field).has_value() == varied.empty());
    CHECK(homogeneous_density(field).value_or(constant) == constant);
    CHECK(greatest_density(field) >= constant);
    const bool everywhere = support(field).size()[0] == infinity;
    CHECK(everywhere == (constant > 0));
    CHECK(extinguishes(medium));
  }
}

TEST_CASE("media without density or extinction do not extinguish", "[media]") {
  Medium medium;
  CHECK(extinguishes(medium));
  medium.sigma_t = Rgb::Zero();
  CHECK_FALSE(extinguishes(medium));
  medium.sigma_t = {0, 0, 1};
  CHECK(extinguishes(medium));
  const std::vector<DensityField> none = {Homogeneous{0}, GaussianSum{}, std::make_shared<const VoxelGrid>()};
  for (const DensityField& field : none) {
    medium.field = field;
    CHECK_FALSE(extinguishes(medium));
  }
}

TEST_CASE("a field that a renderer does not know is refused by name", "[media]") {
  // Every kind has a name of its own: scene files tell them apart by it.
  std::vector<std::string> names;
  for (const DensityField& kind : Kinds<DensityField>::all()) names.push_back(field_name(kind));
  CHECK(names == std::vector<std::string>{"homogeneous", "gaussians", "grid", "fogmap", "legendre", "fitted"});
  std::vector<Medium> media(2);
  media[0].field = small_grid();
  media[1].field = GaussianSum{};
  media[1].name = "puff";
  CHECK(unknown_field<Homogeneous>(media, 0) == "medium 0 is grid, expected homogeneous");
  CHECK(unknown_field<Homogeneous, GaussianSum>(media, 0) == "medium 0 is grid, expected homogeneous or gaussians");
  CHECK(unknown_field<Homogeneous>(media, 1) == "medium 'puff' is gaussians, expected homogeneous");
  CHECK(unknown_field<Homogeneous, GaussianSum>(media, 1).empty());
}

}  // namespace medium_test
