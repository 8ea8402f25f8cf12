// The OpenGL context that everything under gpu/ shares: chosen once, debug messages turned into errors.
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "gpu/egl.h"
#include "gpu/gl.h"
#include "gpu/traffic.h"

namespace airlight::gpu {

class Program;
class RasterProgram;

// Limits of the device for shaders; checked by users that need more than OpenGL's minimum.
struct Limits {
  std::size_t storage_block = 0;  // bytes of one storage buffer
  int storage_blocks = 0;         // in one compute shader; OpenGL promises 8
  int storage_bindings = 0;       // numbers of their bindings; likewise
  int groups[3] = {0, 0, 0};      // work groups of a dispatch
  int invocations = 0;            // of a work group
  int shared_memory = 0;          // bytes
  int texture_size_3d = 0, texture_size = 0;
  std::size_t memory = 0;                                      // bytes; 0: the driver does not tell
  int texture_units = 0;                                       // of a compute shader
  int vertex_storage_blocks = 0, fragment_storage_blocks = 0;  // OpenGL promises none; raster passes need some
};

class Context {
 public:
  // The context of this process, made on the first call: the first place that works, or the one asked for by
  // choose_device or the variable AIRLIGHT_GPU. Places that lack something are passed over. Throws Unavailable in one
  // line, which lists all places, if there is none.
  static Context& get();
  // Chooses a device in the syntax of device_choice.h; overrides the variable. Throws Error for an empty wish, and
  // after the first get(), when it is too late.
  static void choose_device(const std::string& wish);
  // description() of get(), or the line that says why there is none. Does not throw.
  static std::string name_of_device();
  // Whether a certain device was asked for, by choose_device or AIRLIGHT_GPU: then its absence is a failure, where it
  // otherwise is a reason to leave something out.
  static bool device_was_chosen();
  // Tries every place, for `airlight doctor`: what is there, and what each of the others lacks.
  static std::vector<Attempt> try_everything();

  // One line: renderer, version, place.
  std::string description() const;
  const std::string& renderer() const { return attempt_.renderer; }
  // Renderer, vendor and version of OpenGL, which contains the driver's: equal for equal devices with equal drivers.
  std::string driver() const;
  bool software() const;  // llvmpipe and its like: its times are not those of a GPU
  const Limits& limits() const { return limits_; }
  const Gl& gl() const { return gl_; }
  // All that this context has done so far. Under Use, as the calls that it counts.
  Traffic& traffic() { return traffic_; }

  // Throws Error with the driver's words if a call has failed since the last check, Unavailable if for want of memory.
  // `what` names the work done. Without a debug context drivers say little: the name of the error.
  void check(const std::string& what);
  // For calls of which a frame does many: checks with a debug context only; the frame's end checks in any case.
  void check_closely(const std::string& what) {
    if (debugging_) check(what);
  }
  // The driver translates OpenGL for Vulkan (Mesa's zink). It makes a pipeline when a program first runs, and where that fails it
  // runs nothing and reports no error. LinkedProgram::watch finds that.
  bool makes_pipelines_late() const { return renderer().rfind("zink", 0) == 0; }
  // For those who tell the failure in words of their own.
  void forget_errors();
  // Until the device has done all it was told.
  void wait();

  // The variable AIRLIGHT_GPU_DEBUG is set: a debug context, whose driver explains every error at once.
  bool debugging() const { return debugging_; }
  // Names for debuggers; nothing without a debug context.
  void label(GLenum kind, GLuint id, const std::string& name);
  void begin_group(const std::string& name);
  void end_group();

  // Compute programs by file name and definitions, compiled once (program.h). Each call is a look-up.
  Program& program(const std::string& file, const std::map<std::string, std::string>& definitions = {});
  // Raster programs from gpu/<name>.vert and gpu/<name>.frag, compiled once (raster_program.h).
  RasterProgram& raster_program(const std::string& name, const std::map<std::string, std::string>& definitions = {});

  Context(const Context&) = delete;

 private:
  friend class Use;
  Context(Attempt, std::unique_ptr<EglContext>);
  static Attempt attempt(const Place&, std::unique_ptr<EglContext>&);

  Attempt attempt_;
  std::unique_ptr<EglContext> egl_;
  Gl gl_;
  Limits limits_;
  Traffic traffic_;
  bool debugging_ = false;
  std::vector<std::string> errors_;
  std::map<std::string, std::unique_ptr<Program>> programs_;
  std::map<std::string, std::unique_ptr<RasterProgram>> raster_programs_;
  std::recursive_mutex mutex_;
  int depth_ = 0;
};

// Makes the shared context current on this thread while it lives; others wait.
class Use {
 public:
  explicit Use(Context&);
  ~Use();
  Use(const Use&) = delete;
  Context& context;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
};

// Owns a GL object: deleted with this, also where a constructor throws after making it.
class Handle {
 public:
  using Delete = void (*)(const Gl&, GLuint);
  Handle() = default;
  Handle(Context& context, GLuint id, Delete remove) : context_(&context), id_(id), remove_(remove) {}
  Handle(Handle&& other) noexcept { *this = std::move(other); }
  Handle& operator=(Handle&& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(id_, other.id_);
    std::swap(remove_, other.remove_);
    return *this;
  }
  ~Handle() {
    if (!id_) return;
    const Use use(*context_);
    remove_(context_->gl(), id_);
  }
  operator GLuint() const { return id_; }

 private:
  Context* context_ = nullptr;
  GLuint id_ = 0;
  Delete remove_ = nullptr;
};

}  // namespace airlight::gpu
