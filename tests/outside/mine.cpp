// The program airlight with a method of one's own. It ignores the surfaces and marches with equal steps, without shadows of the fog.
#include "experiments/application/renderers.h"
#include "experiments/cli/program.h"
#include "scene/picture.h"

namespace {
using namespace airlight;
using namespace airlight::scene;

class PreparedMine final : public Prepared {
 public:
  PreparedMine(std::shared_ptr<const Scene> scene, int steps) : scene_(std::move(scene)), steps_(steps) {}
  std::vector<Stage> stages() const override { return {{"march", true, "steps through the media"}}; }
  Rendering render(const View& view, const Execution& execution) const override {
    Rendering result{Film(view.width, view.height), {}, {}};
    const PictureLayers layers(result.film, {});
    draw_pixels<long long>(view, execution, layers, [&](const Ray& ray, long long&) {
      Pixel pixel;
      const double end = camera_end(*scene_, ray).t;
      pixel.transmittance = transmittance(scene_->media, ray, {0, end});
      for (const Medium& medium : scene_->media) {
        const Interval inside = extent(medium, ray, {0, end});
        for (int i = 0; i < steps_ && !inside.empty(); ++i) {
          const double dt = inside.length() / steps_, t = inside.lo + (i + 0.5) * dt;
          const Point3 x = ray.origin + t * ray.direction;
          for (const Light& light : scene_->lights) {
            const Incident in = incident(light, x);
            pixel.airlight += dt * medium.albedo * medium.sigma_t * density(medium, x) * in.irradiance *
                              phase_value(medium.phase, in.to_light.dot(ray.direction)) *
                              transmittance(scene_->media, ray, {0, t});
          }
        }
      }
      return pixel;
    });
    return result;
  }

 private:
  std::shared_ptr<const Scene> scene_;
  int steps_;
};

class Mine final : public Renderer {
 public:
  std::string name() const override { return "mine"; }
  std::string about() const override { return "equal steps, no shadows, light scattered once"; }
  std::vector<SettingSpec> settings() const override {
    return {integer_setting("steps", "32", 1, 4096, "steps of a camera ray in each medium")};
  }
  std::vector<std::string> supports(const Scene& scene, const Settings&) const override {
    for (const Medium& medium : scene.media)
      if (!bounding_box(medium).size().allFinite()) return {"a medium has no end"};
    return {};
  }

 private:
  std::unique_ptr<Prepared> prepare_supported(std::shared_ptr<const Scene> scene, const Settings& settings,
                                              const Execution&) const override {
    return std::make_unique<PreparedMine>(std::move(scene), int(settings.integer("steps")));
  }
};

}  // namespace

int main(int argc, char** argv) {
  const airlight::experiments::AddedRenderer added(std::make_unique<Mine>());
  return airlight::experiments::cli::run(argc, argv);
}
