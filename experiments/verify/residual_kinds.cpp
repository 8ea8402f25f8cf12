// Zhou et al. 2008: the residual and its hash, the line integral of a Gaussian, the border of a voxel grid.
#include <algorithm>
#include <cmath>

#include "experiments/application/json_value.h"
#include "experiments/verify/own_tolerance.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/smoke_on_device.h"
#include "gpu/compensated_ray_marching/residual_store.h"
#include "scene/convert/perfect_hash.h"
#include "scene/convert/residual.h"
#include "scene/media/gaussian_sum.h"
#include "scene/media/voxel_grid.h"

namespace airlight::experiments::verification {
namespace {

using Eigen::Vector3i;
using gpu::compensated_ray_marching::ResidualOnDevice;
using Membership = ResidualOnDevice::Membership;

Vector3i integers(const Value& v, int least, int greatest) {
  if (v.size() != 3) v.complain("three integers");
  return {v[0].integer_in(least, greatest), v[1].integer_in(least, greatest), v[2].integer_in(least, greatest)};
}

std::vector<Comparison> compare(const std::string& what, const Vector3i& expected, const Vector3i& got) {
  std::vector<Comparison> all;
  for (int a = 0; a < 3; ++a) all.push_back(absolute(fmt::format("{} {}", what, "xyz"[a]), expected[a], got[a], 0));
  return all;
}

Vector3i split(std::size_t slot, int side) {
  const std::size_t n = std::size_t(side);
  return {int(slot % n), int(slot / n % n), int(slot / n / n)};
}

int level_on_device(const ResidualOnDevice& residual, const Vector3i& p) {
  return levels_on_device(gpu::Context::get(), residual, p, Vector3i::Ones()).at(0);
}

// Densities at places, by the shaders of the march.
std::vector<float> densities_on_device(const scene::VoxelGrid& grid, const std::vector<Vec3>& places) {
  gpu::Context& context = gpu::Context::get();
  scene::Medium medium;
  medium.field = std::make_shared<const scene::VoxelGrid>(grid);
  const Point3 middle = sample_to_world(grid, 0.5 * grid.size.cast<double>());
  const compensated_ray_marching::SmokeField field(medium, {});
  const on::SmokeDensity density(context, field, middle, false);
  std::vector<std::array<float, 4>> points;
  for (const Vec3& x : places)
    points.push_back({float(x[0] - middle[0]), float(x[1] - middle[1]), float(x[2] - middle[2]), 0});
  gpu::Program& program = on::program(context, "density_at_points", 64, 1, density.definitions());
  const gpu::Buffer in(context, "points", points), result(context, "densities", 4 * points.size());
  density.bind(program);
  in.bind(on::at::nodes);
  result.bind(on::at::result);
  program.set("count", int(points.size()));
  program.dispatch(int(points.size()));
  return result.download<float>();
}

}  // namespace

Check read_psh_address(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const int m = in["m"].integer_in(1, 256), r = in["r"].integer_in(1, 256);
  const Vector3i p = integers(in["p"], 0, 1 << 20), offset = integers(in["offset"], 0, m - 1);
  const Vector3i offset_slot = integers(expected["offset_slot"], 0, r - 1);
  const Vector3i hash_slot = integers(expected["hash_slot"], 0, m - 1);
  const auto number = [](const Vector3i& at, int side) {
    return std::size_t(at[0]) + std::size_t(side) * (std::size_t(at[1]) + std::size_t(side) * std::size_t(at[2]));
  };
  const std::uint32_t word = std::uint32_t(offset[0] | offset[1] << 10 | offset[2] << 20);
  Check check{"", [=](VerifyProfile) {
                scene::PerfectHash hash;
                hash.m = m, hash.r = r;
                hash.offsets.assign(std::size_t(r) * r * r, 0);
                const std::size_t at = hash.offset_slot(p);
                hash.offsets[at] = word;
                Outcome out{compare("offset slot", offset_slot, split(at, r))};
                for (const Comparison& c : compare("hash slot", hash_slot, split(hash.slot(p), m))) out.add(c);
                return out;
              }};
  if (p.maxCoeff() < 512)
    check.on_device = [=](VerifyProfile) {
      scene::PerfectHash hash;
      hash.m = m, hash.r = r;
      const int side = (p.maxCoeff() / 64 + 1) * 64;
      hash.extent = Vector3i::Constant(side);
      hash.offsets.assign(std::size_t(r) * r * r, 0);
      hash.values.assign(std::size_t(m) * m * m, 1);  // at every other slot something else
      hash.tags.assign(hash.values.size(), 0);
      hash.domain.assign(std::size_t(side) * side * side / 64, ~std::uint64_t(0));
      hash.offsets[number(offset_slot, r)] = word;
      hash.values[number(hash_slot, m)] = 77;
      hash.tags[number(hash_slot, m)] = std::uint32_t(number(p, side));
      Outcome out;
      for (const Membership membership : {Membership::tags, Membership::domain})
        out.add(absolute("value", 77, level_on_device({gpu::Context::get(), hash.extent, hash, membership}, p), 0));
      return out;
    };
  return check;
}

Check read_hash_round_trip(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const Vector3i domain = integers(in["domain"], 1, 512);
  const int threshold = in["threshold"].integer_in(0, 126);
  const auto positions = [&](const Value& list) {
    std::vector<Vector3i> all;
    for (std::size_t i = 0; i < list.size(); ++i) all.push_back(integers(list[i], -(1 << 20), 1 << 20));
    return all;
  };
  const std::vector<Vector3i> stored = positions(in["positions"]), absent = positions(in["absent_positions"]);
  const std::vector<double> residual = in["residual"].numbers(), levels = expected["quantised"].numbers();
  const std::vector<double> decoded = expected["decoded"].numbers(), nothing = expected["decoded_absent"].numbers();
  if (residual.size() != stored.size() || levels.size() != stored.size() || decoded.size() != stored.size() ||
      nothing.size() != absent.size())
    v.complain("as many residuals, levels and decoded values as positions");
  for (std::size_t i = 0; i < stored.size(); ++i)
    if ((stored[i].array() < 0).any() || (stored[i].array() >= domain.array()).any())
      in["positions"][i].complain("a position within the domain");
  const double step = expected["q"].number(), worst = expected["max_abs_error"].number();
  const int count = expected["count"].integer_in(0, 1 << 27);
  const OwnTolerance t = tolerance_of(v);
  const auto quantise = [=] {
    std::vector<double> dense(std::size_t(domain.prod()), 0.0);
    for (std::size_t i = 0; i < stored.size(); ++i)
      dense[stored[i][0] + std::size_t(domain[0]) * (stored[i][1] + std::size_t(domain[1]) * stored[i][2])] =
          residual[i];
    return scene::quantised(domain, dense, {threshold, {}});
  };
  // Levels of a store of `found` voxels at stored positions, and at positions without a voxel.
  using LevelAt = std::function<int(const Vector3i&)>;
  const auto compare_store = [=](Outcome& out, double found, double q, const LevelAt& level_at,
                                 const LevelAt& without) {
    out.add(absolute("count", count, found, 0));
    double greatest = 0;
    for (std::size_t i = 0; i < stored.size(); ++i) {
      const int level = level_at(stored[i]);
      out.add(absolute(fmt::format("level {}", i), levels[i], level, 0));
      out.add(compare(fmt::format("decoded {}", i), decoded[i], q * level, t));
      greatest = std::max(greatest, std::abs(q * level - residual[i]));
    }
    for (std::size_t i = 0; i < absent.size(); ++i)
      out.add(compare(fmt::format("absent {}", i), nothing[i], q * without(absent[i]), t));
    out.add(compare("greatest error", worst, greatest, t));
  };
  return {"",
          [=](VerifyProfile) {
            const scene::ResidualLevels quantised = quantise();
            const auto voxels = scene::hashed_voxels(domain, quantised.values);
            const scene::PerfectHash hash = scene::perfect_hash(domain, voxels);
            Outcome out;
            out.add(compare("q", step, quantised.step, t));
            out.add(truth("perfect", scene::imperfection(hash, voxels).empty()));
            compare_store(
                out, double(voxels.size()), quantised.step, [&](const Vector3i& p) { return hash.value_by_tag(p); },
                [&](const Vector3i& p) { return hash.value_by_domain(p); });
            return out;
          },
          [=](VerifyProfile) {
            gpu::Context& context = gpu::Context::get();
            const scene::ResidualLevels quantised = quantise();
            const auto hash = scene::perfect_hash(domain, scene::hashed_voxels(domain, quantised.values));
            const ResidualOnDevice stores[] = {{context, domain, scene::apron_bricks_of(domain, quantised.values)},
                                               {context, domain, hash, Membership::tags},
                                               {context, domain, hash, Membership::domain}};
            Outcome out;
            for (const ResidualOnDevice& store : stores) {
              const std::vector<int> all = levels_on_device(context, store, Vector3i::Zero(), domain);
              const auto level = [&](const Vector3i& p) { return level_on_device(store, p); };
              compare_store(out, double(all.size()) - double(std::count(all.begin(), all.end(), 0)), quantised.step,
                            level, level);
            }
            return out;
          }};
}

Check read_gaussian_optical_depth(const Value& v) {
  const Value in = v["input"];
  const double d = in["d"].number(), mu = in["mu"].number_in(-1, 1), radius = in["radius"].number();
  const double cut = in["cut"].json().is_null() ? infinity : in["cut"].number();
  const double expected = v["expected"].number();
  const OwnTolerance t = tolerance_of(v);
  scene::GaussianSum sum;
  sum.cutoff = cut;
  sum.gaussians = {{d * radius * Vec3(std::sqrt(1 - mu * mu), 0, mu), radius, 1}};
  const Ray ray{Point3::Zero(), Vec3::UnitZ()};
  return {"",
          [=](VerifyProfile) {
            return Outcome{{compare("per width", expected, density_integral(sum, ray, {0, infinity}) / radius, t)}};
          },
          [=](VerifyProfile) {
            const Given given{{"slices", "1024"}, {"multiple", "none"}};
            const auto s = smoke_scene(sum, 1 / radius);
            // Slices of 1/170 width at most: a cut that lies within one is 1.2e-4 of a half of it; the rest is rounding.
            const double eye = OneRay(device_renderer, s, given)(ray).get("transmittance", 0, 0)[0];
            // The closed form, on the way from a surface to a light, beside that to the eye.
            s->lights = {scene::DirectionalLight{Vec3::UnitZ(), Rgb::Ones()}};
            s->surfaces = {{"plane", scene::Plane{Point3::Zero(), Vec3::UnitZ()}, scene::Lambert{Rgb::Constant(0.5)}}};
            finish(*s);
            const Point3 from = Vec3(-3, 1, 8) * radius;
            const scene::Film lit = OneRay(device_renderer, s, given)({from, -from.normalized()});
            const double left = lit.get("surface", 0, 0)[0] / lit.get("transmittance", 0, 0)[0] / (0.5 / pi);
            return Outcome{{absolute("by slices", expected, -std::log(eye), 4e-6 + 2 * gpu::injected_error()),
                            absolute("to a light", expected, -std::log(left), 4e-6 + 4 * gpu::injected_error())}};
          }};
}

Check read_trilinear_border(const Value& v) {
  const Value in = v["input"], values = in["values_x_y_z"], points = in["points"];
  const Vector3i size = integers(in["resolution"], 1, 64);
  const Vec3 lo = in["box_min"].vector(), hi = in["box_max"].vector();
  // Decimals of three places, which single precision keeps exactly as integers.
  scene::VoxelGrid grid;
  grid.size = size;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) {
        const double thousandths = 1000 * values[std::size_t(x)][std::size_t(y)][std::size_t(z)].number_in(0, 1000);
        if (std::abs(thousandths - std::round(thousandths)) > 1e-9) values.complain("decimals of three places");
        grid.values.push_back(float(std::round(thousandths)));
      }
  std::vector<Vec3> samples;
  for (std::size_t i = 0; i < points.size(); ++i)
    samples.push_back((points[i].vector() - lo).cwiseQuotient(hi - lo).cwiseProduct(size.cast<double>()) -
                      Vec3::Constant(0.5));
  const std::vector<double> clamped = v["expected"]["clamp"].numbers(), zero = v["expected"]["zero"].numbers();
  if (clamped.size() != samples.size() || zero.size() != samples.size()) v.complain("as many values as points");
  const OwnTolerance t = tolerance_of(v);
  const auto compare_both = [=](auto&& densities, const OwnTolerance& t) {
    Outcome out;
    scene::VoxelGrid of_border = grid;
    for (const bool clamp : {true, false}) {
      of_border.clamp_border = clamp;
      std::vector<double> got;
      for (const auto density : densities(of_border)) got.push_back(double(density) / 1000);
      compare_all(out, clamp ? "clamp" : "zero", clamp ? clamped : zero, got, t);
    }
    return out;
  };
  return {"",
          [=](VerifyProfile) {
            return compare_both(
                [&](const scene::VoxelGrid& of_border) {
                  std::vector<double> got;
                  for (const Vec3& x : samples) got.push_back(scene::density_at_sample(of_border, x));
                  return got;
                },
                t);
          },
          [=](VerifyProfile) {
            std::vector<Vec3> places;
            double most = *std::max_element(grid.values.begin(), grid.values.end()) / 1000.0, farthest = 1;
            for (const Vec3& x : samples) {
              places.push_back(sample_to_world(grid, x));
              farthest = std::max(farthest, x.cwiseAbs().maxCoeff());
            }
            // Places are rounded to 2^-23 of the next power of 2, and densities differ by as much as the greatest along three axes.
            const double error = 3 * most * std::exp2(std::ceil(std::log2(farthest)) - 23);
            return compare_both([&](const scene::VoxelGrid& g) { return densities_on_device(g, places); }, {0, error});
          }};
}

}  // namespace airlight::experiments::verification
