// Which of the places that EGL offers is used: what a user may ask for, and what a place must have.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "gpu/egl.h"
#include "gpu/gl.h"

namespace airlight::gpu {

// What may be asked for, in small letters: "auto" (the first that works), "none", the number of an EGL device ("1", the
// same as "device 1"), "surfaceless", or a part of GL_VENDOR or GL_RENDERER, there in any case.
std::string small_letters(std::string);
bool fits(const Attempt&, const std::string& wish);

// One line: no place fulfils the wish, and what there is.
std::string refusal(const std::vector<Attempt>&, const std::string& wish);

// The variable AIRLIGHT_GPU_DEBUG is set, and not to 0: contexts are debug contexts.
bool debug_wanted();

// Fetches the entry points of gl.h into `gl`. What a context lacks, empty if nothing: entry points, or OpenGL 4.5. It
// must be current. `function` is eglGetProcAddress, which may answer for functions that a driver has not: so the
// version is asked for as well.
std::string load_gl(const std::function<void*(const char*)>& function, Gl& gl);

}  // namespace airlight::gpu
