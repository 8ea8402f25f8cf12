#include "gpu/compensated_ray_marching/lit_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "gpu/view_uniforms.h"
#include "methods/compensated_ray_marching/ordinate_directions.h"
#include "methods/compensated_ray_marching/zonal_harmonics.h"
#include "scene/base/error.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

using airlight::compensated_ray_marching::IncomingLight;
using airlight::compensated_ray_marching::LitGrid;
using airlight::compensated_ray_marching::Options;
using airlight::compensated_ray_marching::Ordinate;
using airlight::compensated_ray_marching::P1Options;

constexpr int line = 64, tile = 8;  // invocations of a work group: along a list, and both ways in a plane
constexpr int groups_of_sums = 64, sum_lanes = 128;
constexpr double least_tolerance = 3e-6;  // that single precision can keep
constexpr int first_iterations = 8;       // told to the device before any is looked at

struct WayData {
  int axis, forward;
  float step, down, along, unused[3] = {0, 0, 0};
};
struct StateData {
  double error, least, gram[kept * kept], shares[kept];
  int done, iterations;
};

// Axis and steps of a direction, with the conventions of DiscreteOrdinates::sweep.
WayData way_of(const Ordinate& d, double edge) {
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(d.direction[a]) > std::abs(d.direction[axis])) axis = a;
  const double speed = std::abs(d.direction[axis]);
  const int rows = axis == 2 ? 1 : 2, along = axis == 0 ? 1 : 0;
  return {axis, d.direction[axis] > 0, float(edge / speed), float(-d.direction[rows] / speed),
          float(-d.direction[along] / speed)};
}

// Rows one after the other, each with zeros up to a multiple of `unit`.
std::vector<float> floats(const std::vector<std::vector<double>>& rows, std::size_t unit) {
  std::vector<float> values;
  for (const auto& row : rows) {
    values.insert(values.end(), row.begin(), row.end());
    values.resize((values.size() + unit - 1) / unit * unit);
  }
  return values;
}

}  // namespace

LitGridOnDevice::LitGridOnDevice(Context& context, const scene::Medium& medium, const Options& options,
                                 const LitGrid& grid, SmokeColumns& columns)
    : context_(context),
      medium_(medium),
      options_(options),
      multiple_(grid.single_only().empty()),
      grid_(grid.grid()),
      columns_(columns),
      cells_(int(grid.grid().cells.nodes())),
      moments_(airlight::compensated_ray_marching::phase_moments(medium.phase, options.order)),
      band_moments_(airlight::compensated_ray_marching::phase_moments(medium.phase, options.grid.levels)) {
  for (std::size_t a = 0; a < 3; ++a) cells_along_[Eigen::Index(a)] = grid.grid().cells.size[a];
  densities_ = std::make_unique<Buffer>(context_, "densities",
                                        std::vector<float>(grid.densities().data(), grid.densities().data() + cells_));
  radiance_ = std::make_unique<Buffer>(context_, "source radiance", 16 * std::size_t(cells_));
  logarithms_ = std::make_unique<Buffer>(context_, "logarithms of it", 16 * std::size_t(cells_));
  greatest_ = std::make_unique<Buffer>(context_, "greatest", 4);
  towards_program_ = program_of("towards", line);
  logarithms_program_ = program_of("logarithms", line);
  if (!grid.beyond().nodes.empty()) upload_edges(grid.beyond());
  if (!multiple_) return;
  single_program_ = program_of("single", line);
  if (by_diffusion()) return;
  upload_ordinates();
  upload_cells(grid);
  emit_program_ = program_of("emit", line);
  sweep_program_ = program_of("sweep", tile, tile);
  collect_program_ = program_of("collect", line);
  products_program_ = program_of("products", sum_lanes);
  decide_program_ = program_of("decide", 1);
  combine_program_ = program_of("combine", line);
  parts_ = std::make_unique<Buffer>(context_, "parts of sums", 8 * std::size_t(groups_of_sums * (3 + 2 * kept)));
  state_ = std::make_unique<Buffer>(context_, "state", sizeof(StateData));
}

bool LitGridOnDevice::by_diffusion() const { return options_.grid.multiple == Options::Grid::Multiple::p1; }

Program* LitGridOnDevice::program_of(const char* file, int x, int y) {
  const int bands = options_.order * options_.order;
  return &program(context_, file, x, y,
                  {{"BANDS", std::to_string(bands)},
                   {"LEVELS", std::to_string(options_.grid.levels)},
                   {"ROWS", std::to_string((bands + 3) / 4)},
                   {"SH_ORDER", std::to_string(options_.order)}});
}

void LitGridOnDevice::upload_edges(const airlight::compensated_ray_marching::BeyondEdges& beyond) {
  edges_program_ = program_of("beyond_edges", line);
  std::vector<std::int32_t> edges;
  for (std::size_t n = 0; n < beyond.nodes.size(); ++n) {
    edges.push_back(std::int32_t(beyond.nodes[n]));
    edges.push_back(std::int32_t(beyond.first[n + 1]));
  }
  edge_count_ = int(beyond.nodes.size());
  edges_ = std::make_unique<Buffer>(context_, "beyond edges", edges);
  edge_nodes_ = std::make_unique<Buffer>(context_, "within edges",
                                         std::vector<std::int32_t>(beyond.from.begin(), beyond.from.end()));
  edge_weights_ = std::make_unique<Buffer>(context_, "weights beyond edges",
                                           std::vector<float>(beyond.weights.begin(), beyond.weights.end()));
}

// Uploads each cell's balance of the ordinates, and a bit for each ordinate that an object blocks.
void LitGridOnDevice::upload_cells(const LitGrid& grid) {
  std::vector<float> balance(3 * std::size_t(cells_), 1.0F);
  for (std::size_t c = 0; c < 3; ++c)
    for (Eigen::Index i = 0; i < grid.balance()[c].size(); ++i)
      balance[c * std::size_t(cells_) + std::size_t(i)] = float(grid.balance()[c][i]);
  balance_ = std::make_unique<Buffer>(context_, "balance", balance);
  std::vector<std::uint32_t> open;
  for (std::size_t d = 0; d < grid.open().size(); ++d) {
    if (d % 32 == 0) open.resize(open.size() + std::size_t(cells_), 0);
    for (std::size_t i = 0; i < std::size_t(cells_); ++i)
      if (grid.open()[d][i] > 0) open[d / 32 * std::size_t(cells_) + i] |= 1u << (d % 32);
  }
  if (!open.empty()) open_ = std::make_unique<Buffer>(context_, "open ways", open);
}

void LitGridOnDevice::upload_ordinates() {
  const auto ordinates = airlight::compensated_ray_marching::ordinate_directions(options_.grid.ordinate_levels,
                                                                                 options_.grid.azimuths, true);
  ordinates_ = int(ordinates.size());
  std::vector<WayData> ways;
  std::vector<std::vector<double>> harmonics, weighted;
  for (const Ordinate& d : ordinates) {
    ways.push_back(way_of(d, grid_.cells.cell[0]));
    harmonics.push_back(scene::evaluate_sh(options_.order, d.direction));
    weighted.push_back(harmonics.back());
    for (double& value : weighted.back()) value *= d.weight;
  }
  ways_ = std::make_unique<Buffer>(context_, "ways", ways);
  ordinate_harmonics_ = std::make_unique<Buffer>(context_, "harmonics of ordinates", floats(harmonics, 1));
  weighted_ = std::make_unique<Buffer>(context_, "weighted harmonics", floats(weighted, 4));
}

Buffer& LitGridOnDevice::buffer(std::unique_ptr<Buffer>& of, const char* name, std::size_t bytes) {
  if (!of || of->bytes() != bytes) of = std::make_unique<Buffer>(context_, name, bytes);
  return *of;
}

// Lights of the buffers: channels by extinction and albedo; of light without colour one stands for all of a group.
void LitGridOnDevice::arrange(bool grey) {
  groups_.clear();
  const Rgb &sigma_t = medium_.sigma_t, &albedo = medium_.albedo;
  for (int c = 0; c < 3; ++c) {
    const auto alike = [&](const Group& g) {
      return sigma_t[g.channels[0]] == sigma_t[c] && albedo[g.channels[0]] == albedo[c];
    };
    const auto known = std::find_if(groups_.begin(), groups_.end(), alike);
    if (known != groups_.end())
      known->channels.push_back(c);
    else
      groups_.emplace_back().channels = {c};
  }
  lights_ = 0;
  std::size_t most = 0;
  for (Group& g : groups_) {
    g.first = lights_;
    g.lights = grey ? 1 : int(g.channels.size());
    lights_ += g.lights;
    most = std::max(most, std::size_t(g.lights));
    for (std::size_t i = 0; i < g.channels.size(); ++i)
      light_of_[std::size_t(g.channels[i])] = g.first + (grey ? 0 : int(i));
  }
  const std::size_t cells = 4 * std::size_t(cells_), bands = std::size_t(options_.order) * options_.order;
  // Beyond the nodes with smoke nothing is ever written, so that zeros stay.
  single_ = std::make_unique<Buffer>(context_, "single scattering", cells * bands * std::size_t(lights_));
  result_ = std::make_unique<Buffer>(context_, "result", cells * bands * std::size_t(lights_));
  if (by_diffusion()) {
    for (Group& g : groups_) {
      const int c = g.channels[0];
      g.diffusion = std::make_unique<P1GridOnDevice>(
          context_, grid_.cells, *densities_, Scatterer{sigma_t[c], albedo[c], mean_cosine(medium_.phase)},
          options_.order, g.lights, P1Options{options_.tolerance, options_.iterations});
    }
    return;
  }
  source_ = std::make_unique<Buffer>(context_, "source", cells * bands * std::size_t(lights_));
  buffer(emitted_, "emitted", cells * most * std::size_t(ordinates_));
  buffer(radiance_of_ways_, "radiance of ordinates", cells * most * std::size_t(ordinates_));
  buffer(steps_, "steps", cells * most * bands * kept);
  buffer(means_, "means", cells * most * (3 + kept));
}

void LitGridOnDevice::upload_directions(const IncomingLight& light) {
  directions_ = int(light.directions().size());
  fixed_ = int(light.fixed());
  std::vector<float> towards;
  std::vector<std::vector<double>> harmonics;
  for (const Vec3& d : light.directions()) {
    for (int a = 0; a < 3; ++a) towards.push_back(float(d[a]));
    towards.push_back(0);
    harmonics.push_back(scene::evaluate_sh(options_.order, d));
  }
  towards_light_ = std::make_unique<Buffer>(context_, "directions", towards);
  harmonics_ = std::make_unique<Buffer>(context_, "harmonics", floats(harmonics, 4));
}

void LitGridOnDevice::set_scatterer(Program& p, const Group& g) const {
  p.set("first_light", g.first);
  p.set("lights", g.lights);
  p.set("sigma_t", medium_.sigma_t);
  for (int l = 0; l < g.lights; ++l) p.set(fmt::format("channel[{}]", l), g.channels[std::size_t(l)]);
}

void LitGridOnDevice::scatter_once(const Group& g) {
  Program& p = *single_program_;
  columns_.values().bind(at::columns);
  powers_->bind(at::powers);
  harmonics_->bind(at::harmonics);
  columns_.nodes().bind(at::nodes);
  single_->bind(at::single);
  set_scatterer(p, g);
  p.set("albedo", medium_.albedo);
  for (int b = 0; b < options_.order * options_.order; ++b) {
    const auto band = std::size_t(std::sqrt(double(b)));  // from towards the light to along it
    p.set(fmt::format("moment[{}]", b), (band % 2 ? -1 : 1) * moments_[band]);
  }
  p.set("node_count", columns_.count());
  p.set("directions", directions_);
  p.set("cells", cells_);
  p.dispatch(columns_.count(), g.lights);
}

// Buffers stay bound from one step to the next.
void LitGridOnDevice::iterate(const Group& g, int iteration) {
  state_->bind(at::state);
  emit(g);
  sweep(g);
  collect(g, iteration);
  decide(g, iteration);
  steps_->bind(at::steps);
  combine(g, iteration);
}

// Light that the cells send along each ordinate.
void LitGridOnDevice::emit(const Group& g) {
  Program& p = *emit_program_;
  source_->bind(at::source);
  ordinate_harmonics_->bind(at::harmonics);
  emitted_->bind(at::emitted);
  p.set("first_light", g.first);
  p.set("lights", g.lights);
  p.set("cells", cells_);
  p.dispatch(cells_, ordinates_ * g.lights);
}

// The ordinates' light, plane by plane.
void LitGridOnDevice::sweep(const Group& g) {
  Program& p = *sweep_program_;
  densities_->bind(at::densities);
  radiance_of_ways_->bind(at::light);
  ways_->bind(at::ways);
  (open_ ? *open_ : *ways_).bind(at::open);
  p.set("has_objects", open_ != nullptr);
  set_scatterer(p, g);
  p.set("cells_along", cells_along_);
  const int x = int(std::max(cells_along_[0], cells_along_[1])), y = int(std::max(cells_along_[1], cells_along_[2]));
  for (int plane = 0; plane < int(cells_along_.maxCoeff()); ++plane) {
    p.set("plane", plane);
    p.dispatch(x, y, ordinates_ * g.lights);
  }
}

// The light's moments, the source that they make, and what it misses.
void LitGridOnDevice::collect(const Group& g, int iteration) {
  Program& p = *collect_program_;
  radiance_of_ways_->bind(at::light);
  weighted_->bind(at::weighted);
  single_->bind(at::single);
  source_->bind(at::source);
  result_->bind(at::result);
  steps_->bind(at::steps);
  means_->bind(at::means);
  balance_->bind(at::balance);
  set_scatterer(p, g);
  p.set("albedo", medium_.albedo);
  for (int b = 0; b < options_.order * options_.order; ++b)
    p.set(fmt::format("moment[{}]", b), moments_[std::size_t(std::sqrt(double(b)))]);
  p.set("iteration", iteration);
  p.set("directions", ordinates_);
  p.set("cells", cells_);
  p.dispatch(cells_, g.lights);
}

// Products of what was missed; whether the solution is good enough, and the shares of the steps.
void LitGridOnDevice::decide(const Group& g, int iteration) {
  Program& products = *products_program_;
  densities_->bind(at::densities);
  parts_->bind(at::parts);
  set_scatterer(products, g);
  products.set("iteration", iteration);
  products.set("cells", cells_);
  products.dispatch(groups_of_sums * sum_lanes);
  Program& decide = *decide_program_;
  decide.set("iteration", iteration);
  decide.set("groups", groups_of_sums);
  decide.set("tolerance", std::max(options_.tolerance, least_tolerance));
  decide.dispatch(1);
}

// The next source, from the results and the steps of the last iterations.
void LitGridOnDevice::combine(const Group& g, int iteration) {
  Program& p = *combine_program_;
  p.set("iteration", iteration);
  p.set("first_light", g.first);
  p.set("lights", g.lights);
  p.set("cells", cells_);
  p.dispatch(options_.order * options_.order * g.lights * cells_);
}

void LitGridOnDevice::scatter_again(Group& g, bool cold, const scene::Execution& execution) {
  state_->clear();
  if (cold) {  // J_ss itself, as a result without steps
    state_->bind(at::state);
    single_->bind(at::result);
    source_->bind(at::source);
    steps_->bind(at::steps);
    combine(g, 1);
  }
  int told = 0, next = std::min(g.last > 0 ? g.last : first_iterations, options_.iterations);
  for (;;) {
    for (; told < next; ++told) iterate(g, told + 1);
    const StateData state = state_->download<StateData>().front();
    g.last = state.iterations;
    if (state.done || told >= options_.iterations) {
      iterations_ += state.iterations;
      error_ = std::max(error_, state.error);
      return;
    }
    if (execution.progress && !execution.progress(1)) throw scene::Interrupted("interrupted");
    next = std::min(told + std::max(2, told / 2), options_.iterations);
  }
}

void LitGridOnDevice::diffuse(Group& g, const scene::Execution& execution) {
  g.diffusion->solve(*single_, *result_, g.first, execution);
  iterations_ += g.diffusion->iterations();
  error_ = std::max(error_, g.diffusion->error());
}

void LitGridOnDevice::light(const IncomingLight& light, StageTimer& timer, const scene::Execution& execution) {
  timer.begin(light.directions().size() > light.fixed() ? "depths of directional lights" : "upload");
  const bool moved = columns_.aim(light, execution);
  timer.begin("upload");
  if (moved) upload_directions(light);
  std::vector<float> powers;
  for (const Rgb& p : light.power()) {
    for (int c = 0; c < 3; ++c) powers.push_back(float(p[c]));
    powers.push_back(0);
  }
  buffer(powers_, "powers", 4 * powers.size()).upload(powers);
  iterations_ = 0;
  error_ = 0;
  if (!multiple_) return;
  bool cold = !single_ || grey_ != light.grey();
  if (cold) {
    arrange(grey_ = light.grey());
    cold = by_diffusion() || !begin();
    last_ = {};
  }
  timer.begin("single scattering");
  for (const Group& g : groups_) scatter_once(g);
  timer.begin("multiple scattering");
  for (Group& g : groups_)
    if (g.diffusion)
      diffuse(g, execution);
    else
      scatter_again(g, cold, execution);
}

// Uploads what the last smoke's solution has at the nodes; false: not that of every light.
bool LitGridOnDevice::begin() {
  const Eigen::Index bands = options_.order * options_.order;
  std::vector<float> sources(std::size_t(lights_ * bands * cells_));
  for (const Group& g : groups_)
    for (int l = 0; l < g.lights; ++l) {
      const Eigen::ArrayXXd start = at_nodes(last_, g.channels[std::size_t(l)], grid_, bands);
      if (start.size() == 0) return false;
      std::transform(start.reshaped().begin(), start.reshaped().end(),
                     sources.begin() + long((g.first + l) * bands * cells_), [](double v) { return float(v); });
    }
  source_->upload(sources);
  return true;
}

airlight::compensated_ray_marching::Solution LitGridOnDevice::solution() const {
  airlight::compensated_ray_marching::Solution now;
  if (!multiple_ || !source_) return now;
  const std::vector<float> sources = source_->download<float>();
  const Eigen::Index bands = options_.order * options_.order;
  now.nodes = grid_;
  for (std::size_t c = 0; c < 3; ++c)
    now.of_channel[c] =
        Eigen::Map<const Eigen::ArrayXXf>(sources.data() + light_of_[c] * bands * cells_, cells_, bands).cast<double>();
  return now;
}

void LitGridOnDevice::towards(const scene::View& view, const Point3& middle) {
  greatest_->clear();
  Program& p = *towards_program_;
  columns_.values().bind(at::columns);
  powers_->bind(at::powers);
  towards_light_->bind(at::towards_light);
  columns_.nodes().bind(at::nodes);
  (multiple_ ? *single_ : columns_.nodes()).bind(at::single);
  (multiple_ ? *result_ : columns_.nodes()).bind(at::result);
  radiance_->bind(at::radiance);
  greatest_->bind(at::greatest);
  set_camera(p, view, middle);
  set_grid(p, grid_, middle);
  p.set("node_count", columns_.count());
  p.set("directions", directions_);
  p.set("fixed_directions", fixed_);
  p.set("cells", cells_);
  p.set("levels", options_.grid.levels);
  p.set("sh_order", options_.order);
  p.set("has_again", multiple_);
  const auto* hg = std::get_if<scene::HenyeyGreenstein>(&medium_.phase);
  p.set("phase_kind", int(medium_.phase.index()));
  p.set("phase_g", hg ? hg->g : 0.0);
  for (std::size_t l = 0; l < band_moments_.size(); ++l) p.set(fmt::format("band_moment[{}]", l), band_moments_[l]);
  for (std::size_t c = 0; c < 3; ++c) p.set(fmt::format("light_of[{}]", c), light_of_[c]);
  p.set("sigma_t", medium_.sigma_t);
  p.set("albedo", medium_.albedo);
  p.dispatch(columns_.count());
  Program& logarithms = *logarithms_program_;
  logarithms_->bind(at::logarithms);
  logarithms.set("cells", cells_);
  logarithms.dispatch(cells_);
  if (!edges_) return;
  Program& edges = *edges_program_;
  edges_->bind(at::edges);
  edge_nodes_->bind(at::edge_nodes);
  edge_weights_->bind(at::edge_weights);
  edges.set("edge_count", edge_count_);
  edges.dispatch(edge_count_);
}

}  // namespace airlight::gpu::compensated_ray_marching
