#include "gpu/light_map/light_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gpu/light_map/interface.h"
#include "gpu/ray_marcher/interface.h"
#include "reference/light_map/encoding.h"
#include "scene/base/error.h"
#include "scene/light/same_light.h"
#include "scene/renderer.h"

namespace airlight::gpu::light_map {
namespace {

using airlight::light_map::Encoding;
using airlight::light_map::Projection;

constexpr std::size_t rule_floats = 17;                         // map_rule of look_up.glsl
constexpr std::size_t work_bytes = std::size_t(64) << 20;       // of what a dispatch leaves for the next
constexpr int most_texels = 1 << 20, watched_texels = 1 << 13;  // of a dispatch; of one between two looks at `progress`
constexpr int group = 64, steps_at_once = 16;
constexpr int most_iterations = 50000;  // of an invocation's loops, of which llvmpipe allows 65535

int entries(const airlight::light_map::Options& o) {
  return o.encoding == Encoding::slices ? o.slices : o.encoding == Encoding::avsm ? o.nodes : o.coefficients;
}

double count_floats(const airlight::light_map::VariedMedia& varied, const airlight::light_map::Options& o,
                    std::size_t lights) {
  return double(lights) * (double(rule_floats) + bytes_of_map(varied, o) / 4);
}

}  // namespace

// The layout of depths.comp.
struct LightMaps::Part {
  std::array<float, 4> lo, hi, extinction;
};

LightMaps::LightMaps(Context& context, const ray_marcher::MediaOnDevice& media,
                     const std::vector<scene::Medium>& in_scene,
                     const std::vector<airlight::ray_marcher::Layer>& layers, const std::vector<scene::Light>& lights,
                     const airlight::light_map::Options& options, const std::function<bool(double)>& progress)
    : context_(context),
      options_(options),
      varied_(varied_media(in_scene, options)),
      lights_(int(lights.size())),
      buffer_(context, fmt::format("maps of {} lights", lights.size()),
              4 * std::size_t(count_floats(varied_, options, lights.size())), Contents::undefined) {
  if (varied_.planes == 0) return;
  project(lights);
  buffer_.upload(rules(media.middle()));
  Work work;
  make(media, layers, std::vector<bool>(lights.size(), true), work, progress);
}

void LightMaps::project(const std::vector<scene::Light>& lights) {
  projections_.clear();
  for (const scene::Light& light : lights)
    projections_.push_back(airlight::light_map::fit(light, varied_.box, options_.size));
  drawn_ = lights;
}

bool LightMaps::fits(const std::vector<scene::Medium>& in_scene, const std::vector<scene::Light>& lights) const {
  return lights.size() == std::size_t(lights_) && varied_media(in_scene, options_).planes == varied_.planes;
}

int LightMaps::become(const ray_marcher::MediaOnDevice& media, const std::vector<scene::Medium>& in_scene,
                      const std::vector<airlight::ray_marcher::Layer>& layers, const std::vector<scene::Light>& lights,
                      bool same_media, const std::function<bool(double)>& progress) {
  varied_ = varied_media(in_scene, options_);
  if (varied_.planes == 0) return 0;
  std::vector<bool> wanted;
  for (std::size_t l = 0; l < lights.size(); ++l)
    wanted.push_back(!(same_media && scene::same_rays(drawn_[l], lights[l])));
  const int made = int(std::count(wanted.begin(), wanted.end(), true));
  if (made == 0) return 0;
  project(lights);
  buffer_.upload(rules(media.middle()));
  make(media, layers, wanted, work_, progress);
  return made;
}

std::size_t LightMaps::plane_floats() const { return std::size_t(bytes_per_plane(options_)) / 4; }

// From the projections, relative to the middle: rule_of of reference/light_map/kernels.cpp.
std::vector<float> LightMaps::rules(const Point3& middle) const {
  std::vector<float> rules;
  for (const Projection& p : projections_) {
    const bool octahedral = p.kind == Projection::Kind::octahedral;
    const double factors[3] = {p.size / p.across[0].length(), p.size / p.across[1].length(), 1 / p.depth.length()};
    const double begins[3] = {p.across[0].lo, p.across[1].lo, p.depth.lo};
    double shift = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = p.axes.row(k);
      const double factor = octahedral ? 1 : factors[k];
      shift = octahedral ? axis.dot(middle - p.light) : factor * (axis.dot(middle) - begins[k]);
      for (int i = 0; i < 3; ++i) rules.push_back(float(factor * axis[i]));
      rules.push_back(float(shift));
    }
    const double near = p.depth.lo;
    const bool far = octahedral && near > 0.5 * std::abs(shift);
    rules.insert(rules.end(),
                 {octahedral ? (p.whole_sphere() ? 2.0f : 1.0f) : 0.0f, float(0.5 * p.size / p.reach), float(near),
                  far ? float((shift - near) * (shift + near)) : 1e37f, float(1 / p.depth.length())});
  }
  return rules;
}

std::vector<LightMaps::Part> LightMaps::parts(const ray_marcher::MediaOnDevice& media,
                                              const std::vector<airlight::ray_marcher::Layer>& layers) const {
  std::vector<Part> parts(layers.size(), Part{});
  const auto float4 = [](const Vec3& v, float w) {
    return std::array<float, 4>{float(v[0]), float(v[1]), float(v[2]), w};
  };
  for (std::size_t k = 0; k < layers.size(); ++k)
    for (const airlight::light_map::VariedMedia::Part& part : varied_.parts)
      if (part.medium == layers[k].medium)
        parts[k] = {float4(part.box.lo - media.middle(), 1), float4(part.box.hi - media.middle(), 0),
                    float4(part.extinction.matrix(), 0)};
  return parts;
}

std::map<std::string, std::string> LightMaps::definitions() const {
  return {{"MAP_PLANES", std::to_string(varied_.planes)}, {"MAP_ENCODING", std::to_string(int(options_.encoding))}};
}

void LightMaps::bind(LinkedProgram& program) const {
  if (varied_.planes == 0) return;
  buffer_.bind(ray_marcher::at::light_maps);
  program.set("map_lights", lights_);
  program.set("map_size", options_.size);
  program.set("map_floats", floats_per_texel(options_));
  program.set("map_entries", entries(options_));
  program.set("map_negative", varied_.negative);
  program.set("map_share", varied_.share);
}

void LightMaps::make(const ray_marcher::MediaOnDevice& media, const std::vector<airlight::ray_marcher::Layer>& layers,
                     const std::vector<bool>& wanted, Work& work, const std::function<bool(double)>& progress) {
  const Use use(context_);
  const int steps = options_.steps, planes = varied_.planes, floats = floats_per_texel(options_);
  double per_step = 0;  // iterations
  for (const airlight::ray_marcher::Layer& layer : layers)
    per_step += 2 + (layer.varies ? ray_marcher::density_iterations(layer) : 0);
  if (context_.software() && per_step > most_iterations)
    throw Unavailable(fmt::format("gpu: a step of a light's map takes {:.0f} iterations, {} stops after 65535",
                                  per_step, context_.renderer()));
  const int at_once = std::clamp(int(most_iterations / per_step), 1, steps_at_once);
  const bool avsm = options_.encoding == Encoding::avsm, fourier = options_.encoding == Encoding::fourier;
  const std::size_t nodes = avsm ? 4 * (std::size_t(options_.nodes) + 1) + 4 : 0;  // floats of a texel under way
  const int all = (options_.size + 2) * (options_.size + 2);
  const int texels =
      std::min({all, progress ? watched_texels : most_texels,
                std::max(group, int(work_bytes / (4 * std::size_t(planes) * (std::size_t(steps) + nodes))))});
  reserve(work.steps, context_, "depths of a light's map", 4 * std::size_t(texels) * planes * steps);
  reserve(work.nodes, context_, "nodes of a light's map", 4 * std::size_t(texels) * planes * nodes);
  refill(work.parts, context_, "media of light maps", parts(media, layers));
  if (!work.waves) {
    const airlight::light_map::Encoder encoder(options_);
    refill(work.waves, context_, "waves of light maps",
           std::vector<float>(encoder.waves().begin(), encoder.waves().end()));
  }

  auto definitions = media.definitions();
  definitions.insert({{"LOCAL_SIZE_X", std::to_string(group)}, {"MAP_PLANES", std::to_string(planes)}});
  Program& march = program(context_, "light_map/depths.comp", definitions);
  Program& encode =
      program(context_, "light_map/encode.comp",
              {{"LOCAL_SIZE_X", std::to_string(group)}, {"MAP_ENCODING", std::to_string(int(options_.encoding))}});
  media.bind(march);
  for (Program* p : {&march, &encode}) {
    p->set("map_size", options_.size);
    p->set("steps", steps);
  }
  march.set("steps_at_once", at_once);
  encode.set("map_floats", floats);
  encode.set("map_entries", entries(options_));
  encode.set("plane_floats", int(plane_floats()));
  for (int l = 0; l < lights_; ++l) {
    if (!wanted[std::size_t(l)]) continue;
    const Projection& p = projections_[std::size_t(l)];
    const bool octahedral = p.kind == Projection::Kind::octahedral;
    const Vec3 axes[3] = {p.axes.row(0), p.axes.row(1), p.axes.row(2)};
    const Point3 corner = p.across[0].lo * axes[0] + p.across[1].lo * axes[1] + p.depth.lo * axes[2];
    march.set("octahedral", octahedral);
    march.set_double("reach", p.reach);
    march.set_double("map_x", axes[0]);
    march.set_double("map_y", axes[1]);
    march.set_double("map_axis", axes[2]);
    march.set_double("corner", Vec3((octahedral ? p.light : corner) - media.middle()));
    march.set_double("texel_width", p.across[0].length() / p.size);
    march.set_double("texel_height", p.across[1].length() / p.size);
    march.set_double("near", p.depth.lo);
    march.set("step_length", p.depth.length() / steps);
    encode.set("first_float", int(rule_floats * std::size_t(lights_) + std::size_t(l) * planes * plane_floats()));
    for (Program* program : {&march, &encode}) program->set("whole_sphere", p.whole_sphere());
    for (int first = 0; first < all; first += texels) {
      const int count = std::min(texels, all - first);
      for (Program* program : {&march, &encode}) {
        program->set("first_texel", first);
        program->set("texel_count", count);
      }
      work.parts->bind_as(GL_UNIFORM_BUFFER, at::parts);
      work.steps->bind(at::steps);
      march.dispatch(count, (steps + at_once - 1) / at_once);
      buffer_.bind(at::texels);
      if (fourier) work.waves->bind(at::waves);
      if (avsm) work.nodes->bind(at::nodes);
      const int steps_a_round = avsm ? std::max(1, most_iterations / (8 * (options_.nodes + 2))) : steps;
      for (int step = 0; step < steps; step += steps_a_round) {
        if (avsm) encode.set("first_step", step);
        if (avsm) encode.set("end_step", std::min(step + steps_a_round, steps));
        encode.dispatch(count, planes, fourier ? options_.coefficients : 1);
      }
      if (progress && !progress((l + double(first + count) / all) / lights_)) throw scene::Interrupted("interrupted");
    }
  }
}

std::vector<float> LightMaps::texels(int light, int plane) const {
  const Use use(context_);
  const auto all = buffer_.download<float>();
  const auto begin = all.begin() + std::ptrdiff_t(rule_floats * std::size_t(lights_) +
                                                  (std::size_t(light) * varied_.planes + plane) * plane_floats());
  return {begin, begin + std::ptrdiff_t(plane_floats())};
}

}  // namespace airlight::gpu::light_map
