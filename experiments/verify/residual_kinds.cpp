// Zhou et al. 2008: the residual and its hash, the line integral of a Gaussian, the border of a voxel grid.
#include <algorithm>
#include <cmath>

#include "experiments/application/json_value.h"
#include "experiments/verify/own_tolerance.h"
#include "experiments/verify/readers.h"
#include "scene/convert/perfect_hash.h"
#include "scene/convert/residual.h"
#include "scene/media/gaussian_sum.h"
#include "scene/media/voxel_grid.h"

namespace airlight::experiments::verification {
namespace {

using Eigen::Vector3i;

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

}  // namespace

Check read_psh_address(const Value& v) {
  const Value in = v["input"], expected = v["expected"];
  const int m = in["m"].integer_in(1, 256), r = in["r"].integer_in(1, 256);
  const Vector3i p = integers(in["p"], 0, 1 << 20), offset = integers(in["offset"], 0, m - 1);
  const Vector3i offset_slot = integers(expected["offset_slot"], 0, r - 1);
  const Vector3i hash_slot = integers(expected["hash_slot"], 0, m - 1);
  return {"", [=](VerifyProfile) {
            scene::PerfectHash hash;
            hash.m = m, hash.r = r;
            hash.offsets.assign(std::size_t(r) * r * r, 0);
            const std::size_t at = hash.offset_slot(p);
            hash.offsets[at] = std::uint32_t(offset[0] | offset[1] << 10 | offset[2] << 20);
            Outcome out{compare("offset slot", offset_slot, split(at, r))};
            for (Comparison& c : compare("hash slot", hash_slot, split(hash.slot(p), m)))
              out.comparisons.push_back(std::move(c));
            return out;
          }};
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
  return {"", [=](VerifyProfile) {
            std::vector<double> dense(std::size_t(domain.prod()), 0.0);
            for (std::size_t i = 0; i < stored.size(); ++i)
              dense[stored[i][0] + std::size_t(domain[0]) * (stored[i][1] + std::size_t(domain[1]) * stored[i][2])] =
                  residual[i];
            const scene::ResidualLevels quantised = scene::quantised(domain, dense, {threshold, {}});
            const auto voxels = scene::hashed_voxels(domain, quantised.values);
            const scene::PerfectHash hash = scene::perfect_hash(domain, voxels);
            Outcome out;
            out.comparisons.push_back(compare("q", step, quantised.step, t));
            out.comparisons.push_back(absolute("count", count, double(voxels.size()), 0));
            out.comparisons.push_back(truth("perfect", scene::imperfection(hash, voxels).empty()));
            double greatest = 0;
            for (std::size_t i = 0; i < stored.size(); ++i) {
              const int level = hash.value_by_tag(stored[i]);
              const double value = quantised.step * level;
              out.comparisons.push_back(absolute(fmt::format("level {}", i), levels[i], level, 0));
              out.comparisons.push_back(compare(fmt::format("decoded {}", i), decoded[i], value, t));
              greatest = std::max(greatest, std::abs(value - residual[i]));
            }
            for (std::size_t i = 0; i < absent.size(); ++i)
              out.comparisons.push_back(compare(fmt::format("absent {}", i), nothing[i],
                                                quantised.step * hash.value_by_domain(absent[i]), t));
            out.comparisons.push_back(compare("greatest error", worst, greatest, t));
            return out;
          }};
}

Check read_gaussian_optical_depth(const Value& v) {
  const Value in = v["input"];
  const double d = in["d"].number(), mu = in["mu"].number_in(-1, 1), radius = in["radius"].number();
  const double cut = in["cut"].json().is_null() ? infinity : in["cut"].number();
  const double expected = v["expected"].number();
  const OwnTolerance t = tolerance_of(v);
  return {
      "", [=](VerifyProfile) {
        scene::GaussianSum sum;
        sum.cutoff = cut;
        sum.gaussians = {{d * radius * Vec3(std::sqrt(1 - mu * mu), 0, mu), radius, 1}};
        const Ray ray{Point3::Zero(), Vec3::UnitZ()};
        return Outcome{{compare("per width", expected, scene::density_integral(sum, ray, {0, infinity}) / radius, t)}};
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
  return {"", [=, grid = std::move(grid)](VerifyProfile) mutable {
            Outcome out;
            for (const bool clamp : {true, false}) {
              grid.clamp_border = clamp;
              for (std::size_t i = 0; i < samples.size(); ++i)
                out.comparisons.push_back(compare(fmt::format("{} {}", clamp ? "clamp" : "zero", i),
                                                  (clamp ? clamped : zero)[i],
                                                  scene::density_at_sample(grid, samples[i]) / 1000, t));
            }
            return out;
          }};
}

}  // namespace airlight::experiments::verification
