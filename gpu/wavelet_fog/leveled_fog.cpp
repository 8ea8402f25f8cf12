#include "gpu/wavelet_fog/leveled_fog.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "gpu/raster/hit_image.h"
#include "gpu/view_uniforms.h"
#include "methods/wavelet_fog/leveled_fog.h"
#include "scene/base/error.h"
#include "scene/math/gauss_legendre.h"

namespace airlight::gpu::wavelet_fog {
namespace {

using airlight::wavelet_fog::Options;
using scene::IndexRange;
using Variant = Options::Variant;

constexpr double most_iterations = 40000;  // of a ray in one dispatch where loops are ended after 65535

const scene::Fogmap& fogmap(const scene::Medium& medium) { return *std::get<scene::FogmapPointer>(medium.field); }

Profile kind_of(const scene::HeightProfile& profile) {
  return scene::match(
      profile, [](const scene::SameAtAllHeights&) { return Profile::none; },
      [](const scene::Layers&) { return Profile::layers; },
      [](const scene::ExponentialFall&) { return Profile::exponential; });
}

// Heights and factors, alternating.
std::vector<double> knots_of(const scene::HeightProfile& profile) {
  std::vector<double> knots;
  for (const double height : height_breaks(profile)) {
    knots.push_back(height);
    knots.push_back(factor_at(profile, height));
  }
  return knots;
}

void write_region(FogData& d, const scene::Region& region) {
  const auto set = [&](RegionKind kind, const Vec3& lo, const Vec3& hi) {
    d.region = int(kind);
    for (int a = 0; a < 3; ++a) d.region_lo[a] = lo[a], d.region_hi[a] = hi[a];
  };
  scene::match(
      region, [&](const scene::Unbounded&) { set(RegionKind::unbounded, Vec3::Zero(), Vec3::Zero()); },
      [&](const Box& box) { set(RegionKind::box, box.lo, box.hi); },
      [&](const scene::Sphere& sphere) { set(RegionKind::sphere, sphere.center, Vec3::Constant(sphere.radius)); },
      [&](const scene::Slab& slab) {
        set(RegionKind::slab, slab.normal, {slab.lo, slab.hi, 0});
      });
}

float finite(double value) { return float(std::min(value, double(far_away))); }

}  // namespace

void add_rule(Definitions& definitions, const std::string& prefix, int points) {
  scene::GaussLegendre rule = scene::gauss_legendre(points);
  for (int k = 0; k < points; ++k) {
    rule.node[k] = 0.5 + 0.5 * rule.node[k];
    rule.weight[k] *= 0.5;
  }
  definitions[prefix + "POINTS"] = std::to_string(points);
  definitions[prefix + "NODES"] = listed(rule.node);
  definitions[prefix + "WEIGHTS"] = listed(rule.weight);
}

std::vector<char> bytes_of(const std::vector<FogData>& media, const std::vector<double>& knots) {
  std::vector<char> bytes;
  const auto add = [&](const auto& list) {
    const char* from = reinterpret_cast<const char*>(list.data());
    bytes.insert(bytes.end(), from, from + sizeof(list[0]) * list.size());
  };
  add(media);
  add(knots);
  return bytes;
}

FogOnDevice::FogOnDevice(Context& context, const scene::Medium& medium, const Options& options, int number,
                         bool light_rays)
    : context_(context), options_(options), medium_(medium), number_(number), grids_(context) {
  add_grids();
  grids_.allocate();
  const IndexRange cells = grids_.range(data_.cells);
  const bool blocks = data_.cells > 0;
  emptiness_ = std::make_unique<Buffer>(
      context_, "empty cells", blocks ? 4 * (std::size_t(cells.size[0] + 7) / 8) * std::size_t(cells.size[1]) : 0);
  write(medium);
  grids_.upload(fogmap(medium).map.coefficients());
  Definitions all = definitions();
  if (options_.table > 0) add_table(all);
  camera_rays_ = &program(context_, "columns", pixel_tile, pixel_tile, all);
  if (options_.variant == Variant::polar) {
    Definitions steps = all;
    steps["SKIPS"] = "0";
    table_steps_ = &program(context_, "polar_steps", pixel_tile, pixel_tile, steps);
    table_sums_ = &program(context_, "polar_sums", 64);
  }
  if (!light_rays) return;
  all["LIGHT_RAYS"] = "1";
  if (options_.variant == Variant::polar) all["VARIANT"] = std::to_string(int(Variant::skip));
  light_rays_ = &program(context_, "columns", pixel_tile, pixel_tile, all);
}

Definitions FogOnDevice::definitions() const {
  const int n = fogmap(medium_).map.degree();
  const bool fades = options_.fade > 0;
  const bool skips = options_.variant == Variant::skip || options_.variant == Variant::polar;
  const Profile profile = fades ? Profile::exponential : kind_of(fogmap(medium_).profile);
  Definitions definitions{{"DEGREE", std::to_string(n)},
                          {"PROFILE", std::to_string(int(profile))},
                          {"VARIANT", std::to_string(int(options_.variant))},
                          {"WAVELET_COEFFICIENTS", "0"},
                          {"SKIPS", skips ? "1" : "0"},
                          {"FADES", fades ? "1" : "0"},
                          {"FALLS", profile == Profile::exponential ? "1" : "0"},
                          {"LIGHT_RAYS", "0"}};
  if (options_.variant == Variant::pre) add_wavelets(definitions);
  add_rule(definitions, "", n + 1);
  if (profile == Profile::exponential) add_rule(definitions, "FALL_", n + 3);  // enough for single precision
  return definitions;
}

// The map, coarser grids, details; then what is known of blocks. airlight::wavelet_fog::make_levels.
void FogOnDevice::add_grids() {
  const scene::SplineMap& map = fogmap(medium_).map;
  const int n = map.degree(), levels = airlight::wavelet_fog::uses_levels(options_.variant) ? options_.levels : 0;
  const bool clamped = options_.coarse == airlight::wavelet_fog::Coarse::clamped,
             details = options_.variant == Variant::paper;
  data_.levels = levels;
  std::vector<int> pure{grids_.add(map.range(), n)};  // before clamping
  if (levels > 0) {
    const Taps low = options_.coarse == airlight::wavelet_fog::Coarse::restricted
                         ? airlight::wavelet_fog::restriction(n)
                         : airlight::wavelet_fog::family(airlight::wavelet_fog::family_of_degree(n)).p_tilde;
    std::vector<IndexRange> ranges{map.range()};
    for (int l = 0; l < levels; ++l) ranges.push_back(coarse_range(ranges.back(), low, low));
    for (int l = 1; l <= levels; ++l) pure.push_back(grids_.add(ranges[l], n));
    for (int l = 1; l <= levels && clamped; ++l) pure[l] = grids_.add(ranges[l]);
    for (int l = 1; l <= levels; ++l) {
      grids_.reuse_scratch();
      grids_.down(pure[l - 1], low, low, pure[l]);
      if (clamped) grids_.clamp(pure[l], l);
    }
    const Taps p = airlight::wavelet_fog::two_scale(n);
    for (int l = 0; l < levels && details; ++l) {
      const int grid =
          grids_.add(airlight::wavelet_fog::united(ranges[l], airlight::wavelet_fog::fine_range(ranges[l + 1], p)), n);
      if (l == 0) data_.details = grid;
    }
    for (int l = 0; l < levels && details; ++l) {
      grids_.reuse_scratch();
      grids_.up(pure[l + 1], p, p, data_.details + l, pure[l], -1);
    }
  }
  const Variant v = options_.variant;
  if (v == Variant::pre) add_bands(pure);
  if (v == Variant::skip || v == Variant::polar || v == Variant::bound || options_.sun) add_blocks(v == Variant::bound);
}

// airlight::wavelet_fog::Blocks: the greatest of each block for every level, then, with `errors`, how far coarser grids are off.
void FogOnDevice::add_blocks(bool errors) {
  const scene::SplineMap& map = fogmap(medium_).map;
  const int n = map.degree(), most = errors ? options_.levels : airlight::wavelet_fog::empty_blocks;
  std::vector<IndexRange> blocks;
  for (int l = 0; l <= most; ++l) {
    IndexRange of;
    for (int a = 0; a < 2; ++a) {
      of.lo[a] = map.range().lo[a] >> l;
      of.size[a] = ((map.range().lo[a] + map.range().size[a] + n - 1) >> l) - of.lo[a] + 1;
    }
    blocks.push_back(of);
  }
  data_.cells = add_levels(blocks, 0);
  const int cells = data_.cells;
  find_greatest(0, -1, cells);
  for (int l = 1; l <= most; ++l) gather_greatest(cells + l - 1, cells + l);
  IndexRange words = blocks[0];
  words.size[0] = (words.size[0] + 7) / 8;
  grids_.pass(
      blocks_program("2"),
      [=](Program& p) {
        p.set("from", cells);
        p.set("levels", most);
      },
      words);
  if (errors) add_errors(blocks);
}

// A grid for each level from `first` on; the first of them.
int FogOnDevice::add_levels(const std::vector<IndexRange>& blocks, std::size_t first) {
  int begin = 0;
  for (std::size_t l = first; l < blocks.size(); ++l) {
    const int grid = grids_.add(blocks[l]);
    if (l == first) begin = grid;
  }
  return begin;
}

Program& FogOnDevice::blocks_program(const char* stage) {
  return program(context_, "blocks", pixel_tile, pixel_tile,
                 {{"DEGREE", std::to_string(fogmap(medium_).map.degree())}, {"STAGE", stage}});
}

// The greatest in every cell of a grid; with `less` not below 0 the greatest by which that grid is off.
void FogOnDevice::find_greatest(int from, int less, int to) {
  grids_.pass(
      blocks_program("0"),
      [=](Program& p) {
        p.set("from", from);
        p.set("less", less);
        p.set("to", to);
      },
      grids_.range(to));
}

// The greatest in every block of a level, from the level below.
void FogOnDevice::gather_greatest(int from, int to) {
  grids_.pass(
      blocks_program("1"),
      [=](Program& p) {
        p.set("from", from);
        p.set("to", to);
      },
      grids_.range(to));
}

// How far each coarser grid is off, at most, in each of its blocks.
void FogOnDevice::add_errors(const std::vector<IndexRange>& blocks) {
  const Taps p = airlight::wavelet_fog::two_scale(fogmap(medium_).map.degree());
  const int most = int(blocks.size()) - 1;
  data_.errors = add_levels(blocks, 1);
  for (int l = 1; l <= most; ++l) {
    grids_.reuse_scratch();
    int fine = l;
    for (int i = l; i > 0; --i) {
      const int finer = grids_.scratch(airlight::wavelet_fog::fine_range(grids_.range(fine), p));
      grids_.up(fine, p, p, finer);
      fine = finer;
    }
    int block = grids_.scratch(blocks[0]);
    find_greatest(0, fine, block);
    for (int i = 1; i <= l; ++i) {
      const int larger = i == l ? data_.errors + l - 1 : grids_.scratch(blocks[i]);
      gather_greatest(block, larger);
      block = larger;
    }
  }
}

void FogOnDevice::write(const scene::Medium& medium) {
  const scene::Fogmap& fog = fogmap(medium);
  const bool fades = options_.fade > 0;
  const scene::HeightProfile faded = scene::ExponentialFall{0, options_.fade};
  const scene::HeightProfile& profile = fades ? faded : fog.profile;
  data_.map_x0 = fog.x0;
  data_.map_z0 = fog.z0;
  data_.cos_over_cell = fog.cos_turn / fog.cell;
  data_.sin_over_cell = fog.sin_turn / fog.cell;
  write_region(data_, medium.region);
  const Interval heights = occupied_heights(fog.profile);
  data_.lowest = std::max(heights.lo, -double(far_away));
  data_.highest = std::min(heights.hi, double(far_away));
  data_.mu = options_.mu;
  for (int c = 0; c < 3; ++c) data_.sigma_t[c] = float(medium.sigma_t[c]);
  const Variant v = options_.variant;
  const bool ends = v == Variant::skip || v == Variant::bound || v == Variant::polar;
  data_.enough = ends ? finite(airlight::wavelet_fog::enough_column(medium, options_)) : far_away;
  const double thickest = medium.sigma_t.maxCoeff();
  data_.allowed = thickest > 0 ? finite(options_.tolerance / thickest) : 0;
  const auto* fall = std::get_if<scene::ExponentialFall>(&profile);
  data_.scale_height = fall ? float(fall->scale_height) : 1;
  knots_ = knots_of(profile);
  data_.knots = int(knots_.size() / 2);
  data_.degree = fog.map.degree();
  data_.profile = int(fades ? Profile::exponential : kind_of(fog.profile));
  const std::vector<char> bytes = bytes_of({data_}, knots_);
  if (!fog_ || fog_->bytes() != bytes.size()) fog_ = std::make_unique<Buffer>(context_, "fog", bytes.size());
  fog_->upload(bytes);
  // Cells that a ray may cross, in the levels that it reads, an iteration each and one for every node; a scale height more takes
  // a piece more of a cell.
  const IndexRange& range = fog.map.range();
  const int n = fog.map.degree();
  const double cells = range.size[0] + range.size[1] + 4 * n + 8, nodes = fall ? n + 4 : n + 2;
  const bool details = v == Variant::paper || v == Variant::pre;
  const double levels = details ? 2.5 : v == Variant::bound ? 2 + data_.levels : 1;
  const double of_wavelets = v == Variant::pre ? 8 * 8 : 0;  // a window of coefficients, 6 x 6 for CDF 3.3
  const double iterations = cells * (1 + nodes + of_wavelets) * levels + 64 * data_.knots * nodes;
  parts_ = context_.software() ? std::max(1, int(std::ceil(iterations / most_iterations))) : 1;
}

bool FogOnDevice::fits(const scene::Medium& medium) const {
  const auto* pointer = std::get_if<scene::FogmapPointer>(&medium.field);
  if (!pointer) return false;
  const scene::Fogmap &before = fogmap(medium_), &now = **pointer;
  const auto same = [](const IndexRange& a, const IndexRange& b) {
    return std::equal(a.lo, a.lo + 2, b.lo) && std::equal(a.size, a.size + 2, b.size);
  };
  return now.map.degree() == before.map.degree() && same(now.map.range(), before.map.range()) &&
         kind_of(now.profile) == kind_of(before.profile);
}

void FogOnDevice::become(const scene::Medium& medium) {
  const scene::Fogmap &before = fogmap(medium_), &now = fogmap(medium);
  if (&now != &before) {
    const std::vector<double> coefficients = now.map.coefficients();
    if (coefficients != before.map.coefficients()) {
      grids_.upload(coefficients);
      stale_ = true;
    }
  }
  medium_ = medium;
  write(medium_);
}

void FogOnDevice::refresh() {
  emptiness_->bind(at::emptiness);
  grids_.run();
  stale_ = false;
}

void FogOnDevice::bind() const {
  fog_->bind(at::fog);
  grids_.bind();
  emptiness_->bind(at::emptiness);
}

void FogOnDevice::fill_table(const scene::View& view, FrameBuffers& buffers, const Buffer& counters, bool counts) {
  const scene::Fogmap& fog = fogmap(medium_);
  const scene::MapLine eye = line_over(fog, {view.camera.position, Vec3::UnitX()});
  const airlight::wavelet_fog::PolarTable::Fan fan = airlight::wavelet_fog::fan_of(fog, view, options_.angles);
  const int angles = fan.span == 2 * pi ? 2 * options_.angles : options_.angles;
  table_.angles = angles + 3;
  const airlight::wavelet_fog::Spoke spoke =
      airlight::wavelet_fog::spoke_of(fog.map, eye.u, eye.v, table_.angles, options_.radial_step);
  table_.first = spoke.first;
  table_.steps = spoke.steps;
  table_.span = fan.span;
  table_.spacing = fan.span / angles;
  table_.middle = fan.first + 0.5 * fan.span;
  if (context_.software() && table_.steps > most_iterations)
    throw Unavailable(fmt::format(
        "gpu: {} steps of radial_step = {} from the map's rim, or the eye, to its far corner, {} takes {} at most",
        table_.steps, options_.radial_step, context_.renderer(), most_iterations));
  // Rooms grow by powers of two, so that an eye that moves allocates next to nothing.
  const std::size_t bytes = 24 * std::size_t(table_.angles) * std::size_t(table_.steps + 1);
  table_buffer_ = &buffers.get(fmt::format("polar table {}", number_),
                               std::min(std::bit_ceil(bytes), std::max(bytes, context_.limits().storage_block)));
  bind();
  table_buffer_->bind(at::table);
  counters.bind(at::counters);
  Program& p = *table_steps_;
  p.set_double("eye_u", eye.u);
  p.set_double("eye_v", eye.v);
  p.set("table_middle_u", std::cos(table_.middle));
  p.set("table_middle_v", std::sin(table_.middle));
  p.set("table_spacing", table_.spacing);
  p.set("table_first", -table_.spacing - 0.5 * table_.span);
  p.set_double("step_", options_.radial_step);
  p.set("table_first_step", table_.first);
  p.set("table_angles", table_.angles);
  p.set("table_steps", table_.steps);
  p.set("counts", counts);
  p.dispatch(table_.steps + 1, table_.angles);
  table_sums_->set("table_angles", table_.angles);
  table_sums_->set("table_steps", table_.steps);
  table_sums_->dispatch(table_.angles);
}

void FogOnDevice::add_depths(const scene::View& view, const Buffer* distances, const Buffer& depths,
                             const Buffer& counters, bool first, bool counts) {
  Program& p = *camera_rays_;
  bind();
  if (path_table_) path_table_->bind(at::table);
  (distances ? *distances : depths).bind(at::distances);
  depths.bind(at::depths);
  counters.bind(at::counters);
  set_view(p, view);
  p.set("has_distances", distances != nullptr);
  p.set("first", first);
  p.set("counts", counts);
  p.set("loop_count", 3);
  if (options_.variant == Variant::polar) {
    table_buffer_->bind(at::table);
    p.set("table_angles", table_.angles);
    p.set("table_steps", table_.steps);
    p.set("table_first_step", table_.first);
    p.set("table_middle_u", std::cos(table_.middle));
    p.set("table_middle_v", std::sin(table_.middle));
    p.set("table_span", table_.span);
    p.set("table_spacing", table_.spacing);
    p.set("table_step", options_.radial_step);
  }
  p.set("parts", parts_);
  for (int part = 0; part < parts_; ++part) {
    p.set("part", part);
    p.dispatch(view.width, view.height);
  }
}

void FogOnDevice::dim(const scene::View& view, const Buffer& lit) {
  Program& p = *light_rays_;
  bind();
  if (path_table_) path_table_->bind(at::table);
  lit.bind(at::lit);
  set_view(p, view);
  p.set("parts", parts_);
  for (int part = 0; part < parts_; ++part) {
    p.set("part", part);
    p.dispatch(view.width, view.height);
  }
}

}  // namespace airlight::gpu::wavelet_fog
