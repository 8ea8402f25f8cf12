#include "experiments/machine.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <fstream>

namespace airlight::experiments {
namespace {

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0 && line.find(':') != std::string::npos) return line.substr(line.find(':') + 2);
  return "unknown";
}

}  // namespace

Machine this_machine() {
  Machine m;
  m.cpu = cpu_model();
  cpu_set_t set;
  CPU_ZERO(&set);
  m.threads = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : int(sysconf(_SC_NPROCESSORS_ONLN));
  m.memory_gib = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE)) / (1 << 30);
  m.simd = __builtin_cpu_supports("avx512f") ? "avx512" : __builtin_cpu_supports("avx2") ? "avx2" : "sse4.2";
  utsname names{};
  if (uname(&names) == 0) m.system = fmt::format("{} {} {}", names.sysname, names.release, names.machine);
  double load[1] = {0};
  if (getloadavg(load, 1) == 1) m.load_average = load[0];
  return m;
}

std::vector<std::string> graphics_devices() {
  // The few EGL names that this needs, so that neither headers nor library are needed to build or to start.
  using Device = void*;
  using GetProc = void* (*)(const char*);
  using QueryDevices = unsigned (*)(int, Device*, int*);
  using QueryString = const char* (*)(Device, int);
  constexpr int extensions = 0x3055, vendor = 0x3053, renderer = 0x335F;
  void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library) return {"none: libEGL.so.1 is not installed (CPU only)"};
  const auto get = reinterpret_cast<GetProc>(dlsym(library, "eglGetProcAddress"));
  if (!get) return {"none: libEGL.so.1 has no eglGetProcAddress (CPU only)"};
  const auto devices = reinterpret_cast<QueryDevices>(get("eglQueryDevicesEXT"));
  const auto name = reinterpret_cast<QueryString>(get("eglQueryDeviceStringEXT"));
  if (!devices || !name) return {"none: EGL cannot list devices (CPU only)"};
  Device found[16] = {};
  int count = 0;
  if (!devices(16, found, &count) || count == 0) return {"none: EGL lists no device (CPU only)"};
  std::vector<std::string> lines;
  for (int i = 0; i < count; ++i) {
    const char* all = name(found[i], extensions);
    const std::string has = all ? all : "";
    const bool named = has.find("EGL_EXT_device_query_name") != std::string::npos;
    const char* by = named ? name(found[i], vendor) : nullptr;
    const char* what = named ? name(found[i], renderer) : nullptr;
    const bool software = has.find("EGL_MESA_device_software") != std::string::npos;
    lines.push_back(fmt::format("EGL device {}: {}{}{}", i, software ? "software renderer" : "hardware",
                                by ? fmt::format(", {}", by) : "", what ? fmt::format(", {}", what) : ""));
  }
  return lines;  // the library stays loaded: drivers do not unload cleanly
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

}  // namespace airlight::experiments
