#include "experiments/cli/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "experiments/application/interrupt.h"
#include "experiments/application/say.h"
#include "experiments/application/studies.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/device/device_record.h"
#include "gpu/context.h"
#include "gpu/device_choice.h"
#include "scene/base/data_folder.h"
#include "scene/base/device_check.h"
#include "scene/base/error.h"
#include "scene/base/limits.h"

namespace airlight::experiments::cli {
namespace {

const std::string lost_output = "standard output could not be written";

// A standard stream that is closed would be the next file that is opened, and messages would be written into that.
void reserve_standard_streams() {
  for (const int stream : {0, 1, 2})
    if (::fcntl(stream, F_GETFD) < 0) ::open("/dev/null", O_RDONLY);  // read only: writing still fails
}

// Reads the line; the exit code of --help and --version, which are done then.
std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForVersion& wanted) {
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    throw Error(error.what());
  }
  refuse_extras(app);
  return std::nullopt;
}

void apply_shared_options(const Commands& commands) {
  if (!commands.data.empty()) scene::set_data_folder(commands.data);
  scene::reset_limits();
  for (const std::string& limit : commands.limits) scene::set_limit(limit);
  scene::on_long_work(say);
  scene::set_device_check(commands.unchecked ? scene::DeviceCheck() : refuse_failed_method);
  if (!commands.gpu) return;
  gpu::Context::choose_device(*commands.gpu);
  // A device that is not there is told at once, whatever the command would make of it; doctor tells it in its table.
  if (gpu::small_letters(*commands.gpu) != "none" && !commands.lists_devices) gpu::Context::get();
}

// The commands by what they are for, as --help lists them.
const std::vector<std::pair<std::string, std::vector<void (*)(Commands&)>>> command_groups{
    {"Pictures", {add_render, add_merge, add_compare}},
    {"Which method", {add_explain, add_choose, add_serve}},
    {"Media and flows", {add_info, add_convert, add_fit, add_author, add_simulate}},
    {"Experiments", {add_experiment, add_gates, add_results, add_verify}},
    {"This machine", {add_doctor, add_completion, add_man}}};

int dispatch(int argc, char** argv) {
  Commands commands;
  for (const auto& [group, adders] : command_groups) {
    for (const auto add : adders) {
      add(commands);
      commands.app.get_subcommands({}).back()->group(group);
    }
  }
  if (const std::optional<int> done = parse(commands.app, argc, argv)) return *done;
  if (!commands.action)
    throw Error(fmt::format("expected a command: {}", fmt::join(command_names(commands.app), ", ")));
  apply_shared_options(commands);
  catch_interrupts();
  return commands.action();
}

int dispatch_or_go_on(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const NeedsStudies&) {
    go_on_with_studies(argv);
  }
}

}  // namespace

int run(int argc, char** argv) {
  reserve_standard_streams();
  try {
    check_commit_of_studies();
    const int code = dispatch_or_go_on(argc, argv);
    std::cout.flush();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) || !std::cout) throw Error(lost_output);
    return code;
  } catch (const Error& error) {
    say(error.what());
    return error.exit_code();
  } catch (const scene::Interrupted&) {
    if (const std::string line = stopped_by(); !line.empty()) {
      say(line);
      return 2;
    }
    say("interrupted");
    return 130;
  } catch (const std::filesystem::filesystem_error& error) {
    say(fmt::format("{}: {}", error.path1().string(), error.code().message()));
    return 2;
  } catch (const std::bad_alloc&) {
    say("out of memory");
    return 2;
  } catch (const std::exception& error) {
    // Printing to a stream that fails throws a system exception.
    say(std::ferror(stdout) ? lost_output : fmt::format("unexpected failure: {}", error.what()));
    return 2;
  }
}

}  // namespace airlight::experiments::cli
