#include "experiments/legendre_fluids/frame_probe.h"

#include <fmt/format.h>

#include <map>

#include "gpu/legendre_fluids/legendre_fluids.h"
#include "gpu/legendre_fluids/light.h"
#include "methods/legendre_fluids/legendre_fluids.h"
#include "methods/legendre_fluids/light.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/flow/flow_particles.h"
#include "scene/flow/particles.h"
#include "scene/media/legendre_box.h"
#include "scene/scene.h"

namespace airlight::experiments {
namespace {

constexpr double dt = 1. / 24;  // [s]
const Box box{Point3::Constant(-1), Point3::Constant(1)};
const std::vector<std::string> stages = {"step", "particles", "flakes", "prepare", "picture"};

// Smoke that rises in a swirl; nowhere below 0.
std::shared_ptr<const scene::FlowProblem> rising_smoke(int particles) {
  auto problem = std::make_shared<scene::FlowProblem>();
  problem->name = "rising smoke";
  problem->box = box;
  problem->velocity = scene::Swirl{0.5};
  problem->gravity = Vec3(0, -9.81, 0);
  problem->expansion = 1.0 / 300;
  problem->density = 0.5;
  problem->blobs.push_back({Point3(0.2, -0.3, 0.1), 0.6, 1, 30});
  problem->particles.push_back({particles, {}, 1, Vec3::Zero(), scene::ParticleSet::Leaving::stay});
  return problem;
}

scene::Scene lit_smoke(int width, int height, bool orthographic) {
  scene::Scene scene;
  scene.name = "rising smoke";
  scene::Medium smoke;
  smoke.sigma_t = Rgb::Constant(0.75);
  smoke.albedo = Rgb::Constant(0.8);
  scene.media = {smoke};
  scene.lights = {scene::DirectionalLight{Vec3(-0.48, -0.6, 0.64), Rgb::Ones()}};
  scene.camera = scene::look_at(Point3(-1.2, 1.6, 3.4), Point3::Zero(), Vec3::UnitY());
  scene.camera.vertical_fov = 0.8;
  if (orthographic) {
    scene.camera.kind = scene::Camera::Kind::orthographic;
    scene.camera.height = 3.3;  // what the other sees at the box
  }
  scene.width = width;
  scene.height = height;
  return scene;
}

// One after the other, in ms.
class Clock {
 public:
  void lap(const std::string& stage) { now_[stage] += 1e3 * watch_.lap(); }
  void end_frame() {
    double sum = 0;
    for (const std::string& stage : stages) {
      all[stage].push_back(now_[stage]);
      sum += now_[stage];
    }
    all["frame"].push_back(sum);
    now_.clear();
  }
  std::map<std::string, std::vector<double>> all;

 private:
  scene::Stopwatch watch_;
  std::map<std::string, double> now_;
};

// Time of the stages that solve linear systems for light.
double seconds_of_systems(const std::vector<scene::StageTime>& times) {
  double sum = 0;
  for (const scene::StageTime& time : times)
    if (time.name.ends_with("systems")) sum += time.seconds;
  return sum;
}

Findings findings_of(Clock& clock, std::size_t pixels, std::size_t particles) {
  Findings found;
  found.figures.push_back(measured("ms_frame", clock.all["frame"]));
  for (const std::string& stage : stages) found.figures.push_back(measured("ms_" + stage, clock.all[stage]));
  found.figures.push_back(measured("ms_systems", clock.all["systems"]));
  std::vector<double> seconds = clock.all["frame"], rate;
  for (double& x : seconds) rate.push_back(1e3 / x), x *= 1e-3;
  found.figures.push_back(measured("frames_per_second", rate));
  found.counters = {{"pixels", double(pixels)}, {"particles", double(particles)}};
  set_time(found, seconds);
  return found;
}

Findings frames_of(const scene::Solver& solver, const scene::Renderer& renderer, const scene::Settings& s,
                   scene::Execution execution) {
  const int n = int(s.integer("n"));
  const auto problem = rising_smoke(int(s.integer("particles")));
  const std::string& variant = s.text("variant");
  const auto of_variant = variant == "paper" ? std::pair("closure", s.text("closure"))
                                             : std::pair("tolerance", fmt::format("{}", s.real("tolerance")));
  const scene::Settings of_solver(solver.settings(), {{"n", std::to_string(n)}}),
      of_renderer(renderer.settings(), {{"variant", variant}, of_variant});
  const auto flow = solver.start(problem, of_solver, execution);
  scene::FlowParticles particles(*problem);
  const bool rides = particles.ride(*flow);
  std::unique_ptr<scene::Flow> before;
  if (!rides) before = solver.start(problem, of_solver, execution);
  const scene::Scene smoke =
      lit_smoke(int(s.integer("width")), int(s.integer("height")), s.text("camera") == "orthographic");
  scene::Particles flakes;
  flakes.radius = 0.008;
  flakes.radiances = {Rgb::Constant(0.5)};
  execution.layers.emplace();  // for a screen: nothing comes back from a device
  const auto unit =
      std::make_shared<const scene::LegendreBox>(box, scene::TensorShape{n, n, n}, Eigen::VectorXd::Unit(n * n * n, 0));
  Clock clock;
  std::size_t drawn = 0;
  const int frames = int(s.integer("frames"));
  for (int frame = 0; frame <= frames; ++frame) {
    Clock warm_up;
    Clock& now = frame > 0 ? clock : warm_up;
    now.lap("start");
    if (before) before->restore(flow->state());
    now.lap("particles");
    flow->step(dt);
    now.lap("step");
    rides ? particles.step(dt) : particles.step(*before, *flow, dt, execution);
    flakes.positions = particles.positions().front();
    now.lap("particles");
    const auto scene = std::make_shared<scene::Scene>(smoke);
    scene->backdrops.push_back(
        std::make_shared<scene::Backdrop>(scene::draw(flakes, scene->camera, scene->width, scene->height)));
    now.lap("flakes");
    // If the density stays on the device, it replaces this placeholder.
    scene->media[0].field = rides ? scene::DensityField(unit) : flow->medium();
    finish(*scene);
    const auto picture = renderer.prepare(scene, of_renderer, execution);
    const bool there = gpu::legendre_fluids::draw_flow(*picture, *flow);
    if (rides && !there) throw Error("the picture does not take the flow's density");
    now.lap("prepare");
    const scene::Rendering rendering = picture->render(view_of(*scene), execution);
    drawn = std::size_t(scene->width) * std::size_t(scene->height);
    now.lap("picture");
    now.all["systems"].push_back(1e3 *
                                 (seconds_of_systems(picture->prepare_times()) + seconds_of_systems(rendering.times)));
    if (frame > 0) clock.end_frame();
  }
  return findings_of(clock, drawn, flakes.positions.size());
}

}  // namespace

std::string LegendreFrame::about() const {
  return "time of a frame by stages: a step of the fluid, particles, a picture of its smoke with them in it";
}

std::vector<scene::SettingSpec> LegendreFrame::settings() const {
  return {scene::integer_setting("n", "6", 2, 16, "coefficients along an axis"),
          scene::integer_setting("particles", "3000", 1, 1000000, "that it carries, drawn as discs"),
          scene::integer_setting("width", "800", 4, 4096, "of the film, pixels"),
          scene::integer_setting("height", "600", 4, 4096, "of the film, pixels"),
          scene::choice_setting("camera", "perspective", {"perspective", "orthographic"}, "that sees the box"),
          scene::choice_setting("variant", "ray", {"ray", "paper"}, "of the light"),
          scene::choice_setting("closure", "least_squares", {"least_squares", "upwind"}, "of paper"),
          scene::real_setting("tolerance", "1e-5", 1e-12, 0.1, "of the light"),
          scene::integer_setting("frames", "5", 1, 10000, "that are timed, after one that is not")};
}

std::vector<std::string> LegendreFrame::figures() const {
  std::vector<std::string> names = {"ms_frame"};
  for (const std::string& stage : stages) names.push_back("ms_" + stage);
  names.push_back("ms_systems");
  names.push_back("frames_per_second");
  return names;
}

Findings LegendreFrame::run(const ProbeInput&, const scene::Settings& s, const scene::Execution& execution) const {
  return frames_of(legendre_fluids::LegendreFluids(), legendre_fluids::LegendreLight(), s, execution);
}

Findings LegendreFrameGpu::run(const ProbeInput&, const scene::Settings& s, const scene::Execution& execution) const {
  gpu::Context::get();  // throws Unavailable where there is none
  return frames_of(gpu::legendre_fluids::LegendreFluids(), gpu::legendre_fluids::LegendreLight(), s, execution);
}

}  // namespace airlight::experiments
