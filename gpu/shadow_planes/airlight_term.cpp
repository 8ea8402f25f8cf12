#include "gpu/shadow_planes/airlight_term.h"

#include <algorithm>
#include <cmath>

#include "gpu/shadow_planes/evaluator.h"
#include "methods/shadow_planes/paper_medium.h"
#include "methods/shadow_planes/phase_form.h"
#include "methods/shadow_planes/polynomial.h"

namespace airlight::gpu::shadow_planes {
namespace {

using airlight::shadow_planes::extinction_of;
using airlight::shadow_planes::Options;

// Numbers of a region, laid out as in media.glsl.
struct RegionNumbers {
  RegionKind kind;
  Vec3 lo = Vec3::Zero(), hi = Vec3::Zero();
};
RegionNumbers numbers(const scene::Region& region) {
  return scene::match(
      region, [](const scene::Unbounded&) { return RegionNumbers{RegionKind::unbounded}; },
      [](const Box& box) {
        return RegionNumbers{RegionKind::box, box.lo, box.hi};
      },
      [](const scene::Sphere& ball) {
        return RegionNumbers{RegionKind::sphere, ball.center, Vec3(ball.radius, 0, 0)};
      },
      [](const scene::Slab& slab) {
        return RegionNumbers{RegionKind::slab, slab.normal, Vec3(slab.lo, slab.hi, 0)};
      });
}

std::vector<MediumData> media_data(const scene::Scene& scene, bool printed) {
  std::vector<MediumData> data;
  for (const scene::Medium& medium : scene.media) {
    const airlight::shadow_planes::PhaseForm phase = airlight::shadow_planes::phase_form(medium.phase, printed);
    const RegionNumbers region = numbers(medium.region);
    MediumData d{
        {}, {}, {}, {}, int(phase.kind), float(phase.g), float(phase.scale), float(phase.width()), int(region.kind)};
    for (int i = 0; i < 3; ++i) {
      d.lo[i] = region.lo[i];
      d.hi[i] = region.hi[i];
      d.extinction[i] = float(extinction_of(medium)[i]);
      d.albedo[i] = float(medium.albedo[i]);
    }
    data.push_back(d);
  }
  data.resize(room_for_media(data.size()));  // as many as the block has
  return data;
}

}  // namespace

AirlightTermsOnDevice::AirlightTermsOnDevice(Context& context, const std::shared_ptr<const scene::Scene>& scene,
                                             const Options& options)
    : context_(context),
      scene_(scene),
      options_(options),
      grey_(std::all_of(scene->media.begin(), scene->media.end(),
                        [](const scene::Medium& m) { return (extinction_of(m) == extinction_of(m)[0]).all(); })),
      media_(context, "media", media_data(*scene, options.printed_phases)) {
  const auto whole = [](const scene::Medium& m) { return std::holds_alternative<scene::Unbounded>(m.region); };
  if (std::none_of(scene->media.begin(), scene->media.end(),
                   [](const scene::Medium& m) { return (extinction_of(m) > 0).any(); }))
    return;
  if (options.bounded == Options::Bounded::exact)
    airlight_terms_.push_back(make(0, scene->media.size() > 1 || !whole(scene->media.front()), false));
  else
    for (std::size_t i = 0; i < scene->media.size(); ++i)
      airlight_terms_.push_back(make(int(i), false, !whole(scene->media[i])));
}

AirlightTermsOnDevice::AirlightTerm AirlightTermsOnDevice::make(int medium, bool bounded, bool paper) const {
  AirlightTerm term;
  term.medium = medium;
  term.bounded = bounded;
  term.paper = paper;
  const scene::Medium& of = scene_->media[medium];
  if (paper) term.mean_distance = airlight::shadow_planes::mean_distance(of.region);
  std::vector<float> numbers;
  if (options_.evaluator == Options::Evaluator::rule) {
    numbers = rule_nodes(options_.nodes, options_.stretch, bounded);
  } else {
    const auto phase = airlight::shadow_planes::phase_form(of.phase, options_.printed_phases);
    const auto rows = options_.annex ? airlight::shadow_planes::printed_in_a(phase)
                                     : airlight::shadow_planes::coefficients_in_a(phase, options_.degree, paper);
    term.degree = int(rows.size()) - 1;
    for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
  }
  numbers.resize(4 * most_nodes);  // as many as the block has
  term.evaluator = std::make_unique<Buffer>(context_, "evaluator", numbers);
  return term;
}

const scene::Region* AirlightTermsOnDevice::region(int term) const {
  return airlight_terms_[term].paper ? &scene_->media[airlight_terms_[term].medium].region : nullptr;
}

std::map<std::string, std::string> AirlightTermsOnDevice::definitions(int light, int term) const {
  const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
  return {{"BOUNDED", flag(term >= 0 && airlight_terms_[term].bounded)},
          {"GREY", flag(grey_)},
          {"MOST_MEDIA", std::to_string(room_for_media(scene_->media.size()))},
          {"PAPER_MEDIUM", flag(term >= 0 && airlight_terms_[term].paper)},
          {"POLYNOMIAL", flag(options_.evaluator == Options::Evaluator::polynomial)},
          {"POWER", std::to_string(options_.stretch)},
          {"SPOT", flag(std::holds_alternative<scene::SpotLight>(scene_->lights[light]))}};
}

void AirlightTermsOnDevice::bind_media(LinkedProgram& program) const {
  media_.bind_as(GL_UNIFORM_BUFFER, at::media);
  program.set("media_count", int(scene_->media.size()));
}

void AirlightTermsOnDevice::bind(LinkedProgram& program, int index, int term) const {
  bind_media(program);
  const scene::Light& light = scene_->lights[index];
  program.set_double("light", scene::ball(light)->center);
  if (const auto* spot = std::get_if<scene::SpotLight>(&light)) {
    program.set_double("spot_axis", spot->axis);
    program.set_double("cos_inner", std::cos(spot->inner_angle));
    program.set_double("cos_outer", std::cos(spot->outer_angle));
  }
  if (term < 0) return;
  const AirlightTerm& of = airlight_terms_[term];
  of.evaluator->bind_as(GL_UNIFORM_BUFFER, at::evaluator);
  program.set("air_medium", of.medium);
  if (of.paper) program.set("mean_distance", of.mean_distance);
  if (options_.evaluator == Options::Evaluator::polynomial)
    program.set("degree", of.degree);
  else
    program.set("rule_nodes", options_.nodes);
}

}  // namespace airlight::gpu::shadow_planes
