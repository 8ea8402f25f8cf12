// All that is rendered for browsers: one thread, a queue of frames, and references that get samples while the queue is empty.
//
// A newer request of a client's pane takes the place of an older one, which is dropped, or stopped where it is being rendered. Panes keep
// their preparations from frame to frame. A client that leaves, or that is silent for a while after it has asked for a reference, leaves
// nothing running.
//
// With a flow, every scene shows its smoke of now, and the flow plays while some client watches (enter()).
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "experiments/serve/live_flow.h"
#include "experiments/serve/live_reference.h"
#include "experiments/serve/pane.h"
#include "experiments/serve/requests.h"
#include "experiments/serve/scene_source.h"

namespace airlight::experiments::serve {

// A reference as a browser sees it.
struct ReferenceState {
  std::string missing;  // why there is none: the tracer refuses the scene, or has no samples yet
  std::string about;
  std::shared_ptr<const scene::Film> film;  // null if the browser knows it already, or there is none
  long long number = -1;                    // of the picture
  std::uint64_t samples = 0;                // of every pixel, at least
  bool growing = false;                     // there will be more samples
  std::map<std::string, LiveError> errors;  // by pane
  double progress = -1;                     // of the frame that is being rendered for this client; -1: none
};

class Studio {
 public:
  // Scenes are read when they are first asked for.
  Studio(std::vector<std::string> files, int threads, const std::optional<FlowChoice>& = {});
  ~Studio();

  int scenes() const { return int(files_.size()); }
  const std::vector<std::string>& files() const { return files_; }
  // Throws Error where the file cannot be read.
  const SceneSource& source(int scene);
  // The scene with its changed values, and with the smoke of now; the last few are kept.
  std::shared_ptr<const scene::Scene> scene(const SceneRequest& request) { return view(request).scene; }
  bool has_flow() const { return bool(flow_); }
  // Throws Error where there is none.
  LiveFlow& flow();

  // Waits for the frame. Nothing where it was dropped: a newer one was asked for, the client left, or the program ends. Throws Error.
  std::optional<Frame> frame(const FrameRequest&);
  ReferenceState reference(const ReferenceRequest&);
  // A client watches from enter() to exit(), as many times as it likes; after the last exit() it has left. What a client that has left
  // still asks for is dropped until it enters again: such requests were on their way when it went.
  void enter(const std::string& client);
  void exit(const std::string& client);
  void leave(const std::string& client);
  // Drops all frames, and takes no more.
  void stop();
  bool stopped() const { return stopping_; }

 private:
  struct View {
    std::shared_ptr<const scene::Scene> scene;
    std::optional<double> smoke_time;
  };
  struct Job;
  struct Client;
  using Clock = std::chrono::steady_clock;

  View view(const SceneRequest&);
  std::shared_ptr<const scene::Scene> kept(const std::string& key,
                                           const std::function<std::shared_ptr<const scene::Scene>()>& make);
  void work();
  std::shared_ptr<Job> take_next();
  void render(Job&);
  void grow(const std::string& client);
  Pane& pane(const Job&);
  void forget(const std::string& client);
  void let_go(const std::string& client);
  bool has_left(const std::string& client) const;
  Client& client(const std::string& name);
  std::string next_reference() const;  // the client whose reference waits longest; empty: none
  bool is_silent(const Client&) const;
  scene::Execution execution(const std::atomic<bool>& stop, std::atomic<double>* fraction) const;

  std::vector<std::string> files_;
  int threads_;
  std::unique_ptr<LiveFlow> flow_;

  std::mutex sources_mutex_;
  std::map<int, std::unique_ptr<SceneSource>> sources_;
  std::list<std::pair<std::string, std::shared_ptr<const scene::Scene>>> scenes_;  // newest first

  std::mutex mutex_;  // of all below
  std::condition_variable wake_, done_;
  std::deque<std::shared_ptr<Job>> queue_;
  std::shared_ptr<Job> running_;
  std::map<std::string, std::shared_ptr<Client>> clients_;
  std::vector<std::string> left_;  // clients whose panes and references the thread throws away
  std::deque<std::string> gone_;   // the last clients that left
  std::atomic<bool> stopping_{false};
  std::atomic<bool> yield_{false};  // the reference stops for something else

  // The thread's own.
  std::list<std::pair<std::string, Pane>> panes_;  // by client and pane, newest first
  std::list<std::pair<std::string, LiveReference>> references_;

  std::thread thread_;
};

}  // namespace airlight::experiments::serve
