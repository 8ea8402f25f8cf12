// Choice among the places that EGL offers: a user's wishes, and the requirements on a place.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "gpu/egl.h"
#include "gpu/gl.h"

namespace airlight::gpu {

// Wishes, in small letters: "auto" (the first that works), "none", the number of an EGL device ("1", or "device 1"),
// "surfaceless", or a part of GL_VENDOR or GL_RENDERER in any case.
std::string small_letters(std::string);
bool fits(const Attempt&, const std::string& wish);

// One line: no place fulfils the wish, and what there is.
std::string refusal(const std::vector<Attempt>&, const std::string& wish);

// The variable AIRLIGHT_GPU_DEBUG is set, and not to 0: contexts are debug contexts.
bool debug_wanted();

// Fetches the entry points of gl.h into `gl`. Returns the missing parts of the context, empty if there are none: entry
// points, or OpenGL 4.5. The context must be current. `function` is eglGetProcAddress, which may return functions that
// a driver does not have: therefore the version is checked as well.
std::string load_gl(const std::function<void*(const char*)>& function, Gl& gl);

}  // namespace airlight::gpu
