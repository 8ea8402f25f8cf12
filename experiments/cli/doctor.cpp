#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>

#include "experiments/application/build_info.h"
#include "experiments/application/machine.h"
#include "experiments/application/probes.h"
#include "experiments/application/renderers.h"
#include "experiments/application/studies.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "gpu/context.h"
#include "gpu/kernel_drivers.h"
#include "scene/base/error.h"

namespace airlight::experiments::cli {
namespace {

// Every place where a context could be made, and the one that would be used. Without any the rest works as well.
void graphics() {
  const auto line = [](const std::string& text) { fmt::print("  graphics   {}\n", text); };
  try {
    const std::vector<gpu::Attempt> attempts = gpu::Context::try_everything();
    for (const gpu::Attempt& a : attempts)
      line(a.failure.empty() ? fmt::format("{}: {}{}, {}, OpenGL {}", a.place.name, a.renderer,
                                           a.place.software ? " (software renderer)" : "", a.vendor, a.version)
                             : a.failure);
    for (const std::string& driver : gpu::drivers_without_egl(attempts)) line(driver);
    const gpu::Context& context = gpu::Context::get();
    const gpu::Limits& l = context.limits();
    line("chosen: " + context.description());
    line(fmt::format("limits: storage blocks of {} MiB, {} in a shader; {} KiB shared; 3D textures of {}^3; {} groups",
                     l.storage_block >> 20, l.storage_blocks, l.shared_memory >> 10, l.texture_size_3d, l.groups[0]));
  } catch (const Error& error) {
    line(error.what());
  }
}

int doctor() {
  fmt::print("airlight {} ({})\n", version(), commit());
  fmt::print("  compiler   {}\n", compiler());
  for (const auto& [name, number] : libraries()) fmt::print("  library    {} {}\n", name, number);
  const Machine machine = this_machine();
  fmt::print("  processor  {}, {} threads, {}\n", machine.cpu, machine.threads, machine.simd);
  fmt::print("  memory     {:.1f} GiB\n", machine.memory_gib);
  fmt::print("  system     {}\n", machine.system);
  graphics();
  const bool gnuplot = std::system("command -v gnuplot >/dev/null 2>&1") == 0;
  fmt::print("  plots      {}\n", gnuplot ? "gnuplot" : "none: gnuplot is not installed (tables only)");
  for (const auto& renderer : all_renderers()) fmt::print("  renderer   {}: {}\n", renderer->name(), renderer->about());
  try {
    for (const auto& probe : all_probes()) {
      fmt::print("  probe      {}: {}\n", probe->name(), probe->about());
      fmt::print("             figures {}\n", fmt::join(probe->figures(), ", "));
    }
  } catch (const NeedsStudies&) {
    fmt::print("  probes     airlight_studies doctor lists them\n");
  }
  return 0;
}

}  // namespace

void add_doctor(Commands& commands) {
  CLI::App* c = add_command(commands.app, "doctor", "print versions, processor and graphics devices");
  commands.add_gpu(c);
  c->final_callback([&commands] {
    commands.lists_devices = true;
    commands.action = doctor;
  });
}

}  // namespace airlight::experiments::cli
