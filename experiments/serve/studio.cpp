#include "experiments/serve/studio.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "experiments/application/flow_pictures.h"
#include "experiments/application/interrupt.h"
#include "scene/base/error.h"

namespace airlight::experiments::serve {
namespace {

constexpr std::size_t most_panes = 8, most_references = 2, most_scenes = 8, most_waiting = 64, most_clients = 64;
constexpr auto silence = std::chrono::seconds(6);        // after which a reference stops
constexpr auto long_silence = std::chrono::seconds(30);  // after which frames stop, too

}  // namespace

struct Studio::Job {
  FrameRequest request;
  View view;
  Clock::time_point asked = Clock::now();
  std::atomic<bool> stop{false};
  std::atomic<double> fraction{0};
  bool done = false;
  std::optional<Frame> frame;
  std::exception_ptr error;

  bool is_of(const FrameRequest& other) const { return request.client == other.client && request.pane == other.pane; }
};

struct Studio::Client {
  Clock::time_point seen = Clock::now();
  bool watches = false;                 // it has asked for a reference, as pages do all the time
  int entered = 0;                      // how many times it watches
  bool moves = false;                   // its last frame shows something else than its reference
  std::map<std::string, Frame> frames;  // the last of each pane

  std::shared_ptr<const scene::Scene> scene;  // of the reference that it wants; null: none
  int width = 0, height = 0;
  bool all_orders = true;
  ReferenceState state;
  std::vector<unsigned char> left_out;
  Clock::time_point grown{};  // when its reference last got samples
  // Errors of these two, so that they are not computed again.
  std::map<std::string, std::pair<std::shared_ptr<const scene::Film>, long long>> judged;
};

Studio::Studio(std::vector<std::string> files, int threads, const std::optional<FlowChoice>& flow)
    : files_(std::move(files)),
      threads_(threads),
      flow_(flow ? std::make_unique<LiveFlow>(*flow, threads) : nullptr),
      thread_([this] { work(); }) {}

Studio::~Studio() {
  stop();
  thread_.join();
}

void Studio::stop() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  yield_ = true;
  if (running_) running_->stop = true;
  for (const auto& job : queue_) job->done = true;
  queue_.clear();
  wake_.notify_all();
  done_.notify_all();
}

const SceneSource& Studio::source(int scene) {
  const std::lock_guard lock(sources_mutex_);
  auto& source = sources_[scene];
  if (!source) source = std::make_unique<SceneSource>(files_.at(std::size_t(scene)));
  return *source;
}

LiveFlow& Studio::flow() {
  if (!flow_) throw Error("there is no flow here: start the server with --flow FLOW.toml");
  return *flow_;
}

Studio::View Studio::view(const SceneRequest& request) {
  std::string key = std::to_string(request.scene);
  for (const auto& [path, text] : request.values) key += "\n" + path + "=" + text;
  const auto scene = kept(key, [&] { return source(request.scene).with(request.values); });
  if (!flow_) return {scene, {}};
  const auto smoke = flow_->smoke();
  key += fmt::format("\nsmoke {}", smoke->number);
  return {kept(key, [&] { return scene_with_smoke(*scene, smoke->density); }), smoke->time};
}

std::shared_ptr<const scene::Scene> Studio::kept(const std::string& key,
                                                 const std::function<std::shared_ptr<const scene::Scene>()>& make) {
  {
    const std::lock_guard lock(sources_mutex_);
    for (auto at = scenes_.begin(); at != scenes_.end(); ++at)
      if (at->first == key) {
        scenes_.splice(scenes_.begin(), scenes_, at);
        return at->second;
      }
  }
  auto scene = make();
  const std::lock_guard lock(sources_mutex_);
  scenes_.emplace_front(key, scene);
  if (scenes_.size() > most_scenes) scenes_.pop_back();
  return scene;
}

Studio::Client& Studio::client(const std::string& name) {
  auto& found = clients_[name];
  if (!found) {
    found = std::make_shared<Client>();
    if (clients_.size() > most_clients) {
      const auto oldest = std::min_element(clients_.begin(), clients_.end(), [](const auto& a, const auto& b) {
        return a.second->seen < b.second->seen;
      });
      left_.push_back(oldest->first);
      clients_.erase(oldest);
    }
  }
  found->seen = Clock::now();
  return *found;
}

std::optional<Frame> Studio::frame(const FrameRequest& request) {
  const auto job = std::make_shared<Job>();
  job->request = request;
  job->view = view(request);
  std::unique_lock lock(mutex_);
  if (stopping_ || has_left(request.client)) return std::nullopt;
  Client& asking = client(request.client);
  asking.moves = asking.scene && asking.scene->hash != job->view.scene->hash;
  if (running_ && running_->is_of(request)) running_->stop = true;
  const auto older = std::find_if(queue_.begin(), queue_.end(), [&](const auto& j) { return j->is_of(request); });
  if (older != queue_.end()) {
    (*older)->done = true;
    job->asked = (*older)->asked;  // keeps its place in the queue
    *older = job;
  } else {
    if (queue_.size() >= most_waiting) throw Error(fmt::format("{} frames are waiting, expected fewer", queue_.size()));
    queue_.push_back(job);
  }
  yield_ = true;
  wake_.notify_all();
  done_.notify_all();
  done_.wait(lock, [&] { return job->done; });
  if (job->error) std::rethrow_exception(job->error);
  return std::move(job->frame);
}

ReferenceState Studio::reference(const ReferenceRequest& request) {
  const auto wanted = scene(request);
  std::unique_lock lock(mutex_);
  if (has_left(request.client)) {
    ReferenceState nothing;
    nothing.missing = "the page has left";
    return nothing;
  }
  Client& asking = client(request.client);
  asking.watches = true;
  asking.moves = false;
  if (!asking.scene || asking.scene->hash != wanted->hash || asking.width != request.width ||
      asking.height != request.height || asking.all_orders != request.all_orders) {
    asking.scene = wanted;
    asking.width = request.width;
    asking.height = request.height;
    asking.all_orders = request.all_orders;
    asking.left_out = scene::ball_mask(*wanted, {wanted->camera, request.width, request.height});
    asking.state = {};
    asking.state.missing = "it has no samples yet";
    asking.state.growing = true;
    asking.judged.clear();
    yield_ = true;
  }
  wake_.notify_all();
  ReferenceState state = asking.state;
  if (running_ && running_->request.client == request.client) state.progress = running_->fraction;
  const auto frames = asking.frames;
  auto judged = asking.judged;
  const auto left_out = asking.left_out;
  lock.unlock();
  if (state.film) {
    bool changed = false;
    for (const auto& [pane, frame] : frames) {
      const auto of = std::pair(frame.film, state.number);
      if (const auto before = judged.find(pane); before != judged.end() && before->second == of) continue;
      state.errors[pane] = error_of(frame, *wanted, *state.film, state.samples, left_out);
      judged[pane] = of;
      changed = true;
    }
    if (changed) {
      const std::lock_guard again(mutex_);
      if (const auto there = clients_.find(request.client);
          there != clients_.end() && there->second->scene == wanted && there->second->state.number == state.number) {
        there->second->state.errors = state.errors;
        there->second->judged = judged;
      }
    }
  }
  if (state.number == request.known) state.film = nullptr;
  return state;
}

void Studio::enter(const std::string& name) {
  const std::lock_guard lock(mutex_);
  std::erase(gone_, name);
  ++client(name).entered;
  if (flow_) flow_->watched(true);
}

void Studio::exit(const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto of = clients_.find(name);
  if (of == clients_.end() || of->second->entered == 0 || --of->second->entered > 0) return;
  let_go(name);
}

// Under the mutex.
void Studio::let_go(const std::string& name) {
  forget(name);
  gone_.push_back(name);
  if (gone_.size() > 4 * most_clients) gone_.pop_front();
  wake_.notify_all();
  done_.notify_all();
}

// Under the mutex.
bool Studio::has_left(const std::string& name) const {
  return std::find(gone_.begin(), gone_.end(), name) != gone_.end();
}

void Studio::leave(const std::string& name) {
  const std::lock_guard lock(mutex_);
  let_go(name);
}

// Under the mutex.
void Studio::forget(const std::string& name) {
  if (running_ && running_->request.client == name) running_->stop = true;
  std::erase_if(queue_, [&](const auto& job) {
    if (job->request.client != name) return false;
    job->done = true;
    return true;
  });
  if (clients_.erase(name) == 0) return;
  left_.push_back(name);
  yield_ = true;
  if (flow_)
    flow_->watched(std::any_of(clients_.begin(), clients_.end(), [](const auto& c) { return c.second->entered > 0; }));
}

bool Studio::is_silent(const Client& client) const { return client.watches && Clock::now() - client.seen > silence; }

// Under the mutex.
std::string Studio::next_reference() const {
  std::string name;
  Clock::time_point longest = Clock::time_point::max();
  for (const auto& [of, client] : clients_)
    if (client->scene && client->state.growing && !client->moves && !is_silent(*client) && client->grown < longest) {
      name = of;
      longest = client->grown;
    }
  return name;
}

scene::Execution Studio::execution(const std::atomic<bool>& stop, std::atomic<double>* fraction) const {
  return {threads_, [this, &stop, fraction](double done) {
            if (fraction) *fraction = done;
            return !stop && !stopping_ && !interrupted();
          }};
}

// Under the mutex. The frame that will be done first if each began when it was asked for: a fast method does not wait for a slow one beside
// it, and a slow one is not put off for ever.
std::shared_ptr<Studio::Job> Studio::take_next() {
  const auto end = [&](const std::shared_ptr<Job>& job) {
    double seconds = 0;
    if (const auto of = clients_.find(job->request.client); of != clients_.end())
      if (const auto last = of->second->frames.find(job->request.pane); last != of->second->frames.end())
        seconds = last->second.seconds;
    return job->asked + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  };
  const auto next =
      std::min_element(queue_.begin(), queue_.end(), [&](const auto& a, const auto& b) { return end(a) < end(b); });
  std::shared_ptr<Job> job = *next;
  queue_.erase(next);
  return job;
}

void Studio::work() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    std::string growing;
    wake_.wait_for(lock, std::chrono::seconds(1), [&] {
      return stopping_ || !queue_.empty() || !left_.empty() || !(growing = next_reference()).empty();
    });
    if (stopping_) break;
    std::vector<std::string> silent;
    for (const auto& [name, client] : clients_)
      if (client->watches && Clock::now() - client->seen > long_silence) silent.push_back(name);
    for (const std::string& name : silent) forget(name);
    for (const std::string& name : std::exchange(left_, {})) {
      std::erase_if(panes_, [&](const auto& pane) { return pane.first.starts_with(name + " "); });
      std::erase_if(references_, [&](const auto& reference) { return reference.first == name; });
    }
    if (!queue_.empty()) {
      running_ = take_next();
      lock.unlock();
      render(*running_);
      lock.lock();
      if (const auto of = clients_.find(running_->request.client); of != clients_.end() && running_->frame)
        of->second->frames[running_->request.pane] = *running_->frame;
      running_->done = true;
      running_.reset();
      done_.notify_all();
    } else if (!growing.empty() && clients_.count(growing)) {
      yield_ = false;
      grow(growing);
    }
  }
  for (const auto& job : queue_) job->done = true;
  done_.notify_all();
  panes_.clear();
  references_.clear();
}

Pane& Studio::pane(const Job& job) {
  const std::string name = job.request.client + " " + job.request.pane;
  const auto found = std::find_if(panes_.begin(), panes_.end(), [&](const auto& pane) { return pane.first == name; });
  if (found == panes_.end())
    panes_.emplace_front(name, Pane());
  else
    panes_.splice(panes_.begin(), panes_, found);
  while (panes_.size() > most_panes) panes_.pop_back();
  return panes_.front().second;
}

void Studio::render(Job& job) {
  const double waited = std::chrono::duration<double>(Clock::now() - job.asked).count();
  try {
    job.frame = pane(job).render(job.request, job.view.scene, execution(job.stop, &job.fraction));
    job.frame->waited = waited;
    job.frame->smoke_time = job.view.smoke_time;
  } catch (const scene::Interrupted&) {
  } catch (...) {
    job.error = std::current_exception();
  }
  // A picture that nobody waits for; a renderer that keeps what it has ends in this way, too.
  if (job.stop) job.frame.reset();
}

// Called, and returns, under the mutex.
void Studio::grow(const std::string& name) {
  const auto of = clients_.at(name);
  const auto scene = of->scene;
  const int width = of->width, height = of->height;
  const bool all_orders = of->all_orders;
  ReferenceState state = of->state;
  mutex_.unlock();
  try {
    auto found = std::find_if(references_.begin(), references_.end(), [&](const auto& r) { return r.first == name; });
    if (found != references_.end() && !found->second.is_of(*scene, width, height, all_orders)) {
      references_.erase(found);
      found = references_.end();
    }
    if (found == references_.end()) {
      references_.emplace_front(name, LiveReference(scene, width, height, all_orders));
      while (references_.size() > most_references) references_.pop_back();
    } else {
      references_.splice(references_.begin(), references_, found);
    }
    LiveReference& reference = references_.front().second;
    // Pictures come often at first. What interrupts it does not wait for a picture.
    const double slice = std::clamp(0.5 * reference.seconds(), 1.0, 5.0);
    reference.advance(execution(yield_, nullptr), slice);
    if (yield_) {
      mutex_.lock();
      return;
    }
    state.film = reference.film();
    state.samples = reference.samples();
    state.about = reference.about();
    state.growing = !reference.complete();
    state.missing.clear();
    ++state.number;
  } catch (const scene::NotSupported& error) {
    state.missing = error.reason;
    state.growing = false;
  } catch (const std::exception& error) {
    state.missing = error.what();
    state.growing = false;
  }
  mutex_.lock();
  of->grown = Clock::now();
  if (of->scene != scene || of->width != width || of->height != height || of->all_orders != all_orders) return;
  state.errors = of->state.errors;
  of->state = state;
}

}  // namespace airlight::experiments::serve
