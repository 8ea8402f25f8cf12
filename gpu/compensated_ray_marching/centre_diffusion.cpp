#include "gpu/compensated_ray_marching/centre_diffusion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gpu/compensated_ray_marching/diffusion_vectors.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

using airlight::compensated_ray_marching::LeastSquaresSolver;
using airlight::compensated_ray_marching::Options;
using airlight::compensated_ray_marching::Solution;
using diffusion::SystemData;

constexpr int row_lanes = 64, summing = 256;  // invocations of a work group
constexpr int parts = 64, rows = 4,
              columns = 16;                // of a product: parts of a sum; results of a work group, and transposed
constexpr int first_solve_iterations = 8;  // told to the device before any is looked at

enum GradientStage { stage_begin, stage_residual, stage_step, stage_turn, stage_spread };  // diffusion_gradients.comp
constexpr auto vector_count = diffusion::vectors_of_least_squares;

bool is_lsqr(LeastSquaresSolver solver) {
  return solver == LeastSquaresSolver::lsqr || solver == LeastSquaresSolver::lsqr_scaled;
}

}  // namespace

CentreDiffusion::CentreDiffusion(Context& context, const CentreTables& tables, const Buffer& centres,
                                 const Buffer& single, const Buffer& again,
                                 const std::vector<scene::Gaussian>& gaussians, const scene::Medium& medium,
                                 const Options& options)
    : context_(context),
      centres_(centres),
      single_(single),
      again_(again),
      gaussians_(gaussians),
      medium_(medium),
      options_(options),
      count_(int(gaussians.size())) {
  const auto of = [&](const char* file, int x, int y, Definitions more) {
    more.insert(tables.definitions().begin(), tables.definitions().end());
    more["VECTORS"] = std::to_string(vector_count);
    return &program(context, file, x, y, more);
  };
  matrix_program_ = of("diffusion_matrix", row_lanes, 1, {{"SUMS", "5"}});
  right_program_ = of("diffusion_right", row_lanes, 1, {{"SUMS", "9"}});
  again_program_ = of("diffusion_again", row_lanes, 1, {{"SUMS", "11"}});
  product_program_ = of("diffusion_product", parts, rows, {{"TRANSPOSED", "0"}});
  transposed_program_ = of("diffusion_product", columns, parts, {{"TRANSPOSED", "1"}});
  gradients_program_ = of("diffusion_gradients", summing, 1,
                          {{"LSQR", is_lsqr(options.paper.solver) ? "1" : "0"},
                           {"STAGE_BEGIN", std::to_string(stage_begin)},
                           {"STAGE_RESIDUAL", std::to_string(stage_residual)},
                           {"STAGE_STEP", std::to_string(stage_step)},
                           {"STAGE_TURN", std::to_string(stage_turn)},
                           {"STAGE_SPREAD", std::to_string(stage_spread)}});
  find_groups();
}

// Channels that scatter nothing have no system.
void CentreDiffusion::find_groups() {
  const auto n = std::size_t(count_);
  int systems = 0;
  for (int c = 0; c < 3; ++c) {
    const double sigma_t = medium_.sigma_t[c], albedo = medium_.albedo[c];
    if (!(albedo > 0) || !(sigma_t > 0)) continue;
    const auto known = std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) {
      return sigma_t == medium_.sigma_t[g.channels[0]] && albedo == medium_.albedo[g.channels[0]];
    });
    if (known != groups_.end())
      known->channels.push_back(c);
    else
      groups_.emplace_back().channels = {c};
  }
  const LeastSquaresSolver solver = options_.paper.solver;
  const double g = mean_cosine(medium_.phase);
  for (Group& group : groups_) {
    group.first = systems;
    systems += int(group.channels.size());
    group.matrix = std::make_unique<Buffer>(context_, "diffusion matrix", 8 * n * n, Contents::undefined);
    group.row_scales = std::make_unique<Buffer>(context_, "scales of rows", 8 * n, Contents::undefined);
    const double sigma_t = medium_.sigma_t[group.channels[0]], albedo = medium_.albedo[group.channels[0]];
    Program& p = *matrix_program_;
    centres_.bind(at::centres);
    group.matrix->bind(at::matrix);
    group.row_scales->bind(at::row_scales);
    p.set("gaussian_count", count_);
    p.set("scaled", solver == LeastSquaresSolver::cg_scaled || solver == LeastSquaresSolver::lsqr_scaled);
    p.set_double("transport", (1 - albedo * g) * sigma_t);
    p.set_double("absorption", (1 - albedo) * sigma_t);
    p.dispatch(row_lanes * count_);
  }
  vectors_ = std::make_unique<Buffer>(context_, "vectors of diffusion", 8 * n * vector_count * std::size_t(systems));
  systems_ = std::make_unique<Buffer>(context_, "diffusion systems", sizeof(SystemData) * std::size_t(systems));
}

void CentreDiffusion::begin_with(const Solution& last) {
  if (last.empty() || groups_.empty()) return;
  const auto n = std::size_t(count_);
  std::vector<double> vectors(vectors_->bytes() / sizeof(double), 0.0);
  for (Group& g : groups_) {
    std::vector<Eigen::VectorXd> starts;
    for (const int channel : g.channels) starts.push_back(at_centres(last, channel, gaussians_));
    const auto known = [](const Eigen::VectorXd& start) { return start.size() > 0; };
    if (!std::all_of(starts.begin(), starts.end(), known)) continue;
    // One system stands for all channels until their light differs.
    if (std::any_of(starts.begin(), starts.end(), [&](const auto& start) { return start != starts[0]; }))
      g.systems = int(g.channels.size());
    for (std::size_t s = 0; s < starts.size(); ++s)
      std::copy(starts[s].begin(), starts[s].end(),
                vectors.begin() + long(((std::size_t(g.first) + s) * vector_count + diffusion::solution) * n));
  }
  vectors_->upload(vectors);
}

Solution CentreDiffusion::solution() const {
  Solution now;
  if (groups_.empty()) return now;
  const std::vector<double> vectors = vectors_->download<double>();
  now.centres = gaussians_;
  for (const Group& g : groups_)
    for (std::size_t i = 0; i < g.channels.size(); ++i) {
      const std::size_t system = std::size_t(g.first) + (g.systems == 1 ? 0 : i);
      now.of_channel[std::size_t(g.channels[i])] = Eigen::Map<const Eigen::ArrayXd>(
          vectors.data() + (system * vector_count + diffusion::solution) * std::size_t(count_), count_);
    }
  return now;
}

void CentreDiffusion::bind_systems(Program& p, const Group& g) const {
  vectors_->bind(at::vectors);
  systems_->bind(at::systems);
  p.set("unknowns", count_);
  p.set("first_system", g.first);
}

void CentreDiffusion::bind_channels(Program& p, const Group& g) const {
  bind_systems(p, g);
  p.set("gaussian_count", count_);
  centres_.bind(at::centres);
  single_.bind(at::single_bands);
  for (std::size_t i = 0; i < g.channels.size(); ++i) p.set(fmt::format("channel[{}]", i), g.channels[i]);
}

void CentreDiffusion::product(const Group& g, bool transposed, int from, int to) {
  Program& p = transposed ? *transposed_program_ : *product_program_;
  bind_systems(p, g);
  g.matrix->bind(at::matrix);
  p.set("from_vector", from);
  p.set("to_vector", to);
  p.dispatch(transposed ? count_ : (count_ + rows - 1) / rows * parts, 1, g.systems);
}

void CentreDiffusion::gradients(const Group& g, int stage) {
  Program& p = *gradients_program_;
  bind_systems(p, g);
  p.set("stage", stage);
  p.set("most_iterations", options_.iterations);
  p.set_double("tolerance", options_.tolerance);
  p.dispatch(summing, 1, stage == stage_spread ? int(g.channels.size()) : g.systems);
}

void CentreDiffusion::scatter_again(bool grey, const scene::Execution& execution) {
  iterations_ = 0;
  residual_ = negative_share_ = 0;
  for (Group& g : groups_)
    if (!grey && g.systems < int(g.channels.size())) {
      gradients(g, stage_spread);
      g.systems = int(g.channels.size());
    }
  systems_->clear();
  for (Group& g : groups_) scatter_again(g, execution);
}

void CentreDiffusion::scatter_again(Group& g, const scene::Execution& execution) {
  const bool printed = options_.paper.multiple == Options::Paper::Multiple::as_printed;
  const int channel = g.channels[0];
  const double sigma_t = medium_.sigma_t[channel], albedo = medium_.albedo[channel];
  const double cosine = mean_cosine(medium_.phase), sigma_tr = (1 - albedo * cosine) * sigma_t;
  Program& of_right = *right_program_;
  bind_channels(of_right, g);
  g.row_scales->bind(at::row_scales);
  of_right.set_double("of_mean", printed ? -sigma_t / albedo : -sigma_t);
  of_right.set_double("of_gradient", sigma_t / ((printed ? 1 : 3) * sigma_tr));
  of_right.dispatch(row_lanes * count_, 1, g.systems);

  solve(g, execution);

  Program& again = *again_program_;
  bind_channels(again, g);
  again_.bind(at::again);
  again.set("channels", int(g.channels.size()) / g.systems);
  again.set_double("albedo", albedo);
  again.set_double("mean_cosine", cosine);
  again.set_double("sigma_t", sigma_t);
  again.set_double("factor", (printed ? 1 : 3) / (3 * sigma_tr));
  again.dispatch(row_lanes * count_, 1, g.systems);
}

// Least squares: conjugate gradients of the normal equations, or LSQR.
void CentreDiffusion::solve(Group& g, const scene::Execution& execution) {
  const bool lsqr = is_lsqr(options_.paper.solver);
  product(g, false, diffusion::solution, diffusion::along);
  gradients(g, stage_residual);
  product(g, true, diffusion::residual, diffusion::gradient);
  product(g, true, diffusion::right, diffusion::along);
  gradients(g, stage_begin);
  int told = 0, next = std::min(g.last > 0 ? g.last : first_solve_iterations, options_.iterations);
  for (bool done = false; !done;) {
    for (; told < next; ++told) {
      product(g, false, lsqr ? diffusion::gradient : diffusion::direction, diffusion::along);
      gradients(g, stage_step);
      product(g, true, diffusion::residual, lsqr ? diffusion::along : diffusion::gradient);
      gradients(g, stage_turn);
    }
    const std::vector<SystemData> all = systems_->download<SystemData>();
    done = true;
    g.last = 0;
    for (int s = g.first; s < g.first + g.systems; ++s) {
      done = done && all[std::size_t(s)].done != 0;
      g.last = std::max(g.last, all[std::size_t(s)].iterations);
    }
    if (done) {
      for (int s = g.first; s < g.first + g.systems; ++s) {
        const SystemData& system = all[std::size_t(s)];
        const int alike = int(g.channels.size()) / g.systems;
        iterations_ += alike * system.iterations;
        residual_ = std::max(residual_, std::sqrt(system.square) / system.whole);
        negative_share_ += double(alike * system.negative) / (3 * count_);
      }
    } else {
      if (execution.progress && !execution.progress(1)) throw scene::Interrupted("interrupted");
      next = told + std::max(4, told / 2);
    }
  }
}

}  // namespace airlight::gpu::compensated_ray_marching
