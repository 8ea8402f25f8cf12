#include "gpu/egl.h"

#include <EGL/eglext.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include "scene/base/error.h"

namespace airlight::gpu {

struct Egl::Functions {
  decltype(&eglGetProcAddress) get_proc_address = nullptr;
  decltype(&eglQueryString) query_string = nullptr;
  decltype(&eglGetError) get_error = nullptr;
  decltype(&eglInitialize) initialize = nullptr;
  decltype(&eglTerminate) terminate = nullptr;
  decltype(&eglBindAPI) bind_api = nullptr;
  decltype(&eglCreateContext) create_context = nullptr;
  decltype(&eglDestroyContext) destroy_context = nullptr;
  decltype(&eglMakeCurrent) make_current = nullptr;
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = nullptr;
  PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string = nullptr;
};

namespace {

bool contains_word(const char* list, const std::string& word) {
  return list && (" " + std::string(list) + " ").find(" " + word + " ") != std::string::npos;
}

}  // namespace

const Egl& Egl::get() {
  static const Egl egl;
  return egl;
}

Egl::Egl() : f_(std::make_shared<Functions>()) {
  void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library) throw NoDevice("gpu: libEGL.so.1 is not installed: CPU only");
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
    if (!function) throw NoDevice(fmt::format("gpu: libEGL.so.1 lacks {}: CPU only", name));
  };
  load(f_->get_proc_address, "eglGetProcAddress");
  load(f_->query_string, "eglQueryString");
  load(f_->get_error, "eglGetError");
  load(f_->initialize, "eglInitialize");
  load(f_->terminate, "eglTerminate");
  load(f_->bind_api, "eglBindAPI");
  load(f_->create_context, "eglCreateContext");
  load(f_->destroy_context, "eglDestroyContext");
  load(f_->make_current, "eglMakeCurrent");
  const auto extension = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(f_->get_proc_address(name));
  };
  extension(f_->get_platform_display, "eglGetPlatformDisplayEXT");
  extension(f_->query_devices, "eglQueryDevicesEXT");
  extension(f_->query_device_string, "eglQueryDeviceStringEXT");
  if (!f_->get_platform_display || !has_client("EGL_EXT_platform_base"))
    throw NoDevice("gpu: libEGL.so.1 finds no driver (it offers no platform): CPU only");
}

std::string Egl::error() const {
  const EGLint code = f_->get_error();
  static const char* const names[] = {"EGL_SUCCESS",       "EGL_NOT_INITIALIZED",     "EGL_BAD_ACCESS",
                                      "EGL_BAD_ALLOC",     "EGL_BAD_ATTRIBUTE",       "EGL_BAD_CONFIG",
                                      "EGL_BAD_CONTEXT",   "EGL_BAD_CURRENT_SURFACE", "EGL_BAD_DISPLAY",
                                      "EGL_BAD_MATCH",     "EGL_BAD_NATIVE_PIXMAP",   "EGL_BAD_NATIVE_WINDOW",
                                      "EGL_BAD_PARAMETER", "EGL_BAD_SURFACE",         "EGL_CONTEXT_LOST"};
  const int index = code - EGL_SUCCESS;
  return index >= 0 && index < 15 ? fmt::format("{} (0x{:04x})", names[index], code) : fmt::format("0x{:04x}", code);
}

bool Egl::has_client(const std::string& extension) const {
  return contains_word(f_->query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS), extension);
}

std::vector<Place> Egl::places() const {
  std::vector<Place> hardware, software;
  EGLDeviceEXT devices[32] = {};
  EGLint count = 0;
  if (f_->query_devices && f_->query_device_string && f_->query_devices(32, devices, &count))
    for (int i = 0; i < count; ++i) {
      const bool soft = contains_word(f_->query_device_string(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software");
      (soft ? software : hardware).push_back({fmt::format("device {}", i), soft, devices[i]});
    }
  std::vector<Place> all = hardware;
  if (has_client("EGL_MESA_platform_surfaceless")) all.push_back({"surfaceless", false, nullptr});
  all.insert(all.end(), software.begin(), software.end());
  return all;
}

std::unique_ptr<EglContext> Egl::make_context(const Place& place, bool debug) const {
  const auto fail = [&](const char* step) { throw Unavailable(fmt::format("{}: {}: {}", place.name, step, error())); };
  std::unique_ptr<EglContext> result(new EglContext(*this));
  result->display_ = f_->get_platform_display(place.device ? EGL_PLATFORM_DEVICE_EXT : EGL_PLATFORM_SURFACELESS_MESA,
                                              place.device, nullptr);
  if (result->display_ == EGL_NO_DISPLAY) fail("eglGetPlatformDisplayEXT");
  EGLint major = 0, minor = 0;
  if (!f_->initialize(result->display_, &major, &minor)) {
    result->display_ = EGL_NO_DISPLAY;
    fail("eglInitialize");
  }
  const char* offered = f_->query_string(result->display_, EGL_EXTENSIONS);
  for (const char* needed : {"EGL_KHR_no_config_context", "EGL_KHR_surfaceless_context"})
    if (!contains_word(offered, needed)) throw Unavailable(fmt::format("{}: no {}", place.name, needed));
  if (!f_->bind_api(EGL_OPENGL_API)) fail("eglBindAPI(EGL_OPENGL_API)");
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               5,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_CONTEXT_OPENGL_DEBUG,
                               debug ? EGL_TRUE : EGL_FALSE,
                               EGL_NONE};
  result->context_ = f_->create_context(result->display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (result->context_ == EGL_NO_CONTEXT) fail("eglCreateContext(OpenGL 4.5 core)");
  return result;
}

EglContext::~EglContext() {
  // The display stays initialised: others may share it.
  if (context_ != EGL_NO_CONTEXT) egl_.f_->destroy_context(display_, context_);
}

void EglContext::make_current() const {
  egl_.f_->bind_api(EGL_OPENGL_API);
  if (!egl_.f_->make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
    throw Unavailable("gpu: eglMakeCurrent: " + egl_.error());
}

void EglContext::release() const { egl_.f_->make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

void* EglContext::function(const char* name) const { return reinterpret_cast<void*>(egl_.f_->get_proc_address(name)); }

}  // namespace airlight::gpu
