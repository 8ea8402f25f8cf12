// Displays without a screen: every EGL device, and Mesa's surfaceless platform, as places to make a context.
//
// Never the default display: without a window system it fails, and with one it would be the user's screen.
#pragma once
#include <EGL/egl.h>

#include <memory>
#include <string>
#include <vector>

namespace airlight::gpu {

class Egl;

// A place where a context may be made.
struct Place {
  std::string name;        // "device 0", "surfaceless"
  bool software = false;   // a software renderer, as far as EGL says before a context exists
  void* device = nullptr;  // EGLDeviceEXT; null: surfaceless
};

// The context that was made there, or the reason for its absence.
struct Attempt {
  Place place;
  std::string renderer, vendor, version;  // GL_RENDERER, GL_VENDOR, GL_VERSION
  std::string failure;                    // empty: it works
};

// A display with an OpenGL 4.5 core context; destroyed with the object.
class EglContext {
 public:
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  // Makes the context current on this thread, or none. Throws Error with EGL's error.
  void make_current() const;
  void release() const;
  void* function(const char* name) const;  // eglGetProcAddress

 private:
  friend class Egl;
  EglContext(const Egl& egl) : egl_(egl) {}
  const Egl& egl_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

// The library, loaded once and never unloaded (drivers do not unload cleanly).
class Egl {
 public:
  // Throws Unavailable in one line: no libEGL, or no entry points in it.
  static const Egl& get();

  // In the order in which they should be tried: hardware devices, surfaceless, software devices. May be empty.
  std::vector<Place> places() const;

  // Throws Unavailable that names the step which failed and EGL's error.
  std::unique_ptr<EglContext> make_context(const Place&, bool debug) const;

 private:
  friend class EglContext;
  Egl();
  std::string error() const;
  bool has_client(const std::string& extension) const;

  struct Functions;
  std::shared_ptr<Functions> f_;
};

}  // namespace airlight::gpu
