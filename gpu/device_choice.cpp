#include "gpu/device_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

namespace airlight::gpu {
namespace {

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

std::string small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool fits(const Attempt& attempt, const std::string& wanted) {
  if (wanted == "none") return false;
  if (wanted == "auto") return true;
  // A number is never a part of a name: "4" would be found in many.
  if (is_number(wanted)) return attempt.place.name == "device " + wanted;
  return attempt.place.name == wanted || small_letters(attempt.vendor).find(wanted) != std::string::npos ||
         small_letters(attempt.renderer).find(wanted) != std::string::npos;
}

bool debug_wanted() {
  const char* variable = std::getenv("AIRLIGHT_GPU_DEBUG");
  return variable && *variable && std::string(variable) != "0";
}

std::string refusal(const std::vector<Attempt>& attempts, const std::string& wish) {
  if (wish == "none") return "gpu: none is to be used, as asked for";
  if (attempts.empty()) return "gpu: EGL lists no device and no surfaceless platform: CPU only";
  std::vector<std::string> there;
  for (const Attempt& a : attempts)
    there.push_back(a.failure.empty() ? fmt::format("{}: {}, {}", a.place.name, a.renderer, a.vendor) : a.failure);
  return fmt::format("gpu: no device {}; there is {}",
                     wish == "auto" ? std::string("works") : "'" + wish + "' that works", fmt::join(there, "; "));
}

std::string load_gl(const std::function<void*(const char*)>& function, Gl& gl) {
  std::vector<std::string> missing;
#define AIRLIGHT_LOAD(type, name)                         \
  gl.name = reinterpret_cast<type>(function("gl" #name)); \
  if (!gl.name) missing.push_back("gl" #name);
  AIRLIGHT_GL_FUNCTIONS(AIRLIGHT_LOAD)
#undef AIRLIGHT_LOAD
  if (!missing.empty()) {
    const std::size_t count = missing.size();
    missing.resize(std::min<std::size_t>(count, 3));
    return fmt::format("lacks {}{}", fmt::join(missing, ", "), count > 3 ? fmt::format(" and {} more", count - 3) : "");
  }
  GLint major = 0, minor = 0;
  gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  if (major < 4 || (major == 4 && minor < 5)) return fmt::format("has OpenGL {}.{}, expected 4.5", major, minor);
  return {};
}

}  // namespace airlight::gpu
