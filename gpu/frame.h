// Buffers that a Prepared keeps on the device from frame to frame, so that a warm frame allocates
// nothing and waits once.
//
//   frame.begin(execution);                                   // a mutable gpu::Frame of the Prepared
//   Buffer& mean = frame.buffers.get("mean", 12 * pixels);
//   frame.timer.begin("distances"); ...                       // a stage until the next begins
//   frame.download.add("mean", mean, 12 * pixels);            // no more than a note, and none where it is not wanted
//   frame.finish(rendering);                                  // copies, waits, fills film, times and counters
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/timer.h"
#include "scene/renderer.h"

namespace airlight::gpu {

class FrameBuffers {
 public:
  explicit FrameBuffers(Context& context) : context_(context) {}

  // The buffer of that name, allocated where it is not there yet or has another size. Its contents are undefined: those of
  // the frame before, or where AIRLIGHT_GPU_POISON is set, NaN. Throws as Buffer does.
  Buffer& get(const std::string& name, std::size_t bytes);
  // For AIRLIGHT_GPU_POISON.
  void poison();

 private:
  Context& context_;
  std::map<std::string, std::unique_ptr<Buffer>> buffers_;
};

// Layers of a film, and what else the host must know of a frame, through one buffer that stays mapped.
class Download {
 public:
  explicit Download(Context& context) : context_(context) {}
  Download(const Download&) = delete;

  // Forgets what was added; `layers` as in scene::Execution.
  void begin(const std::optional<std::set<std::string>>& layers);
  bool wants(const std::string& layer) const { return !layers_ || layers_->count(layer) != 0; }
  // False: no layer is wanted, and nothing but a status comes down.
  bool wants_any() const { return !layers_ || !layers_->empty(); }
  bool empty() const { return parts_.empty(); }

  // The first `bytes` of a buffer, which must live until fetch(): a layer, if it is wanted.
  void add(const std::string& layer, const Buffer&, std::size_t bytes);
  // Adds values that are no layer (counters, marks). values() returns them after finish(), and nothing
  // if no layer is wanted.
  void add_values(const std::string& name, const Buffer&, std::size_t bytes);
  // Adds a status that says whether a frame is right. It is downloaded even if no layer is wanted.
  void add_status(const std::string& name, const Buffer&, std::size_t bytes);

  // Frame::finish: the copies are told to the device; after a wait they are taken to the film.
  void copy();
  void fetch(scene::Film&);
  template <class T>
  std::vector<T> values(const std::string& name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) return {};
    std::vector<T> result(found->second.size() / sizeof(T));
    std::memcpy(result.data(), found->second.data(), result.size() * sizeof(T));
    return result;
  }

 private:
  struct Part {
    std::string name;
    const Buffer* buffer;
    std::size_t bytes;
    bool layer;
  };
  void reserve(std::size_t bytes);

  Context& context_;
  std::optional<std::set<std::string>> layers_;
  std::vector<Part> parts_;
  std::map<std::string, std::vector<char>> values_;
  Handle id_;
  std::size_t bytes_ = 0;
  const char* mapped_ = nullptr;
};

// Processor time of each stage of the last finished frame, without the wait: for tests and profiles. It is no counter,
// since counters are equal in every run. Under Use.
std::vector<scene::StageTime>& host_times_of_last_frame();

class Frame {
 public:
  explicit Frame(Context& context) : buffers(context), timer(context), download(context), context_(context) {}

  void begin(const scene::Execution&);
  // Ends the last stage, downloads what is wanted (stage "download", left out where nothing is) and waits once. Gives the
  // rendering its layers, times, and the traffic since begin() among its counters. Throws Error if the driver objected.
  void finish(scene::Rendering&);

  FrameBuffers buffers;
  StageTimer timer;
  Download download;

 private:
  Context& context_;
  Traffic before_;
};

}  // namespace airlight::gpu
