#include "gpu/context.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdlib>

#include "gpu/device_choice.h"
#include "gpu/program.h"
#include "gpu/raster_program.h"
#include "scene/base/error.h"

namespace airlight::gpu {
namespace {

std::string& wish() {
  static std::string text = [] {
    const char* variable = std::getenv("AIRLIGHT_GPU");
    return small_letters(variable && *variable ? variable : "auto");
  }();
  return text;
}

std::atomic<bool> is_made{false};

void APIENTRY on_message(GLenum, GLenum type, GLuint, GLenum, GLsizei length, const GLchar* text, const void* user) {
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) return;
  auto& errors = *static_cast<std::vector<std::string>*>(const_cast<void*>(user));
  if (errors.size() < 8) errors.emplace_back(text, length < 0 ? std::char_traits<char>::length(text) : length);
}

std::string name_of_error(GLenum code) {
  switch (code) {
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_CONTEXT_LOST:
      return "GL_CONTEXT_LOST";
    default:
      return fmt::format("error {:#x}", code);
  }
}

std::string key_of(std::string file, const std::map<std::string, std::string>& definitions) {
  for (const auto& [name, value] : definitions) file += fmt::format(" {}={}", name, value);
  return file;
}

}  // namespace

void Context::choose_device(const std::string& name) {
  if (name.empty()) throw Error("gpu: no name of a device; expected a number, a part of a name, surfaceless or none");
  if (is_made) throw Error("gpu: another device is in use already");
  wish() = small_letters(name);
}

std::string Context::name_of_device() {
  try {
    return get().description();
  } catch (const NoDevice& reason) {
    return reason.what();
  }
}

bool Context::device_was_chosen() { return wish() != "auto" && wish() != "none"; }

// Whatever goes wrong is in the answer's failure.
Attempt Context::attempt(const Place& place, std::unique_ptr<EglContext>& context) {
  Attempt result{place, {}, {}, {}, {}};
  try {
    context = Egl::get().make_context(place, debug_wanted());
    context->make_current();
    const auto get_string = reinterpret_cast<PFNGLGETSTRINGPROC>(context->function("glGetString"));
    const auto text = [&](GLenum name) {
      const GLubyte* s = get_string ? get_string(name) : nullptr;
      return std::string(s ? reinterpret_cast<const char*>(s) : "");
    };
    result.renderer = text(GL_RENDERER);
    result.vendor = text(GL_VENDOR);
    result.version = text(GL_VERSION);
    for (const char* soft : {"llvmpipe", "softpipe", "swrast"})
      result.place.software = result.place.software || result.renderer.find(soft) != std::string::npos;
    Gl gl;
    const std::string objection = load_gl([&](const char* name) { return context->function(name); }, gl);
    context->release();
    if (result.renderer.empty())
      result.failure = place.name + ": the driver tells no GL_RENDERER";
    else if (!objection.empty())
      result.failure = fmt::format("{}: {} {}", place.name, result.renderer, objection);
    if (!result.failure.empty()) {
      result.renderer.clear();
      context.reset();
    }
  } catch (const Error& error) {
    result.failure = error.what();
    result.renderer.clear();
    context.reset();
  }
  return result;
}

std::vector<Attempt> Context::try_everything() {
  std::vector<Attempt> attempts;
  for (const Place& place : Egl::get().places()) {
    std::unique_ptr<EglContext> context;
    attempts.push_back(attempt(place, context));
  }
  return attempts;
}

Context& Context::get() {
  // Never destroyed: drivers may be gone when the process ends.
  static Context* const context = [] {
    std::vector<Attempt> attempts;
    if (wish() == "none") throw NoDevice(refusal(attempts, wish()));
    for (const Place& place : Egl::get().places()) {
      std::unique_ptr<EglContext> egl;
      attempts.push_back(attempt(place, egl));
      if (!attempts.back().failure.empty() || !fits(attempts.back(), wish())) continue;
      auto* made = new Context(attempts.back(), std::move(egl));
      is_made = true;
      return made;
    }
    throw NoDevice(refusal(attempts, wish()));
  }();
  return *context;
}

Context::Context(Attempt attempt, std::unique_ptr<EglContext> egl)
    : attempt_(std::move(attempt)), egl_(std::move(egl)) {
  egl_->make_current();
  load_gl([&](const char* name) { return egl_->function(name); }, gl_);  // what it lacks, attempt() has told
  // Before messages are errors: where GL_NVX_gpu_memory_info is missing this is one, and the memory stays unknown.
  constexpr GLenum dedicated_memory = 0x9047;  // [KiB]
  GLint kibibytes = 0;
  gl_.GetIntegerv(dedicated_memory, &kibibytes);
  if (gl_.GetError() == GL_NO_ERROR) limits_.memory = std::size_t(std::max(0, kibibytes)) << 10;
  debugging_ = debug_wanted();
  if (debugging_) {
    gl_.Enable(GL_DEBUG_OUTPUT);
    gl_.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    gl_.DebugMessageCallback(on_message, &errors_);
  }
  GLint64 bytes = 0;
  gl_.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
  limits_.storage_block = std::size_t(bytes);
  gl_.GetIntegerv(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS, &limits_.storage_blocks);
  gl_.GetIntegerv(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS, &limits_.storage_bindings);
  for (GLuint axis = 0; axis < 3; ++axis)
    gl_.GetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, axis, &limits_.groups[axis]);
  gl_.GetIntegerv(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS, &limits_.invocations);
  gl_.GetIntegerv(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE, &limits_.shared_memory);
  gl_.GetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &limits_.texture_size_3d);
  gl_.GetIntegerv(GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS, &limits_.texture_units);
  gl_.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limits_.texture_size);
  gl_.GetIntegerv(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, &limits_.vertex_storage_blocks);
  gl_.GetIntegerv(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS, &limits_.fragment_storage_blocks);
  egl_->release();
}

std::string Context::description() const {
  return fmt::format("{}, OpenGL {} ({}{})", attempt_.renderer, attempt_.version, attempt_.place.name,
                     software() ? "; a processor, no GPU" : "");
}

std::string Context::driver() const {
  return fmt::format("{}, {}, OpenGL {}", attempt_.renderer, attempt_.vendor, attempt_.version);
}

bool Context::software() const { return attempt_.place.software; }

void Context::check(const std::string& what) {
  const GLenum code = gl_.GetError();
  if (code == GL_NO_ERROR && errors_.empty()) return;
  const std::string words = errors_.empty() ? name_of_error(code) : errors_.front();
  forget_errors();
  if (code == GL_OUT_OF_MEMORY) throw Unavailable(fmt::format("gpu: {}: {} is out of memory", what, attempt_.renderer));
  throw Error(fmt::format("gpu: {} failed on {}: {}", what, attempt_.renderer, words));
}

// A lost context answers GL_CONTEXT_LOST for ever.
void Context::forget_errors() {
  for (int i = 0; i < 8 && gl_.GetError() != GL_NO_ERROR; ++i) {
  }
  errors_.clear();
}

void Context::wait() {
  const Use use(*this);
  ++traffic_.syncs;
  const GLsync fence = gl_.FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  while (gl_.ClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, 1'000'000'000) == GL_TIMEOUT_EXPIRED) {
  }
  gl_.DeleteSync(fence);
  check("waiting for the device");
}

void Context::label(GLenum kind, GLuint id, const std::string& name) {
  if (debugging_) gl_.ObjectLabel(kind, id, GLsizei(name.size()), name.c_str());
}

void Context::begin_group(const std::string& name) {
  if (debugging_) gl_.PushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, GLsizei(name.size()), name.c_str());
}

void Context::end_group() {
  if (debugging_) gl_.PopDebugGroup();
}

Program& Context::program(const std::string& file, const std::map<std::string, std::string>& definitions) {
  ++traffic_.program_look_ups;
  auto& program = programs_[key_of(file, definitions)];
  if (!program) program = std::make_unique<Program>(*this, file, definitions);
  return *program;
}

RasterProgram& Context::raster_program(const std::string& name, const std::map<std::string, std::string>& definitions) {
  ++traffic_.program_look_ups;
  auto& program = raster_programs_[key_of(name, definitions)];
  if (!program) program = std::make_unique<RasterProgram>(*this, name, definitions);
  return *program;
}

Use::Use(Context& shared) : context(shared), lock_(shared.mutex_) {
  if (context.depth_ == 0) context.egl_->make_current();
  ++context.depth_;
}

Use::~Use() {
  if (--context.depth_ == 0) context.egl_->release();
}

}  // namespace airlight::gpu
