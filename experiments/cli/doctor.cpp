#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

#include "experiments/application/build_info.h"
#include "experiments/application/machine.h"
#include "experiments/application/probes.h"
#include "experiments/application/progress.h"
#include "experiments/application/renderers.h"
#include "experiments/application/say.h"
#include "experiments/application/studies.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/device/device_record.h"
#include "gpu/context.h"
#include "gpu/kernel_drivers.h"
#include "scene/base/error.h"

namespace airlight::experiments::cli {
namespace {

std::string title(const Parity& p) {
  return fmt::format("{}{}{}", p.method, p.computes == Computes::flows ? ", flows" : "",
                     p.settings.empty() ? "" : ", " + p.settings);
}

bool failed(const Parity& p) { return p.failed(); }

// What an earlier `doctor --check` found on the device in use.
void findings(const std::function<void(const std::string&)>& line) {
  const std::optional<DeviceRecord> record = find_device_record();
  if (!record) return line("not checked: `airlight doctor --check` compares every method with the CPU on this device");
  const auto& all = record->findings;
  line(fmt::format("checked {}: {} of {} checks failed", record->checked, std::count_if(all.begin(), all.end(), failed),
                   all.size()));
  for (const Parity& p : all)
    if (p.failed()) line(fmt::format("refused: {}: {}", title(p), finding(p)));
}

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
    findings(line);
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

// Compares every method with the CPU on the device, and keeps the findings. Exit code 1 if a method failed.
int check() {
  fmt::print("{}\n", gpu::Context::get().description());
  DeviceRecord record{utc_now(), {}};
  std::size_t failures = 0;
  {
    Progress progress("checking the device");
    record.findings = check_parity(progress.execution(0), [&](const Parity& p) {
      const ProgressHidden hidden;
      const char* const outcome = p.failed() ? "FAILED" : p.unavailable.empty() ? "holds" : "refused";
      fmt::print("  {:8} {}: {} ({:.1f} s)\n", outcome, title(p), finding(p), p.seconds);
      std::fflush(stdout);
      failures += p.failed();
    });
  }
  fmt::print("{} of {} checks failed\n", failures, record.findings.size());
  try {
    fmt::print("kept in {}\n", keep_device_record(record).string());
  } catch (const Error& error) {
    if (failures == 0) throw;
    say(error.what());
  }
  return failures ? 1 : 0;
}

}  // namespace

void add_doctor(Commands& commands) {
  CLI::App* c =
      add_command(commands.app, "doctor", "print versions, processor and graphics devices, or check a device");
  const auto check_device = std::make_shared<bool>(false);
  c->add_flag(
      "--check", *check_device,
      "compute a small scene with every method on the graphics device and compare it with the CPU; the result is "
      "kept, and other commands refuse a method that failed on this device (exit 1 if one failed)");
  commands.add_gpu(c);
  c->final_callback([&commands, check_device] {
    commands.lists_devices = !*check_device;
    commands.unchecked = *check_device;
    commands.action = *check_device ? check : doctor;
  });
}

}  // namespace airlight::experiments::cli
