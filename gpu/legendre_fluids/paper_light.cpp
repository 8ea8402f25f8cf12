#include "gpu/legendre_fluids/paper_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/base/error.h"

namespace airlight::gpu::legendre_fluids {
namespace {

using airlight::legendre_fluids::DensityProduct;
using airlight::legendre_fluids::LightAxes;
using scene::TensorShape;

constexpr int most_vectors = 400, most_gradients = 20000;      // steps of GMRES, of conjugate gradients
constexpr std::size_t room_of_vectors = std::size_t(1) << 26;  // bytes
constexpr int loops_of_light = 20000;                          // llvmpipe ends all loops after 65535 iterations
constexpr int first_steps = 32;                                // that are tried
constexpr double squared = 1e-2;                               // of the tolerance, where conditions are squared
constexpr double more_light_steps = 1.25;                      // than were enough

std::string three(const TensorShape& n) { return fmt::format("ivec3({}, {}, {})", n[0], n[1], n[2]); }
void add_rows(const Eigen::MatrixXd& m, std::vector<double>& at_end) {
  for (Eigen::Index r = 0; r < m.rows(); ++r)
    for (Eigen::Index c = 0; c < m.cols(); ++c) at_end.push_back(m(r, c));
}

// Where each of three tables begins.
TensorShape add_tables(const std::array<Eigen::MatrixXd, 3>& tables, std::vector<double>& at_end) {
  TensorShape begins;
  for (std::size_t a = 0; a < 3; ++a) {
    begins[a] = int(at_end.size());
    add_rows(tables[a], at_end);
  }
  return begins;
}

// Greatest size of an intermediate result, when the axes of one shape are transformed one after another
// to those of another shape.
int most_on_the_way(const TensorShape& from, const TensorShape& to) {
  return std::max(
      {scene::tensor_size(from), to[0] * from[1] * from[2], to[0] * to[1] * from[2], scene::tensor_size(to)});
}

}  // namespace

PaperSystems::PaperSystems(Context& context, const airlight::legendre_fluids::PaperMedium& media,
                           const std::vector<scene::DirectionalLight>& lights,
                           const airlight::legendre_fluids::PaperOptions& options, const std::array<bool, 3>& moving)
    : context_(context),
      media_(media),
      lights_(lights),
      options_(options),
      shape_(airlight::legendre_fluids::intensity_shape(field().shape(), options.n, moving)),
      channels_(find_channels()),
      density_shape_(field().shape()),
      box_(field().box()),
      albedo_is_field_(media.scattering[0] != nullptr) {
  group_ = unknowns() > 1000 ? 256 : 128;
  tolerance_ = options.solver.tolerance * (upwind() ? 1 : squared);
  const DensityProduct product(field().coefficients(), field().shape(), shape_, options.truncation);
  scattered_.count = channels_.systems;
  direct_.count = int(lights.size() * channels_.extinctions.size());
  lay_out_tables(product);
  lay_out_work(product);
  for (Kind* kind : {&direct_, &scattered_})
    kind->status = std::make_unique<Buffer>(context, "systems' ends", 8 * std::size_t(kind->count));
  density_ = &program(context, "paper_density", group_, 1, definitions_);
  right_ = &program(context, "paper_right", group_, 1, definitions_);
  steps_ = &program(context, upwind() ? "paper_gmres" : "paper_gradients", group_, 1, definitions_);
  kept_ = &program(context, "paper_kept", group_, 1, definitions_);
  upload_density(product);
}

void PaperSystems::upload_density(const DensityProduct& product) {
  // The density, then what scatters of it in each channel.
  std::vector<double> at_points(product.density().begin(), product.density().end());
  for (const scene::LegendrePointer& part : media_.scattering)
    if (part) {
      const DensityProduct scatters(part->coefficients(), part->shape(), shape_, options_.truncation);
      at_points.insert(at_points.end(), scatters.density().begin(), scatters.density().end());
    }
  points_->upload(at_points);
  refill(densities_, context_, "coefficients of the density",
         std::vector<float>(field().coefficients().begin(), field().coefficients().end()));
  density_from(*densities_, 0);
}

bool PaperSystems::become(bool same_densities, const std::array<bool, 3>& moving) {
  const Channels channels = find_channels();
  if (field().shape() != density_shape_ || field().box().lo != box_.lo || field().box().hi != box_.hi ||
      airlight::legendre_fluids::intensity_shape(field().shape(), options_.n, moving) != shape_ ||
      channels.systems != scattered_.count || int(lights_.size() * channels.extinctions.size()) != direct_.count ||
      channels.extinctions.size() != channels_.extinctions.size() || bool(media_.scattering[0]) != albedo_is_field_)
    return false;
  channels_ = channels;
  if (!same_densities) upload_density({field().coefficients(), field().shape(), shape_, options_.truncation});
  const std::vector<double> before = tables_;
  set_directions(view_);
  if (tables_ != before) table_->upload(tables_);
  return true;
}

// E_s is linear in the light: channels of one extinction, whose lights differ by a factor only, are one system.
PaperSystems::Channels PaperSystems::find_channels() const {
  Channels all;
  std::array<Eigen::VectorXd, 3> light;
  for (int c = 0; c < 3; ++c) {
    const auto found = std::find(all.extinctions.begin(), all.extinctions.end(), medium().sigma_t[c]);
    all.extinction_of[std::size_t(c)] = int(found - all.extinctions.begin());
    if (found == all.extinctions.end()) all.extinctions.push_back(medium().sigma_t[c]);
    Eigen::VectorXd& mine = light[std::size_t(c)];
    mine.resize(Eigen::Index(lights_.size()));
    for (std::size_t l = 0; l < lights_.size(); ++l) mine[Eigen::Index(l)] = lights_[l].irradiance[c];
    const double most = mine.maxCoeff();
    all.scale[c] = (media_.scattering[0] ? 1 : medium().albedo[c]) * most;
    if (most > 0) mine /= most;
    int same = 0;
    while (same < c && (!media_.alike(std::size_t(same), std::size_t(c)) || light[std::size_t(same)] != mine)) ++same;
    all.system_of[std::size_t(c)] = same < c ? all.system_of[std::size_t(same)] : all.systems++;
  }
  return all;
}

void PaperSystems::number(const char* name, std::size_t value) { definitions_[name] = std::to_string(value); }

// Tables, and where each of them begins.
void PaperSystems::lay_out_tables(const DensityProduct& product) {
  const TensorShape& m = product.points();
  definitions_ = {{"N", three(shape_)}, {"M", three(m)}, {"R", three(field().shape())}};
  definitions_["VALUES_AT"] = three(add_tables(product.matrices().values, tables_));
  definitions_["OF_DENSITY_AT"] = three(add_tables(product.matrices().of_density, tables_));
  definitions_["ANALYSIS_AT"] = three(add_tables(product.matrices().analysis, tables_));
  directions_at_ = tables_.size();
  const auto [x, y, z] = shape_;
  const int squares = x * x + y * y + z * z;
  definitions_["ENDS_AT"] = three({squares, squares + x, squares + x + y});
  const std::size_t weights = std::size_t(squares) + x + y + z;
  number("WEIGHTS_AT", weights);
  number("DIRECTIONS_AT", directions_at_);
  number("DIRECTION_STRIDE", weights + 4);
  tables_.resize(directions_at_ + (lights_.size() + 1) * (weights + 4));
  set_directions(Vec3::UnitX());
  table_ = std::make_unique<Buffer>(context_, "tables of light", tables_);
}

// Where everything lies in the work of a system, and the buffers.
void PaperSystems::lay_out_work(const DensityProduct& product) {
  const TensorShape& m = product.points();
  const auto [x, y, z] = shape_;
  const std::size_t n = std::size_t(unknowns());
  const std::size_t systems = std::size_t(std::max(direct_.count, scattered_.count));
  number("UNKNOWNS", n);
  number("SYSTEMS", systems);
  number("LIGHTS", lights_.size());
  number("EXTINCTIONS", channels_.extinctions.size());
  number("UPWIND", upwind());
  most_steps_ =
      upwind() ? int(std::min<std::size_t>({most_vectors, n, room_of_vectors / (8 * n * systems)})) : most_gradients;
  number("ROOM", std::size_t(most_steps_));
  const std::size_t points = std::size_t(scene::tensor_size(m)), steps = std::size_t(most_steps_);
  const std::size_t region = std::size_t(std::max(most_on_the_way(shape_, m), most_on_the_way(field().shape(), m)));
  number("ALL_POINTS", points);
  number("REGION", region);
  std::size_t size = 0;
  const auto part = [&](const char* name, std::size_t count) {
    number(name, size);
    size += count;
  };
  part("SOLUTION_AT", n);
  part("VECTORS_AT", upwind() ? (steps + 1) * n : 4 * n);
  part("ROOM_AT", 2 * region);
  part("SCALARS_AT", 4);
  part("REST_AT", upwind() ? steps + 1 : 0);
  part("PARTS_AT", upwind() ? steps + 1 : 0);
  part("ROTATIONS_AT", upwind() ? 2 * steps : 0);
  part("TRIANGLE_AT", upwind() ? (steps + 1) * steps : 0);
  number("STRIDE", size);
  const std::size_t series = n + n / std::size_t(x) + n / std::size_t(y) + n / std::size_t(z);
  number("SERIES_STRIDE", series);
  number("DENSITY_AT", series * std::size_t(scattered_.count));
  // A step's loops are those of its products, and of GMRES its way through the vectors.
  const double widest = std::max({m[0], m[1], m[2]}), lanes = group_;
  const double loops = (6 * double(region) * widest + 4 * double(n) * widest) * (upwind() ? 1 : 2) / lanes +
                       (upwind() ? 4 * double(n) * 100 / lanes : 0);
  together_ = std::max(1, int(loops_of_light / loops));
  const auto doubles = [&](const char* name, std::size_t count) {
    return std::make_unique<Buffer>(context_, name, 8 * count, Contents::undefined);
  };
  points_ = doubles("density at points", points * (media_.scattering[0] ? 4 : 1));
  work_ = doubles("systems of light", systems * size);
  direct_values_ = doubles("direct light", std::size_t(direct_.count) * n);
  faces_ = std::make_unique<Buffer>(
      context_, "scattered light and density",
      4 * (series * std::size_t(scattered_.count) + std::size_t(scene::tensor_size(field().shape()))),
      Contents::undefined);
}

// Uploads the directions of the lights, then of the view.
void PaperSystems::set_directions(const Vec3& view) {
  std::vector<double> all;
  for (std::size_t d = 0; d <= lights_.size(); ++d) {
    const Vec3 rate = 2 * (d < lights_.size() ? Vec3(-lights_[d].to_light) : view).cwiseQuotient(field().box().size());
    const LightAxes axes(shape_, rate, options_.solver);
    for (const Eigen::MatrixXd& along : axes.along) add_rows(along, all);
    for (std::size_t a = 0; a < 3; ++a)
      add_rows(axes.end[a].size() > 0 ? axes.end[a] : Eigen::VectorXd(Eigen::VectorXd::Zero(shape_[a])), all);
    all.insert(all.end(), axes.weight.data(), axes.weight.data() + 3);
    all.push_back(1 / rate.norm());
  }
  std::copy(all.begin(), all.end(), tables_.begin() + std::ptrdiff_t(directions_at_));
  view_ = view;
}

void PaperSystems::density_from(const Buffer& coefficients, std::size_t first) {
  table_->bind(at::tables);
  work_->bind(at::work);
  points_->bind(at::values);
  coefficients.bind(at::state);
  faces_->bind(at::kept);
  density_->set("first", int(first));
  density_->dispatch(group_);
}

bool PaperSystems::take(const DensityOnDevice& d) {
  const int n = d.coefficients;
  if (media_.scattering[0] || field().shape() != TensorShape{n, n, n} || field().box().lo != d.box.lo ||
      field().box().hi != d.box.hi)
    return false;
  density_from(d.state, d.field * std::size_t(n * n * n));
  return true;
}

void PaperSystems::set(Program& p, const Kind& kind) const {
  for (int s = 0; s < kind.count; ++s) {
    const auto system = std::size_t(s);
    const auto channel =
        std::size_t(std::find(channels_.system_of.begin(), channels_.system_of.end(), s) - channels_.system_of.begin());
    const bool scatters = &kind == &scattered_;
    p.set_double(at_index("sigma_t", system), scatters ? medium().sigma_t[Eigen::Index(channel)]
                                                       : channels_.extinctions[system % channels_.extinctions.size()]);
    p.set(at_index("directions", system), int(scatters ? lights_.size() : system / channels_.extinctions.size()));
  }
}

// Right sides.
void PaperSystems::start(const Kind& kind) {
  table_->bind(at::tables);
  work_->bind(at::work);
  points_->bind(at::values);
  direct_values_->bind(at::direct);
  const bool scatters = &kind == &scattered_;
  Program& p = *right_;
  set(p, kind);
  p.set("scatters", scatters);
  for (int c = 0; c < 3 && scatters; ++c) {
    const auto system = std::size_t(channels_.system_of[std::size_t(c)]);
    p.set(at_index("extinctions", system), channels_.extinction_of[std::size_t(c)]);
    p.set(at_index("scatterers", system), media_.scattering[0] ? 1 + c : 0);
    double most = 0;
    for (const scene::DirectionalLight& light : lights_) most = std::max(most, light.irradiance[c]);
    for (std::size_t l = 0; l < lights_.size(); ++l) {
      const double omega = phase_value(medium().phase, std::clamp(view_.dot(-lights_[l].to_light), -1.0, 1.0));
      p.set_double(at_index("amounts", system * lights_.size() + l),
                   most > 0 ? medium().sigma_t[c] * omega * lights_[l].irradiance[c] / most : 0);
    }
  }
  p.dispatch(kind.count * group_);
}

void PaperSystems::run(const Kind& kind, int steps) {
  Program& p = *steps_;
  set(p, kind);
  p.set_double("tolerance", tolerance_);
  for (int left = steps; left > 0; left -= together_) {
    p.set("steps", std::min(left, together_));
    if (upwind()) p.set("ends", left <= together_);
    p.dispatch(kind.count * group_);
  }
}

void PaperSystems::keep(const Kind& kind) {
  kind.status->bind(at::status);
  faces_->bind(at::faces);
  Program& p = *kept_;
  set(p, kind);
  p.set("scatters", &kind == &scattered_);
  p.set("sides", Vec3((view_.array() > 0).select(Vec3::Ones(), -Vec3::Ones())));
  p.dispatch(kind.count * group_);
}

// False: some are not done. Then twice as many steps are taken the next time.
bool PaperSystems::look(Kind& kind, const std::vector<float>& status) {
  double most = 0, residual = 0;
  kind.iterations = 0;
  for (std::size_t s = 0; s < std::size_t(kind.count); ++s) {
    const double steps = status[2 * s], left = status[2 * s + 1];
    kind.iterations += int(steps);
    most = std::max(most, steps);
    residual = std::max(residual, left == left ? left : infinity);
  }
  const bool done = residual <= tolerance_ * (1 + 1e-6);
  if (!done && (!(residual < infinity) || most >= most_steps_))
    throw Error(fmt::format("{} left a residual of {:.1e} after {} iterations, expected {:.1e}",
                            upwind() ? "GMRES" : "conjugate gradients", residual, most, tolerance_));
  kind.rounds = std::min(most_steps_, std::max(kind.rounds, int(more_light_steps * most) + 1) * (done ? 1 : 2));
  return done;
}

void PaperSystems::begin() {
  direct_.rounds = std::min(most_steps_, first_steps);
  do {
    start(direct_);
    run(direct_, direct_.rounds);
    keep(direct_);
  } while (!look(direct_, direct_.status->download<float>()));
  scattered_.rounds = direct_.rounds;
}

std::vector<Eigen::VectorXd> PaperSystems::direct() const {
  const std::vector<double> values = direct_values_->download<double>();
  std::vector<Eigen::VectorXd> all;
  for (int s = 0; s < direct_.count; ++s)
    all.push_back(Eigen::Map<const Eigen::VectorXd>(values.data() + s * unknowns(), unknowns()));
  return all;
}

std::array<int, 3> PaperSystems::first_of_direct(std::size_t light) const {
  std::array<int, 3> first;
  for (std::size_t c = 0; c < 3; ++c)
    first[c] = (int(light * channels_.extinctions.size()) + channels_.extinction_of[c]) * unknowns();
  return first;
}

void PaperSystems::solve(Kind& kind, Frame& frame) {
  start(kind);
  run(kind, kind.rounds);
  keep(kind);
  frame.download.add_status(kind.name, *kind.status, kind.status->bytes());
}

void PaperSystems::solve_scattered(Frame& frame, const Vec3& direction) {
  if (direction != view_) {
    set_directions(direction);
    table_->upload(tables_);
  }
  solve(scattered_, frame);
}

bool PaperSystems::keep_up(const Frame& frame) {
  bool done = true;
  for (Kind* kind : {&direct_, &scattered_})
    if (const auto status = frame.download.values<float>(kind->name); !status.empty())
      done = look(*kind, status) && done;
  return done;
}

}  // namespace airlight::gpu::legendre_fluids
