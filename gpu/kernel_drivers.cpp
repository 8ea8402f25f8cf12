#include "gpu/kernel_drivers.h"

#include <algorithm>
#include <filesystem>

#include "gpu/device_choice.h"

namespace airlight::gpu {
namespace fs = std::filesystem;

std::vector<std::string> drivers_without_egl(const std::vector<Attempt>& attempts, const std::string& root) {
  const auto reached = [&](const std::string& vendor) {
    return std::any_of(attempts.begin(), attempts.end(), [&](const Attempt& a) {
      return a.failure.empty() && !a.place.software &&
             small_letters(a.vendor + a.renderer).find(vendor) != std::string::npos;
    });
  };
  std::error_code ignored;
  const auto there = [&](const char* path) { return fs::exists(fs::path(root) / path, ignored); };
  bool nodes = false;
  for (fs::directory_iterator node(fs::path(root) / "dev/dri", ignored), end; node != end; node.increment(ignored))
    nodes = nodes || node->path().filename().string().rfind("renderD", 0) == 0;
  std::vector<std::string> lines;
  if (there("proc/driver/nvidia") && !reached("nvidia"))
    lines.push_back(
        "an NVIDIA kernel driver is loaded (/proc/driver/nvidia), but its EGL is not here: its libEGL_nvidia.so.0 and "
        "10_nvidia.json are missing, in a container the capability graphics (NVIDIA_DRIVER_CAPABILITIES=all)");
  if (there("dev/kfd") && !reached("amd"))
    lines.push_back(
        "an AMD kernel driver is loaded (/dev/kfd), but no EGL device uses it: /dev/dri, its permissions or Mesa's "
        "drivers are missing");
  else if (nodes && !reached(""))
    lines.push_back(
        "a kernel driver offers /dev/dri/renderD*, but no EGL device uses it: its permissions or Mesa's drivers are "
        "missing");
  return lines;
}

}  // namespace airlight::gpu
