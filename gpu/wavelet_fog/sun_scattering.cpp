#include "gpu/wavelet_fog/sun_scattering.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "gpu/view_uniforms.h"
#include "methods/wavelet_fog/sun_scattering.h"
#include "scene/light/scattered_lights.h"
#include "scene/media/fogmap.h"

namespace airlight::gpu::wavelet_fog {
namespace {

constexpr int pack_group = 64;
constexpr int edges_kept = 8;                   // of a ray, between two rounds
constexpr std::size_t strip_bytes = 64u << 20;  // of rays at once
// Iterations of loops in a round, about: eight rays share llvmpipe's limit. Devices without one stop for edges alone.
constexpr int software_light = 3000, software_shadows = 3000, hardware = 1 << 30;

std::string at_index(const char* name, std::size_t i) { return fmt::format("{}[{}]", name, i); }

// Uniforms of medium i that maps and march both read.
void set_rows(Program& p, std::size_t i, const airlight::wavelet_fog::SunRows& rows, int first) {
  p.set(at_index("sun_columns", i), rows.columns);
  p.set(at_index("sun_rows", i), rows.rows);
  p.set(at_index("sun_first", i), first);
  p.set_double(at_index("sun_along_u", i), rows.along[0]);
  p.set_double(at_index("sun_along_v", i), rows.along[1]);
  p.set_double(at_index("sun_lo_p", i), rows.lo[0]);
  p.set_double(at_index("sun_lo_q", i), rows.lo[1]);
  p.set_double(at_index("sun_climb", i), rows.k);
}

void set_sun(Program& p, const Vec3& to_sun) {
  p.set_double("sun_x", to_sun[0]);
  p.set_double("sun_y", to_sun[1]);
  p.set_double("sun_z", to_sun[2]);
}

const scene::Fogmap& fogmap(const FogOnDevice& fog) { return *std::get<scene::FogmapPointer>(fog.medium().field); }

}  // namespace

std::vector<const scene::DirectionalLight*> suns_of(const scene::Scene& scene) {
  std::vector<const scene::DirectionalLight*> suns;
  for (const scene::Light& light : scene.lights)
    if (const auto* sun = std::get_if<scene::DirectionalLight>(&light); sun && scatter(scene.media, light))
      suns.push_back(sun);
  return suns;
}

SunOnDevice::SunOnDevice(Context& context, const scene::Scene& scene, const Fogs& fogs, const FirstHits* first_hits,
                         const airlight::wavelet_fog::Options& options)
    : context_(context), fogs_(fogs), surfaces_(scene.geometry ? first_hits : nullptr), options_(options) {
  compile();
  if (fogs.size() == 1) return;
  std::vector<GridData> grids;
  std::size_t values = 0, words = 0;
  for (const auto& fog : fogs) {
    GridData map = fog->grid(0);
    const int rim = fog->data().degree;
    first_value_.push_back(int(values));
    first_word_.push_back(int(words));
    values += std::size_t(map.stride) * (std::size_t(map.size[1]) + 2 * rim);
    words += fog->words();
    map.offset += first_value_.back();
    grids.push_back(map);
    grids.push_back(fog->grid(fog->data().cells));
  }
  grids_ = std::make_unique<Buffer>(context, "grids of all maps", grids);
  values_ = std::make_unique<Buffer>(context, "values of all maps", 4 * values);
  emptiness_ = std::make_unique<Buffer>(context, "empty cells of all maps", 4 * words);
  write();
}

void SunOnDevice::compile() {
  Definitions definitions = fogs_.front()->definitions();
  definitions["VARIANT"] = "-1";
  int degree = 0;
  for (const auto& fog : fogs_) {
    degree = std::max(degree, fog->data().degree);
    Definitions steps = fog->definitions();
    steps["VARIANT"] = "-1";
    steps["SKIPS"] = "0";
    steps_.push_back(&program(context_, "sun_steps", pixel_tile, pixel_tile, steps));
  }
  sums_ = &program(context_, "sun_sums", 64);
  definitions["SKIPS"] = "1";
  definitions["MEDIA"] = std::to_string(fogs_.size());
  definitions["EDGES"] = std::to_string(surfaces_ ? edges_kept : 1);
  if (fogs_.size() > 1) {  // of any degree and profile
    pack_ = &program(context_, "pack", pack_group);
    definitions["DEGREE"] = "fog.degree";
    definitions["PROFILE"] = "fog.profile";
    definitions["FALLS"] = "1";
    add_rule(definitions, "", degree + 1);
    add_rule(definitions, "FALL_", degree + 3);
  }
  start_ = &program(context_, "sun_start", pixel_tile, pixel_tile, definitions);
  points_ = std::max(options_.sun_points, degree + 1);
  if (surfaces_) shadows_ = &program(context_, "sun_shadows", pixel_tile, pixel_tile, definitions);
  const auto rule = airlight::wavelet_fog::SunScattering::rule_of(points_);
  definitions["SUN_POINTS"] = std::to_string(points_);
  definitions["SUN_NODES"] = listed(rule.node);
  definitions["SUN_WEIGHTS"] = listed(rule.weight);
  definitions["SUN_UPTO"] = listed(rule.upto);
  definitions["LEAST_WAY"] = fmt::format("{:e}LF", airlight::wavelet_fog::SunMap::least_way);
  light_ = &program(context_, "sun", pixel_tile, pixel_tile, definitions);
}

void SunOnDevice::write() {
  if (fogs_.size() == 1) return;
  std::vector<FogData> media;
  std::vector<double> knots;
  for (std::size_t i = 0; i < fogs_.size(); ++i) {
    FogData data = fogs_[i]->data();
    data.map = 2 * int(i);
    data.cells = 2 * int(i) + 1;
    data.first_knot = int(knots.size() / 2);
    data.first_word = first_word_[i];
    knots.insert(knots.end(), fogs_[i]->knots().begin(), fogs_[i]->knots().end());
    media.push_back(data);
  }
  const std::vector<char> bytes = bytes_of(media, knots);
  if (!media_ || media_->bytes() != bytes.size()) media_ = std::make_unique<Buffer>(context_, "media", bytes.size());
  media_->upload(bytes);
}

void SunOnDevice::refresh() {
  for (std::size_t i = 0; i < fogs_.size() && pack_; ++i) {
    fogs_[i]->bind();
    values_->bind(at::packed_values);
    emptiness_->bind(at::packed_emptiness);
    const GridData& map = fogs_[i]->grid(0);
    const int values = map.stride * (map.size[1] + 2 * fogs_[i]->data().degree), words = int(fogs_[i]->words());
    pack_->set("value_count", values);
    pack_->set("word_count", words);
    pack_->set("first_value", first_value_[i]);
    pack_->set("first_word", first_word_[i]);
    pack_->dispatch(std::max(values, words));
  }
}

void SunOnDevice::bind_media() const {
  if (fogs_.size() == 1) {
    fogs_.front()->bind();
    return;
  }
  media_->bind(at::fog);
  grids_->bind(at::grids);
  values_->bind(at::values);
  emptiness_->bind(at::emptiness);
}

void SunOnDevice::fill_maps(const Vec3& to_sun, FrameBuffers& buffers, const Buffer& unused) {
  std::vector<airlight::wavelet_fog::SunRows> rows;
  std::vector<int> first;
  std::size_t entries = 0;
  for (const auto& fog : fogs_) {
    rows.push_back(airlight::wavelet_fog::rows_towards(fogmap(*fog), to_sun, options_.sun_step));
    first.push_back(int(entries));
    if (!rows.back().upright) entries += std::size_t(rows.back().columns) * std::size_t(rows.back().rows);
  }
  // Rooms grow by powers of two, so that a sun that moves allocates next to nothing.
  const std::size_t bytes = 16 * entries;
  const Buffer& map =
      entries == 0
          ? unused
          : buffers.get("sun map", std::min(std::bit_ceil(bytes), std::max(bytes, context_.limits().storage_block)));
  light_->set_double("sun_step", options_.sun_step);
  for (std::size_t i = 0; i < fogs_.size(); ++i) {
    set_rows(*light_, i, rows[i], first[i]);
    if (rows[i].upright) continue;
    fogs_[i]->bind();
    map.bind(at::table);
    Program& steps = *steps_[i];
    set_rows(steps, 0, rows[i], first[i]);
    steps.set_double("sun_step", options_.sun_step);
    steps.dispatch(rows[i].columns, rows[i].rows);
    sums_->set("sun_columns", rows[i].columns);
    sums_->set("sun_rows", rows[i].rows);
    sums_->set("sun_first", first[i]);
    sums_->set("sun_step", options_.sun_step);
    sums_->set("fallen", std::exp(-rows[i].k * options_.sun_step));
    sums_->dispatch(rows[i].rows);
  }
  map.bind(at::table);
}

// Sets everything that does not change from sun to sun.
void SunOnDevice::begin(const scene::View& view, const Buffer* distances, bool counts) {
  for (Program* p : {start_, shadows_, light_}) {
    if (!p) continue;
    set_view(*p, view);
    if (fogs_.size() > 1) p->set("media", int(fogs_.size()));
  }
  start_->set("has_distances", distances != nullptr);
  start_->set("has_surfaces", surfaces_ != nullptr);
  const bool software = context_.software();
  if (surfaces_) {
    shadows_->set("triangle_count", surfaces_->surfaces().triangles());
    shadows_->set("shadow_steps", options_.shadow_steps);
    shadows_->set("per_cell", points_);
    shadows_->set("budget", software ? software_shadows : hardware);
    shadows_->set("loop_count", 3);
  }
  light_->set("budget", software ? software_light : hardware);
  light_->set("counts", counts);
  light_->set("loop_count", 3);
  light_->set("least", float(std::max(options_.termination, std::exp(-40.0))));  // opaque in sun.comp
  double climb = 0;
  for (std::size_t i = 0; i < fogs_.size(); ++i) {
    const scene::Medium& medium = fogs_[i]->medium();
    light_->set(at_index("phase_kind", i), int(medium.phase.index()));
    const auto* hg = std::get_if<scene::HenyeyGreenstein>(&medium.phase);
    light_->set(at_index("phase_g", i), hg ? hg->g : 0.0);
    if (const auto* fall = std::get_if<scene::ExponentialFall>(&fogmap(*fogs_[i]).profile))
      climb = std::max(climb, 1 / fall->scale_height);
  }
  light_->set("climb", climb);
}

// All rays of a strip, until none is left or for as many rounds as there should be.
void SunOnDevice::march(const scene::View& view, int first_row, int rows, const Buffer& counters) {
  for (Program* p : {start_, shadows_, light_}) {
    if (!p) continue;
    p->set("first_row", first_row);
    p->set("strip_rows", rows);
  }
  start_->dispatch(view.width, rows);
  const int rounds = 2 * rounds_;
  for (int round = 1; looks_ || round <= rounds; ++round) {
    if (shadows_) shadows_->dispatch(view.width, rows);
    light_->set("mark", looks_ || round == rounds ? ++mark_ : 0);
    light_->dispatch(view.width, rows);
    if (!looks_ || counters.download<int>()[9] == mark_) continue;
    most_rounds_ = std::max(most_rounds_, round);
    return;
  }
}

void SunOnDevice::render(const scene::Scene& scene, const scene::View& view, FrameBuffers& buffers,
                         const Buffer* distances, const Buffer& airlight, const Buffer& counters, bool counts) {
  begin(view, distances, counts);
  const std::size_t ray = sizeof(SunState) + 8 * std::size_t(surfaces_ ? edges_kept : 1);
  const int rows = std::clamp(int(strip_bytes / (ray * std::size_t(view.width))), 1, view.height);
  const Buffer& rays = buffers.get("rays under a sun", ray * std::size_t(view.width) * std::size_t(rows));
  most_rounds_ = 0;
  bool first = true;
  for (const scene::DirectionalLight* sun : suns_of(scene)) {
    fill_maps(sun->to_light, buffers, airlight);
    bind_media();
    (distances ? *distances : airlight).bind(at::distances);
    airlight.bind(at::airlight);
    counters.bind(at::counters);
    rays.bind(at::sun_rays);
    if (surfaces_) {
      surfaces_->surfaces().bind();
      surfaces_->tree().bind(*shadows_);
      set_sun(*shadows_, sun->to_light);
    }
    set_sun(*light_, sun->to_light);
    for (std::size_t i = 0; i < fogs_.size(); ++i) {
      const scene::Medium& medium = fogs_[i]->medium();
      light_->set(at_index("scattered", i), Rgb(medium.albedo * medium.sigma_t * sun->irradiance));
    }
    light_->set("first", first);
    first = false;
    for (int row = 0; row < view.height; row += rows) march(view, row, std::min(rows, view.height - row), counters);
  }
  if (looks_) rounds_ = std::max(rounds_, most_rounds_);
  looked_ = std::exchange(looks_, false);
}

bool SunOnDevice::left_rays(const std::vector<unsigned>& counters) { return !looked_ && (looks_ = counters[9] != 0); }

}  // namespace airlight::gpu::wavelet_fog
