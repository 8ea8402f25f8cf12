// All that is rendered for browsers: one thread, a queue of frames, and references that get samples while the queue is empty.
//
// A newer request of a client's pane takes the place of an older one, which is dropped, or stopped where it is being rendered. Panes keep
// their preparations from frame to frame. A client that leaves, or that is silent for a while after it has asked for a reference, leaves
// nothing running.
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
  Studio(std::vector<std::string> files, int threads);
  ~Studio();

  int scenes() const { return int(files_.size()); }
  const std::vector<std::string>& files() const { return files_; }
  // Throws Error where the file cannot be read.
  const SceneSource& source(int scene);
  // The scene with its changed values; the last few are kept.
  std::shared_ptr<const scene::Scene> scene(const SceneRequest&);

  // Waits for the frame. Nothing where it was dropped: a newer one was asked for, the client left, or the program ends. Throws Error.
  std::optional<Frame> frame(const FrameRequest&);
  ReferenceState reference(const ReferenceRequest&);
  void leave(const std::string& client);
  // Drops all frames, and takes no more.
  void stop();

 private:
  struct Job;
  struct Client;
  using Clock = std::chrono::steady_clock;

  void work();
  std::shared_ptr<Job> take_next();
  void render(Job&);
  void grow(const std::string& client);
  Pane& pane(const Job&);
  void forget(const std::string& client);
  Client& client(const std::string& name);
  std::string next_reference() const;  // the client whose reference waits longest; empty: none
  bool is_silent(const Client&) const;
  scene::Execution execution(const std::atomic<bool>& stop, std::atomic<double>* fraction) const;

  std::vector<std::string> files_;
  int threads_;

  std::mutex sources_mutex_;
  std::map<int, std::unique_ptr<SceneSource>> sources_;
  std::list<std::pair<std::string, std::shared_ptr<const scene::Scene>>> scenes_;  // newest first

  std::mutex mutex_;  // of all below
  std::condition_variable wake_, done_;
  std::deque<std::shared_ptr<Job>> queue_;
  std::shared_ptr<Job> running_;
  std::map<std::string, std::shared_ptr<Client>> clients_;
  std::vector<std::string> left_;  // clients whose panes and references the thread throws away
  std::atomic<bool> stopping_{false};
  std::atomic<bool> yield_{false};  // the reference stops for something else

  // The thread's own.
  std::list<std::pair<std::string, Pane>> panes_;  // by client and pane, newest first
  std::list<std::pair<std::string, LiveReference>> references_;

  std::thread thread_;
};

}  // namespace airlight::experiments::serve
