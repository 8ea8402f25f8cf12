#include "experiments/driver/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiments/application/build_info.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/machine.h"
#include "experiments/application/renderers.h"
#include "experiments/driver/committed_references.h"
#include "experiments/driver/reference_cache.h"
#include "gpu/shader_source.h"
#include "scene/base/content_key.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

std::string program() {
  std::vector<std::string> parts{source_id(), compiler()};
  for (const auto& [name, number] : libraries()) parts.push_back(name + " " + number);
  return content_key(parts);
}

}  // namespace

Row row_of(const SceneCase& c, const MethodCase& m, const scene::Settings& settings, const std::string& scene_hash) {
  Row row;
  row.scene = c.name;
  row.method = m.name;
  row.setting = m.setting;
  row.renderer = m.renderer;
  row.settings = settings.canonical();
  row.layer = m.layer;
  row.parameter = c.parameter;
  row.scene_hash = scene_hash;
  return row;
}

void set_keys(const Experiment& e, const MethodCase& m, const scene::Component& component, Row& row) {
  std::vector<std::string> parts{program(),    row.scene_hash, row.scene, row.method,        row.setting,
                                 row.renderer, row.settings,   row.layer, row.reference_key, e.layer};
  parts.insert(parts.end(), e.metrics.begin(), e.metrics.end());
  parts.push_back(fmt::format("{} {} {}", m.picture_only, m.count_noise, m.moving ? canonical(*m.moving) : ""));
  if (m.anew) parts.push_back("anew");
  if (const std::string code = added_code(component.name()); !code.empty()) parts.push_back(code);
  for (const Moving::What what : e.moves) parts.push_back(name_of(what));
  const std::string device = component.device();
  parts.push_back(device);
  if (!device.empty()) parts.push_back(gpu::foreign_shaders());
  row.figures_key = content_key(parts);
  // Times are those of a machine; bits, too, may depend on the widest instructions.
  const Machine machine = this_machine();
  const TimingRule& rule = e.timing;
  row.key = content_key({row.figures_key, fmt::format("{}, {}, {} threads", machine.cpu, machine.simd, machine.threads),
                         fmt::format("{} {} {} {}", rule.runs, rule.least_seconds, rule.budget, rule.threads)});
}

namespace {

// Converted media of a scene, each converted once.
class Conversions {
 public:
  Conversions(std::shared_ptr<const scene::Scene> scene, const Experiment& e, const scene::ContentStore& store)
      : scene_(std::move(scene)), execution_(quiet_execution(e.timing.threads)) {
    execution_.store = &store;
  }

  // Throws NotSupported where media cannot be converted so.
  std::shared_ptr<const scene::Scene> of(const MethodCase& m, Row& row) {
    if (!m.convert) return scene_;
    auto& made = made_[canonical(*m.convert)];
    if (!made) {
      try {
        made = std::make_shared<const scene::ConvertedScene>(
            convert_media(*scene_, *m.convert, execution_, reference_id()));
      } catch (const scene::NotSupported&) {
        throw;
      } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", m.position, error.what()), error.exit_code());
      }
    }
    for (const scene::ConvertedMedium& medium : made->media) {
      row.counters["numbers"] += double(medium.numbers);
      row.counters["conversion_seconds"] += medium.seconds;
      row.counters["density_error"] = std::max(row.counters["density_error"], medium.density_error);
    }
    return {made, &made->scene};
  }

 private:
  std::shared_ptr<const scene::Scene> scene_;
  scene::Execution execution_;
  std::map<std::string, std::shared_ptr<const scene::ConvertedScene>> made_;
};

}  // namespace

namespace {

PlannedScene plan_reference(const Experiment& e, const SceneCase& c, std::shared_ptr<const scene::Scene> scene) {
  PlannedScene planned;
  planned.scene = std::move(scene);
  const ReferenceCase& reference = reference_of(e, c);
  if (reference.renderer.empty()) return planned;
  planned.reference = &find_renderer(reference.renderer, "reference");
  planned.reference_settings.emplace(planned.reference->settings(), reference.settings, "reference");
  if (!reference.committed.empty())
    planned.committed =
        committed_file(reference.committed, *planned.scene, *planned.reference, *planned.reference_settings, e.layer);
  return planned;
}

}  // namespace

PlannedScene plan_reference(const Experiment& e, const SceneCase& c) {
  return plan_reference(e, c, std::make_shared<const scene::Scene>(scene::load_scene(c.file.string(), c.overrides)));
}

std::string reference_key(const PlannedScene& planned) {
  return reference_key(*planned.scene, *planned.reference, *planned.reference_settings, planned.committed);
}

bool is_there(const PlannedScene& planned, const scene::ContentStore& store) {
  return is_committed(planned.committed) || store.find("references/" + reference_key(planned) + ".exr");
}

PlannedScene plan_scene(const Experiment& e, const SceneCase& c, const scene::ContentStore& store) {
  return plan_scene(e, c, std::make_shared<const scene::Scene>(scene::load_scene(c.file.string(), c.overrides)), store);
}

PlannedScene plan_scene(const Experiment& e, const SceneCase& c, std::shared_ptr<const scene::Scene> loaded,
                        const scene::ContentStore& store) {
  PlannedScene planned = plan_reference(e, c, std::move(loaded));
  const scene::Scene& scene = *planned.scene;
  std::string reference;
  if (planned.reference)
    reference = reference_key(scene, *planned.reference, *planned.reference_settings, planned.committed);
  Conversions conversions(planned.scene, e, store);
  for (const MethodCase& m : e.methods) {
    if (!is_on(m, c)) continue;
    const scene::Renderer& renderer = find_renderer(m.renderer, m.name);
    PlannedRow p{&m, &renderer, scene::Settings(renderer.settings(), m.settings, m.name), planned.scene, "", {}};
    Row converted;
    try {
      p.scene = conversions.of(m, converted);
    } catch (const scene::NotSupported& objection) {
      p.refused = objection.reason;
    }
    p.row = row_of(c, m, p.settings, p.scene->hash);
    p.row.counters = converted.counters;
    p.row.width = scene.width;
    p.row.height = scene.height;
    p.row.reference_key = reference;
    set_keys(e, m, renderer, p.row);
    planned.rows.push_back(std::move(p));
  }
  return planned;
}

std::vector<unsigned char> foreground_of(const scene::Scene& scene, const scene::View& view) {
  std::vector<unsigned char> mask(std::size_t(view.width) * std::size_t(view.height), 0);
  scene::parallel_for(view.height, quiet_execution(0), [&](int y) {
    for (int x = 0; x < view.width; ++x) {
      const Ray ray = scene::camera_ray(view.camera, x + 0.5, y + 0.5, view.width, view.height);
      const Rgb t = scene::transmittance(scene.media, ray, {0, scene::camera_end(scene, ray).t});
      mask[std::size_t(y) * std::size_t(view.width) + std::size_t(x)] = (1 - t > 1e-3).any();
    }
  });
  return mask;
}

}  // namespace airlight::experiments
