#include "experiments/serve/live_flow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "experiments/application/solvers.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"
#include "scene/base/stopwatch.h"
#include "scene/load/overrides.h"
#include "scene/load/parse_toml.h"
#include "scene/load/ranges.h"

namespace airlight::experiments::serve {
namespace {

constexpr std::size_t most_strokes = 1000, most_steps_timed = 30;
constexpr double most_acceleration = 1e6, least_acceleration = 1e-12;  // that a flow file can say [m/s^2]

const scene::Solver& solver_of(const FlowChoice& choice) {
  const scene::Solver& solver = find_solver(choice.method, "--method");
  if (!solver.device().empty())
    throw Error(fmt::format("--method {}: a flow in the browser is simulated on the processor, expected {}",
                            choice.method, "stable_fluids or legendre_fluids"));
  return solver;
}

double median_step(std::deque<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Goes on where the other ends, and both together are still a short way.
bool continues(const Stroke& last, const Stroke& next) {
  return last.to == next.from && last.radius == next.radius && last.speed == next.speed &&
         (next.to - last.from).norm() <= 2 * next.radius;
}

std::string toml_list(const Vec3& v) { return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]); }

std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) || std::strchr("_./=:-", c) != nullptr;
  });
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

}  // namespace

LiveFlow::LiveFlow(const FlowChoice& choice, int threads)
    : choice_(choice),
      problem_(std::make_shared<const scene::FlowProblem>(scene::load_flow(choice.file, choice.overrides))),
      solver_(solver_of(choice)),
      settings_(solver_.settings(), choice.settings, choice.method),
      steps_(frame_steps(*problem_, solver_, settings_)) {
  execution_.threads = threads;
  flow_ = solver_.start(problem_, settings_, execution_);
  state_.playing = true;
  keep_smoke();
  thread_ = std::thread([this] { work(); });
}

LiveFlow::~LiveFlow() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void LiveFlow::watched(bool yes) {
  const std::lock_guard lock(mutex_);
  watched_ = yes;
  wake_.notify_all();
}

FlowState LiveFlow::state(long long known, std::chrono::milliseconds most) const {
  Lock lock(mutex_);
  moved_.wait_for(lock, most, [&] { return state_.number != known || stopping_; });
  return state_;
}

std::shared_ptr<const Smoke> LiveFlow::smoke() const {
  const std::lock_guard lock(mutex_);
  return smoke_;
}

void LiveFlow::order(FlowOrder order) {
  const std::lock_guard lock(mutex_);
  const bool anew = order == FlowOrder::reset || order == FlowOrder::replay;
  if (order == FlowOrder::play) next_ = Clock::now();
  if (order == FlowOrder::play || order == FlowOrder::pause) state_.playing = order == FlowOrder::play;
  if (order == FlowOrder::step) {
    state_.playing = false;
    one_step_ = true;
  }
  if (anew) {
    start_ = true;
    waiting_.clear();
  }
  if (order == FlowOrder::reset) strokes_.clear();
  wake_.notify_all();
}

void LiveFlow::set_pace(double pace) {
  const std::lock_guard lock(mutex_);
  state_.pace = pace;
  next_ = Clock::now();
  wake_.notify_all();
}

void LiveFlow::stir(const Stroke& stroke) {
  const double longest = problem_->box.size().maxCoeff();
  if (!(stroke.radius >= longest / 50 && stroke.radius <= longest))
    throw Error(
        fmt::format("a stroke of radius {:g} m, expected {:g} to {:g} m", stroke.radius, longest / 50, longest));
  if (const double most = most_acceleration * steps_.dt; !(stroke.speed > 0 && stroke.speed <= most))
    throw Error(fmt::format("a stroke of {:g} m/s, expected more than 0 and at most {:g}", stroke.speed, most));
  for (const Point3& end : {stroke.from, stroke.to})
    if (!((end - problem_->box.lo).minCoeff() >= -longest && (problem_->box.hi - end).minCoeff() >= -longest))
      throw Error("a stroke far from the box of the flow, expected one within it");
  Stroke drawn = stroke;
  if (problem_->dimensions == 2) drawn.from[2] = drawn.to[2] = 0;
  const std::lock_guard lock(mutex_);
  if (!waiting_.empty() && continues(waiting_.back(), drawn)) {
    waiting_.back().to = drawn.to;
    return;
  }
  if (strokes_.size() + waiting_.size() >= most_strokes)
    throw Error(fmt::format("the flow has {} strokes, expected fewer: reset it", most_strokes));
  waiting_.push_back(drawn);
}

// Under the mutex.
std::vector<scene::Push> LiveFlow::pushes_now(double time) {
  std::vector<scene::Push> pushes;
  for (const Stroke& stroke : std::exchange(waiting_, {})) {
    const Vec3 way = stroke.to - stroke.from;
    if (way.isZero(0)) continue;
    scene::Push push;
    push.region = scene::Sphere{0.5 * (stroke.from + stroke.to), stroke.radius};
    push.time = {time, time + steps_.dt};
    if (intersect(scene::bounding_box(push.region), problem_->box).empty()) continue;
    push.acceleration = stroke.speed / (2 * stroke.radius * steps_.dt) * way;
    for (double& part : push.acceleration)
      if (std::abs(part) < least_acceleration) part = 0;
    pushes.push_back(push);
  }
  return pushes;
}

// Under the mutex.
void LiveFlow::keep_smoke() {
  state_.time = flow_->time();
  ++state_.number;
  smoke_ = std::make_shared<const Smoke>(Smoke{state_.number, state_.time, flow_->medium()});
  moved_.notify_all();
}

// Under the mutex.
void LiveFlow::fail(const std::string& message) {
  state_.message = message;
  state_.playing = false;
  broken_ = true;
  moved_.notify_all();
}

void LiveFlow::work() {
  Lock lock(mutex_);
  while (!stopping_) {
    const bool plays = state_.playing && watched_ && !broken_;
    if (start_)
      start(lock);
    else if ((one_step_ && !broken_) || (plays && Clock::now() >= next_))
      advance(lock);
    else if (plays)
      wake_.wait_until(lock, next_);
    else
      wake_.wait(lock);
  }
}

void LiveFlow::start(Lock& lock) {
  start_ = one_step_ = broken_ = false;
  const std::vector<scene::Push> strokes = strokes_;
  lock.unlock();
  auto problem = std::make_shared<scene::FlowProblem>(*problem_);
  problem->pushes.insert(problem->pushes.end(), strokes.begin(), strokes.end());
  flow_.reset();
  std::string message;
  try {
    flow_ = solver_.start(problem, settings_, execution_);
  } catch (const std::exception& error) {
    message = error.what();
  }
  lock.lock();
  if (!flow_) return fail(message);
  state_.message.clear();
  state_.steps = 0;
  state_.strokes = strokes_.size();
  next_ = Clock::now();
  keep_smoke();
}

void LiveFlow::advance(Lock& lock) {
  one_step_ = false;
  const std::vector<scene::Push> pushes = pushes_now(state_.time);
  lock.unlock();
  std::string refused, stopped;
  std::vector<scene::Push> added;
  scene::Stopwatch watch;
  for (const scene::Push& push : pushes) try {
      flow_->add(push);
      added.push_back(push);
    } catch (const Error& error) {
      refused = error.what();
    }
  try {
    flow_->step(steps_.dt);
  } catch (const std::exception& error) {
    stopped = error.what();
  }
  const double seconds = watch.lap();
  lock.lock();
  if (start_) return;  // meanwhile somebody asked for the start
  strokes_.insert(strokes_.end(), added.begin(), added.end());
  state_.strokes = strokes_.size();
  if (!stopped.empty()) return fail(stopped);
  state_.message = refused;
  ++state_.steps;
  last_seconds_.push_back(seconds);
  if (last_seconds_.size() > most_steps_timed) last_seconds_.pop_front();
  state_.step_seconds = median_step(last_seconds_);
  const auto now = Clock::now();
  next_ = state_.pace > 0 ? std::max(now, next_ + std::chrono::duration_cast<Clock::duration>(
                                                      std::chrono::duration<double>(steps_.dt / state_.pace)))
                          : now;
  keep_smoke();
}

std::string LiveFlow::script(const std::string& scene_file) const {
  Lock lock(mutex_);
  const std::vector<scene::Push> strokes = strokes_;
  const double time = state_.time;
  lock.unlock();
  toml::table root =
      scene::load::parse_toml(scene::read_whole_file(choice_.file, scene::load::most_toml_bytes), choice_.file);
  scene::Overrides overrides = choice_.overrides;
  // To the end of the frame that is seen.
  const double frames = std::max(1.0, std::ceil(time * problem_->frame_rate - 1e-6));
  overrides["flow.duration"] = fmt::format("{}", frames / problem_->frame_rate);
  scene::load::apply_overrides(root, overrides, choice_.file);
  std::string command = "airlight simulate stirred.toml --method " + choice_.method;
  for (const auto& [name, value] : choice_.settings) command += " --set " + shell_word(name + "=" + value);
  std::ostringstream out;
  out << "# " << scene::printable(choice_.file) << " with " << strokes.size()
      << " strokes of `airlight serve`. Keep it in the folder of that file as stirred.toml, and run there:\n#   "
      << scene::printable(command + " --out frames") << "\n# To draw every frame, add: --scene "
      << scene::printable(shell_word(scene_file)) << "\n"
      << root << "\n";
  for (const scene::Push& push : strokes) {
    const auto& ball = std::get<scene::Sphere>(push.region);
    out << fmt::format(
        "[[force]]\nregion = {{ type = \"sphere\", center = {}, radius = {} }}\nfrom = {}\nto = {}\n"
        "acceleration = {}\n",
        toml_list(ball.center), ball.radius, push.time.lo, push.time.hi, toml_list(push.acceleration));
  }
  return out.str();
}

}  // namespace airlight::experiments::serve
