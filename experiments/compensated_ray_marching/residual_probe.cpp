#include "experiments/compensated_ray_marching/residual_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/compensated_ray_marching/fitted_smoke.h"
#include "experiments/compensated_ray_marching/nano_grid.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/convert/hashed_sequence.h"
#include "scene/convert/perfect_hash.h"
#include "scene/convert/residual.h"
#include "scene/math/random.h"

namespace airlight::experiments {
namespace {

using Eigen::Vector3i;
using Positions = std::vector<Vector3i>;

enum class Store { raw, bricks, apron, hash_tags, hash_domain, hash_sequence, nano_floats, nano_eight_bits };
enum class Of { residual, density };
const scene::Choices<Store> stores{{"raw", Store::raw},
                                   {"bricks", Store::bricks},
                                   {"apron", Store::apron},
                                   {"hash_tags", Store::hash_tags},
                                   {"hash_domain", Store::hash_domain},
                                   {"hash_sequence", Store::hash_sequence},
                                   {"nano_floats", Store::nano_floats},
                                   {"nano_eight_bits", Store::nano_eight_bits}};
const scene::Choices<Of> quantities{{"residual", Of::residual}, {"density", Of::density}};
using Offsets = scene::HashOptions::Offsets;
const scene::Choices<Offsets> offsets{
    {"thirds", Offsets::thirds}, {"root_thirds", Offsets::root_thirds}, {"sixths", Offsets::sixths}};

constexpr int middle_frame = scene::HashedSequence::frames_per_table / 2;

Positions random_positions(const Vector3i& size, int count) {
  Positions positions;
  for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
    const PhiloxCounter w = philox4x32_10({i, 0, 0, 0}, {41, 1});
    positions.emplace_back(int(w[0] % unsigned(size[0])), int(w[1] % unsigned(size[1])), int(w[2] % unsigned(size[2])));
  }
  return positions;
}

// One sample after another, x fastest, over and over.
Positions consecutive_positions(const Vector3i& size, int count) {
  Positions positions;
  for (int i = 0; i < count; ++i)
    positions.emplace_back(i % size[0], i / size[0] % size[1], i / size[0] / size[1] % size[2]);
  return positions;
}

// The residual to store, and the positions of lookups.
struct Task {
  Vector3i size;
  std::vector<std::int8_t> levels;
  std::vector<std::vector<std::int8_t>> frames;  // of hash_sequence; the one that is looked up is `levels`
  Positions random, consecutive;
  int runs;
  int level(const Vector3i& p) const {
    return levels[p[0] + std::size_t(size[0]) * (p[1] + std::size_t(size[1]) * p[2])];
  }
};

struct Measured {
  double bytes = 0;
  std::vector<double> build, random, consecutive;  // [s], run by run; of all look-ups together
};

template <class Level>
double sum_of(const Positions& positions, Level&& level) {
  double sum = 0;
  for (const Vector3i& p : positions) sum += level(p);
  return sum;
}

// `build` makes the store and gives back its bytes, `sum` adds up what it has at positions. Throws Error if that is not what was stored.
template <class Build, class Sum>
Measured measure(const Task& task, double tolerance, Build&& build, Sum&& sum) {
  Measured m;
  scene::Stopwatch watch;
  for (int i = 0; i < task.runs; ++i) {
    watch.lap();
    m.bytes = double(build());
    m.build.push_back(watch.lap());
  }
  const auto time = [&](const Positions& at, std::vector<double>& seconds) {
    const double expected = sum_of(at, [&](const Vector3i& p) { return task.level(p); });
    for (int i = 0; i < task.runs; ++i) {
      watch.lap();
      const double got = sum(at);
      seconds.push_back(watch.lap());
      if (std::abs(got - expected) > tolerance)
        throw Error(fmt::format("residual_stores: levels add up to {}, expected {}", got, expected));
    }
  };
  time(task.random, m.random);
  time(task.consecutive, m.consecutive);
  return m;
}

template <class Built, class Make, class Bytes, class Level>
Measured measure_levels(const Task& task, Built& built, Make&& make, Bytes&& bytes, Level&& level) {
  return measure(
      task, 0,
      [&] {
        built = make();
        return bytes(built);
      },
      [&](const Positions& at) { return sum_of(at, [&](const Vector3i& p) { return level(built, p); }); });
}

Measured measure_nano(const Task& task, NanoGrid::Values values) {
  std::unique_ptr<NanoGrid> grid;
  const std::vector<float> levels(task.levels.begin(), task.levels.end());
  // Eight bits between the extremes of each leaf: half a level off at most, where they are -127 and 127.
  const double off = values == NanoGrid::Values::floats ? 0 : 0.51 * double(task.random.size());
  return measure(
      task, off,
      [&] {
        grid = std::make_unique<NanoGrid>(task.size, levels, values);
        return grid->bytes();
      },
      [&](const Positions& at) { return grid->sum_at(at); });
}

// Frames in one table; sizes and times are those of one frame among 27. `hash` becomes the table.
Measured measure_sequence(const Task& task, const scene::HashOptions& options, scene::PerfectHash& hash) {
  scene::HashedSequence sequence;
  const double frames = double(task.frames.size());
  Measured m = measure_levels(
      task, sequence, [&] { return scene::hashed_sequence(task.size, task.frames, options); },
      [&](const auto& h) { return double(h.tables[0].bytes_with_tags()) / frames; },
      [](const auto& h, const Vector3i& p) { return h.value(middle_frame, p); });
  for (double& seconds : m.build) seconds /= frames;
  for (std::size_t f = 0; f < task.frames.size(); ++f)
    for (std::size_t i = 0; i < task.levels.size(); ++i) {
      const int x = int(i) % task.size[0], y = int(i) / task.size[0] % task.size[1];
      const Vector3i at(x, y, int(i) / task.size[0] / task.size[1]);
      if (sequence.value(int(f), at) != task.frames[f][i])
        throw Error(fmt::format("residual_stores: frame {} of the hash is not the frame at ({})", f,
                                fmt::join(at.data(), at.data() + 3, ", ")));
    }
  hash = std::move(sequence.tables[0]);
  return m;
}

Measured measure_store(const Task& task, const scene::Settings& s, scene::PerfectHash& hash) {
  const scene::HashOptions options{s.choice("offsets", offsets), 1};
  const auto hashed = [&](auto bytes, auto level) {
    return measure_levels(
        task, hash,
        [&] { return scene::perfect_hash(task.size, scene::hashed_voxels(task.size, task.levels), options); }, bytes,
        level);
  };
  switch (s.choice("store", stores)) {
    case Store::raw: {
      std::vector<std::int8_t> copy;
      return measure_levels(
          task, copy, [&] { return task.levels; }, [](const auto& levels) { return levels.size(); },
          [&](const auto& levels, const Vector3i& p) {
            return levels[p[0] + std::size_t(task.size[0]) * (p[1] + std::size_t(task.size[1]) * p[2])];
          });
    }
    case Store::bricks: {
      scene::ResidualBricks bricks;
      const int edge = int(s.integer("edge"));
      return measure_levels(
          task, bricks, [&] { return scene::bricks_of(task.size, task.levels, edge); },
          [](const auto& b) { return b.bytes(); }, [](const auto& b, const Vector3i& p) { return b.level(p); });
    }
    case Store::apron: {
      scene::ApronBricks bricks;
      return measure_levels(
          task, bricks, [&] { return scene::apron_bricks_of(task.size, task.levels); },
          [](const auto& b) { return b.bytes(); },
          [](const auto& b, const Vector3i& p) { return level_between(b, p.template cast<double>()); });
    }
    case Store::hash_tags:
      return hashed([](const auto& h) { return h.bytes_with_tags(); },
                    [](const auto& h, const Vector3i& p) { return h.value_by_tag(p); });
    case Store::hash_domain:
      return hashed([](const auto& h) { return h.bytes_with_domain(); },
                    [](const auto& h, const Vector3i& p) { return h.value_by_domain(p); });
    case Store::hash_sequence:
      return measure_sequence(task, options, hash);
    case Store::nano_floats:
      return measure_nano(task, NanoGrid::Values::floats);
    case Store::nano_eight_bits:
      return measure_nano(task, NanoGrid::Values::eight_bits);
  }
  throw Error("residual_stores: no such store");
}

double relative_l2(const scene::VoxelGrid& original, const scene::VoxelGrid& other) {
  double error = 0, norm = 0;
  for (std::size_t i = 0; i < original.values.size(); ++i) {
    error += std::pow(double(other.values[i]) - original.values[i], 2);
    norm += std::pow(double(original.values[i]), 2);
  }
  return norm > 0 ? std::sqrt(error / norm) : 0;
}

}  // namespace

std::string ResidualStores::about() const {
  return "size, build and look-up time of a quantised residual: perfect hash, bricks, NanoVDB, raw; Zhou et al. 2008, section 5.2";
}

std::vector<scene::SettingSpec> ResidualStores::settings() const {
  return {scene::choice_setting(
              "store", Store::bricks, stores,
              "apron: bricks of 8^3 cells with 9^3 samples; hash_tags, hash_domain: how it tells what is stored; "
              "hash_sequence: a 27th of 27 frames in one"),
          scene::choice_setting("smoke", "scene", {"scene", "noise"}, "the grid of the scene's medium, or curl noise"),
          scene::integer_setting("size", "64", 8, 256, "samples along a side of the curl noise"),
          scene::integer_setting("gaussians", "400", 0, 100000, "that the residual is against"),
          scene::integer_setting("threshold", "0", 0, 126, "levels of this size or less are dropped"),
          scene::flag_setting("keep_empty", false, "no density where the smoke has none, whatever the threshold"),
          scene::choice_setting("step", Of::residual, quantities, "of a level: max|R|/127, or max D/255"),
          scene::choice_setting("of", Of::residual, quantities, "what is stored: the residual, or the density itself"),
          scene::real_setting(
              "rise", "0", 0, 1,
              "hash_sequence: of the curl noise from frame to frame, m, each with Gaussians of its own; 0: one frame "
              "27 times"),
          scene::integer_setting("edge", "8", 1, 64, "of bricks"),
          scene::choice_setting("offsets", Offsets::thirds, offsets,
                                "first r of a hash: cbrt(K/3) + 9, cbrt(K)/3 + 9, cbrt(K/6)"),
          scene::integer_setting("lookups", "1000000", 1, 1e8, "that are timed, random and one after another"),
          scene::integer_setting("runs", "5", 1, 1000, "timed")};
}

std::vector<std::string> ResidualStores::figures() const {
  return {"kB", "of_raw", "nonzero_percent", "error_percent", "fit_percent", "build_ms", "random_ns", "consecutive_ns",
          "m",  "r",      "retries",         "largest_bucket"};
}

Findings ResidualStores::run(const ProbeInput& input, const scene::Settings& s,
                             const scene::Execution& execution) const {
  const bool moves = s.real("rise") > 0;
  if (moves && (s.choice("store", stores) != Store::hash_sequence || s.text("smoke") == "scene"))
    throw Error("residual_stores: rise has an effect with store = hash_sequence and smoke = noise alone");
  const auto noise = [&](int frame) { return noise_smoke(int(s.integer("size")), s.real("rise") * frame); };
  const scene::VoxelGrid grid = s.text("smoke") == "scene" ? grid_of_scene(input) : noise(moves ? middle_frame : 0);
  const bool density = s.choice("of", quantities) == Of::density;
  const int gaussians = density ? 0 : int(s.integer("gaussians"));
  const scene::GaussianSum sum = gaussians_for(grid, gaussians, execution);
  scene::QuantisationOptions options;
  options.threshold = int(s.integer("threshold"));
  options.keep_empty = s.flag("keep_empty");
  const float most = *std::max_element(grid.values.begin(), grid.values.end());
  if (s.choice("step", quantities) == Of::density) options.step = most / 255;
  const scene::Residual residual = scene::residual_of(grid, sum, options);
  Task task{residual.layout.size, levels_of(residual.bricks), {}, {}, {}, int(s.integer("runs"))};
  if (s.choice("store", stores) == Store::hash_sequence) {
    task.frames.assign(scene::HashedSequence::frames_per_table, task.levels);
    for (int frame = 0; moves && frame < scene::HashedSequence::frames_per_table; ++frame) {
      if (frame == middle_frame) continue;
      const scene::VoxelGrid other = noise(frame);
      const auto left = scene::residual_of(other, gaussians_for(other, gaussians, execution), options);
      task.frames[std::size_t(frame)] = levels_of(left.bricks);
    }
  }
  task.random = random_positions(task.size, int(s.integer("lookups")));
  task.consecutive = consecutive_positions(task.size, int(s.integer("lookups")));
  const auto voxels = scene::hashed_voxels(task.size, task.levels);

  scene::PerfectHash hash;
  const Measured m = measure_store(task, s, hash);
  const double samples = double(task.levels.size()), lookups = double(task.random.size());
  Findings found;
  found.figures = {exactly("kB", 1e-3 * m.bytes),
                   exactly("of_raw", m.bytes / samples),
                   exactly("nonzero_percent", 100 * double(voxels.size()) / samples),
                   exactly("error_percent", 100 * relative_l2(grid, decoded(sum, residual))),
                   exactly("fit_percent", 100 * relative_l2(grid, decoded(residual.layout, sum, {}))),
                   measured("build_ms", scaled(m.build, 1e3)),
                   measured("random_ns", scaled(m.random, 1e9 / lookups)),
                   measured("consecutive_ns", scaled(m.consecutive, 1e9 / lookups))};
  if (hash.m > 0) {
    const std::string wrong = hash.voxels == voxels.size() ? imperfection(hash, voxels) : "";
    if (!wrong.empty()) throw Error("residual_stores: the hash is not perfect: " + wrong);
    for (const auto& [name, value] :
         {std::pair("m", hash.m), {"r", hash.r}, {"retries", hash.retries}, {"largest_bucket", hash.largest_bucket}})
      found.figures.push_back(exactly(name, value));
  }
  set_time(found, m.random);
  return found;
}

}  // namespace airlight::experiments
