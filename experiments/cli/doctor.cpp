#include <fmt/format.h>

#include <cstdlib>

#include "experiments/build_info.h"
#include "experiments/cli/commands.h"
#include "experiments/machine.h"
#include "experiments/renderers.h"

namespace airlight::experiments::cli {

int doctor() {
  fmt::print("airlight {} ({})\n", version(), commit());
  fmt::print("  compiler   {}\n", compiler());
  for (const auto& [name, number] : libraries()) fmt::print("  library    {} {}\n", name, number);
  const Machine machine = this_machine();
  fmt::print("  processor  {}, {} threads, {}\n", machine.cpu, machine.threads, machine.simd);
  fmt::print("  memory     {:.1f} GiB\n", machine.memory_gib);
  fmt::print("  system     {}\n", machine.system);
  for (const std::string& line : graphics_devices()) fmt::print("  graphics   {}\n", line);
  const bool gnuplot = std::system("command -v gnuplot >/dev/null 2>&1") == 0;
  fmt::print("  plots      {}\n", gnuplot ? "gnuplot" : "none: gnuplot is not installed (tables only)");
  for (const auto& renderer : all_renderers()) fmt::print("  renderer   {}: {}\n", renderer->name(), renderer->about());
  return 0;
}

}  // namespace airlight::experiments::cli
