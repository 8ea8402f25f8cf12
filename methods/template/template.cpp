// A method to copy: a march with a fixed number of steps and exact shadows, light scattered once. The README beside it says what to change.
#include "methods/template/template.h"

#include "scene/picture.h"

namespace airlight::template_method {
namespace {
using namespace airlight::scene;

class PreparedTemplate final : public Prepared {
 public:
  PreparedTemplate(std::shared_ptr<const Scene> scene, const Settings& settings)
      : scene_(std::move(scene)), steps_(int(settings.integer("steps"))) {}

  // For `airlight explain`: what is computed in this scene, or left out, and why.
  std::vector<Stage> stages() const override {
    return {{"march", !scene_->media.empty(), "steps through the media"},
            {"surfaces", scene_->geometry != nullptr, "surfaces, lit through the media"}};
  }

  // Any work that several frames can share belongs into the constructor; this is one frame.
  Rendering render(const View& view, const Execution& execution) const override {
    Rendering result{Film(view.width, view.height), {}, {}};
    const PictureLayers layers(result.film, {});
    const auto samples = draw_pixels<long long>(view, execution, layers, [&](const Ray& ray, long long& sampled) {
      const RayEnd end = camera_end(*scene_, ray);
      Pixel pixel;
      pixel.transmittance = transmittance(scene_->media, ray, {0, end.t});
      pixel.surface =
          pixel.transmittance * end_radiance(*scene_, ray, end, scene_->lights, [&](const Incident& in, int) {
            return transmittance(scene_->media, {end.hit->position, in.to_light}, {0, in.distance});
          });
      for (const Medium& medium : scene_->media) pixel.airlight += airlight(medium, ray, end.t);
      sampled += steps_ * long(scene_->media.size());
      return pixel;
    });
    result.counters = {{"steps", double(samples)}};
    return result;
  }

 private:
  // Light that a medium scatters towards the viewer: the midpoint rule over the part of the ray inside it.
  Rgb airlight(const Medium& medium, const Ray& ray, double end) const {
    const Interval inside = extent(medium, ray, {0, end});
    if (inside.empty()) return Rgb::Zero();
    const double dt = inside.length() / steps_;
    Rgb sum = Rgb::Zero();
    for (int i = 0; i < steps_; ++i) {
      const double t = inside.lo + (i + 0.5) * dt;
      const Point3 x = ray.origin + t * ray.direction;
      const Rgb scattering = medium.albedo * medium.sigma_t * density(medium, x);
      sum += scattering * transmittance(scene_->media, ray, {0, t}) * light_from_lights(medium, x, ray.direction) * dt;
    }
    return sum;
  }

  // What the lights send to x, times the phase function: radiance over scattering coefficient.
  Rgb light_from_lights(const Medium& medium, const Point3& x, const Vec3& view_direction) const {
    Rgb sum = Rgb::Zero();
    for (const Light& light : scene_->lights) {
      const Incident in = incident(light, x);
      const Ray shadow{x, in.to_light};
      if (scene_->geometry && scene_->geometry->occluded(shadow, in.distance)) continue;
      const double phase = phase_value(medium.phase, in.to_light.dot(view_direction));
      sum += phase * in.irradiance * transmittance(scene_->media, shadow, {0, in.distance});
    }
    return sum;
  }

  std::shared_ptr<const Scene> scene_;
  int steps_;
};

class Template final : public Renderer {
 public:
  std::string name() const override { return "template"; }
  std::string about() const override { return "a method to copy: equal steps, exact shadows, light scattered once"; }
  std::vector<SettingSpec> settings() const override {
    return {integer_setting("steps", "32", 1, 4096, "steps of a camera ray in each medium")};
  }
  // A method says what it cannot do, so that no picture is silently wrong.
  std::vector<std::string> supports(const Scene& scene, const Settings&) const override {
    std::vector<std::string> reasons;
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
      if (!is_delta(scene.lights[i])) reasons.push_back("light " + std::to_string(i) + " is an environment");
    for (std::size_t i = 0; i < scene.media.size(); ++i)
      if (!bounding_box(scene.media[i]).size().allFinite()) reasons.push_back(label(scene.media, i) + " has no end");
    return reasons;
  }

 private:
  std::unique_ptr<Prepared> prepare_supported(std::shared_ptr<const Scene> scene, const Settings& settings,
                                              const Execution&) const override {
    return std::make_unique<PreparedTemplate>(std::move(scene), settings);
  }
};

}  // namespace

std::unique_ptr<Renderer> make_renderer() { return std::make_unique<Template>(); }
}  // namespace airlight::template_method
