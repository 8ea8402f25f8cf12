#include "experiments/application/machine.h"

#include <fmt/format.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <filesystem>
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

std::string this_node() {
  if (const char* name = std::getenv("SLURMD_NODENAME")) return name;
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return host;
}

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

ProcessorTime processor_time() {
  ProcessorTime sum;
  std::error_code failure;
  for (std::filesystem::directory_iterator task("/proc/self/task", failure), end; !failure && task != end;
       task.increment(failure)) {
    double run = 0, waited = 0;  // [ns]
    if (!(std::ifstream(task->path() / "schedstat") >> run >> waited)) continue;
    sum.run += 1e-9 * run;
    sum.waited += 1e-9 * waited;
  }
  return sum;
}

double resident_gib() {
  double size = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;
  return resident * double(sysconf(_SC_PAGE_SIZE)) / (1 << 30);
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
