#include "reference/light_map/light_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "scene/base/flush_subnormals.h"
#include "scene/base/limits.h"
#include "scene/light/same_light.h"

namespace airlight::light_map {
namespace {

constexpr int texels_at_once = 32;

std::size_t padded(std::size_t n) { return (n + 63) / 64 * 64; }

// Where a medium varies, without what is below 1.2e-7 of a Gaussian's amplitude: 1.5e-8 of its column.
Box varied_box(const scene::Medium& medium) {
  constexpr double widths = 4;
  Box box = varied_support(medium.field);
  if (const auto* sum = std::get_if<scene::GaussianSum>(&medium.field)) {
    box = {};
    for (const scene::Gaussian& g : sum->gaussians) {
      const Vec3 half = Vec3::Constant(g.width * std::min(widths, sum->cutoff));
      box = unite(box, {g.center - half, g.center + half});
    }
  }
  return intersect(box, bounding_box(medium.region));
}

bool is_grey(const scene::Medium& medium) { return (medium.sigma_t == medium.sigma_t[0]).all(); }

bool is_negative_somewhere(const scene::Medium& medium) {
  const auto* sum = std::get_if<scene::GaussianSum>(&medium.field);
  return sum && sum->constant > 0 &&
         std::any_of(sum->gaussians.begin(), sum->gaussians.end(), [](const auto& g) { return g.amplitude < 0; });
}

}  // namespace

Interval VariedMedia::Part::extent(const Ray& ray, Interval t) const {
  t = clip(medium->region, ray, t);
  if (t.empty()) return t;
  // A grid may be rotated in its box.
  return grid_of(medium->field) ? scene::extent(medium->field, ray, t) : clip(scene::Region(box), ray, t);
}

// Working memory for some texels in a row: the parts of steps that lie in one medium, and the optical
// depths of all steps.
struct LightMap::Row {
  std::vector<double> x, y, z, length;
  std::vector<float> density;
  std::vector<std::size_t> step;  // texel * steps + step
  std::vector<double> depth[3];

  void clear() {
    for (auto* v : {&x, &y, &z, &length}) v->clear();
    step.clear();
  }
  void add(const Point3& at, double metres, std::size_t slot) {
    x.push_back(at[0]), y.push_back(at[1]), z.push_back(at[2]), length.push_back(metres), step.push_back(slot);
  }
};

VariedMedia varied_media(const std::vector<scene::Medium>& media, const Options& options) {
  VariedMedia varied;
  for (std::size_t i = 0; i < media.size(); ++i) {
    const scene::Medium& medium = media[i];
    const Box box = varied_box(medium);
    if (!extinguishes(medium) || box.empty()) continue;
    varied.parts.push_back({i, &medium, box, medium.sigma_t});
    varied.box = unite(varied.box, box);
    varied.negative = varied.negative || is_negative_somewhere(medium);
    varied.grey = varied.grey && is_grey(medium);
  }
  if (varied.parts.empty()) return varied;
  const bool one = varied.parts.size() == 1 && options.encoding != Encoding::avsm;
  varied.planes = varied.grey || one ? 1 : 3;
  if (!varied.grey && varied.planes == 1) {
    VariedMedia::Part& part = varied.parts[0];
    part.extinction = Rgb::Constant(part.medium->sigma_t.maxCoeff());
    varied.share = part.medium->sigma_t / part.medium->sigma_t.maxCoeff();
  }
  return varied;
}

double bytes_of_map(const VariedMedia& varied, const Options& options) {
  return varied.planes * bytes_per_plane(options);
}

Densities densities_of(const std::vector<scene::Medium>& media) {
  return
      [&media](std::size_t medium, std::size_t n, const double* x, const double* y, const double* z, float* density) {
        const scene::DensityField& field = media[medium].field;
        const double constant = constant_part(field);
        for (std::size_t i = 0; i < n; ++i)
          density[i] = float(scene::density(field, Point3(x[i], y[i], z[i])) - constant);
      };
}

LightMap::LightMap(const scene::Light& light, const std::vector<scene::Medium>& media, const Options& options,
                   const Densities& densities, const scene::Execution& execution)
    : light_(light), options_(options), varied_(varied_media(media, options)) {
  if (const std::string reason = unsupported(options); !reason.empty()) throw Error("light map: " + reason);
  for (const scene::Medium& medium : media)
    if (const double constant = constant_part(medium.field); extinguishes(medium) && constant > 0)
      constants_.push_back({medium.region, constant * medium.sigma_t});
  if (empty()) return;
  projection_ = fit(light, varied_.box, options.size);
  const std::size_t side = options.size + 2;
  for (int c = 0; c < varied_.planes; ++c) texels_[c].resize(side * side * floats_per_texel(options));
  make_texels(densities, execution);
  make_border();
  varied_.parts.clear();  // a map may outlive the media, in frames in which they do not change
}

void LightMap::make_texels(const Densities& densities, const scene::Execution& execution) {
  const Encoder encoder(options_);
  scene::parallel_for(options_.size, execution, [&](int j) {
    const scene::FlushSubnormals flush;
    static thread_local Row row;
    for (int begin = 0; begin < options_.size; begin += texels_at_once) {
      const int end = std::min(begin + texels_at_once, options_.size);
      march(densities, j, begin, end, row);
      for (int c = 0; c < varied_.planes; ++c)
        for (int i = begin; i < end; ++i)
          encoder.encode({row.depth[c].data() + std::size_t(i - begin) * options_.steps, std::size_t(options_.steps)},
                         texels_[c].data() + offset(i, j));
    }
  });
}

// The optical depths of the steps of texels [begin, end) of row j. A medium counts in a step with the length that lies in
// it, and with its density at the middle of that.
void LightMap::march(const Densities& densities, int j, int begin, int end, Row& row) const {
  const int steps = options_.steps;
  const Interval range = projection_.depth;
  const double h = range.length() / steps;
  for (int c = 0; c < varied_.planes; ++c) row.depth[c].assign(std::size_t(end - begin) * steps, 0.0);
  for (const VariedMedia::Part& part : varied_.parts) {
    row.clear();
    for (int i = begin; i < end; ++i) {
      const Ray ray = texel_ray(projection_, i, j);
      const Interval inside = part.extent(ray, range);
      if (inside.empty()) continue;
      const int first = std::max(0, int((inside.lo - range.lo) / h));
      for (int s = first; s < steps && range.lo + s * h < inside.hi; ++s) {
        const Interval step = intersect({range.lo + s * h, range.lo + (s + 1) * h}, inside);
        if (!step.empty())
          row.add(ray.at(0.5 * (step.lo + step.hi)), step.length(), std::size_t(i - begin) * steps + std::size_t(s));
      }
    }
    const std::size_t n = row.step.size();
    if (n == 0) continue;
    for (auto* v : {&row.x, &row.y, &row.z}) v->resize(padded(n));
    row.density.resize(padded(n));
    densities(part.number, n, row.x.data(), row.y.data(), row.z.data(), row.density.data());
    for (int c = 0; c < varied_.planes; ++c)
      for (std::size_t k = 0; k < n; ++k)
        row.depth[c][row.step[k]] += part.extinction[c] * row.length[k] * double(row.density[k]);
  }
}

// Sets the border that interpolation reads around the outermost texels. The octahedron's edges meet themselves, with
// their halves exchanged; other maps end there.
void LightMap::make_border() {
  const int size = options_.size, floats = floats_per_texel(options_);
  const bool whole = projection_.whole_sphere();
  const auto outside = [&](int k) { return k < 0 || k >= size; };
  for (int j = -1; j <= size; ++j)
    for (int i = -1; i <= size; ++i) {
      if (!outside(i) && !outside(j)) continue;
      int from_i = i, from_j = j;
      if (outside(from_i)) {
        from_i = std::clamp(from_i, 0, size - 1);
        if (whole) from_j = size - 1 - from_j;
      }
      if (outside(from_j)) {
        from_j = std::clamp(from_j, 0, size - 1);
        if (whole) from_i = size - 1 - from_i;
      }
      for (int c = 0; c < varied_.planes; ++c)
        std::copy_n(texel(c, from_i, from_j), floats, texels_[c].data() + offset(i, j));
    }
}

std::size_t LightMap::offset(int i, int j) const {
  return (std::size_t(j + 1) * (options_.size + 2) + std::size_t(i + 1)) * floats_per_texel(options_);
}

const float* LightMap::texel(int plane, int i, int j) const { return texels_[plane].data() + offset(i, j); }

std::size_t LightMap::bytes() const {
  return sizeof(float) * (texels_[0].size() + texels_[1].size() + texels_[2].size());
}

Rgb LightMap::varied_depth(const Point3& x) const {
  if (empty()) return Rgb::Zero();
  const Place at = place(projection_, x);
  if (at.depth == 0) return Rgb::Zero();
  const int i = int(std::floor(at.x - 0.5)), j = int(std::floor(at.y - 0.5));
  const double right = at.x - 0.5 - i, below = at.y - 0.5 - j;
  const double weights[2][2] = {{(1 - right) * (1 - below), right * (1 - below)}, {(1 - right) * below, right * below}};
  Rgb depth = Rgb::Zero();
  for (int c = 0; c < varied_.planes; ++c) {
    double sum = 0;
    for (int dj = 0; dj < 2; ++dj)
      for (int di = 0; di < 2; ++di) sum += weights[dj][di] * decode(options_, texel(c, i + di, j + dj), at.depth);
    depth[c] = varied_.negative ? sum : std::max(sum, 0.0);
  }
  return varied_.planes == 1 ? Rgb(depth[0] * varied_.share) : depth;
}

Rgb LightMap::optical_depth(const Point3& x) const { return varied_depth(x) + constant_depth(x); }

Rgb LightMap::constant_depth(const Point3& x) const {
  Rgb depth = Rgb::Zero();
  if (constants_.empty()) return depth;
  const scene::Incident from = incident(light_, x);
  for (const Constant& constant : constants_) {
    const double length = clip(constant.region, {x, from.to_light}, {0, from.distance}).length();
    for (int c = 0; c < 3; ++c)
      if (constant.extinction[c] > 0) depth[c] += constant.extinction[c] * length;
  }
  return depth;
}

MapView LightMap::view(int plane) const {
  return {texels_[plane].data(), (options_.size + 2) * floats_per_texel(options_), options_, varied_.negative};
}

void LightMap::varied_depths(std::size_t n, const double* x, const double* y, const double* z,
                             float* const* depth) const {
  if (empty()) {
    std::fill_n(depth[0], n, 0.0f);
    return;
  }
  static thread_local std::vector<std::int32_t> texels;
  static thread_local std::vector<float> shares[3];
  texels.resize(padded(n));
  for (auto& share : shares) share.resize(padded(n));
  const Places places{texels.data(), shares[0].data(), shares[1].data(), shares[2].data()};
  find_places(rule_of(projection_), floats_per_texel(options_), n, x, y, z, places);
  for (int c = 0; c < varied_.planes; ++c) look_up(view(c), n, places, depth[c]);
  if (varied_.grey || varied_.planes == 3) return;
  for (int c = 2; c >= 0; --c)
    for (std::size_t i = 0; i < n; ++i) depth[c][i] = float(varied_.share[c]) * depth[0][i];
}

Maps make_maps(const std::vector<scene::Light>& lights, const std::vector<scene::Medium>& media, const Options& options,
               const Densities& densities, const scene::Execution& execution, const std::string& who,
               const std::vector<scene::Light>& lights_before,
               const std::vector<std::shared_ptr<const LightMap>>& before) {
  scene::require_memory(double(lights.size()) * bytes_of_map(varied_media(media, options), options),
                        fmt::format("{}: maps of {} lights", who, lights.size()));
  Maps maps;
  scene::Execution part = execution;
  for (const scene::Light& light : lights) {
    // Most lights keep their number from frame to frame.
    const std::size_t l = maps.of_lights.size();
    if (l < before.size() && scene::same_rays(lights_before[l], light)) {
      maps.of_lights.push_back(before[l]);
      continue;
    }
    if (execution.progress)
      part.progress = [&](double fraction) {
        return execution.progress((double(maps.of_lights.size()) + fraction) / double(lights.size()));
      };
    maps.of_lights.push_back(std::make_shared<LightMap>(light, media, options, densities, part));
    ++maps.made;
  }
  return maps;
}

}  // namespace airlight::light_map
