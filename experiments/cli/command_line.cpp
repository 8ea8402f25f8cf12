#include "experiments/cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "experiments/application/build_info.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"

namespace airlight::experiments::cli {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

// The command that was chosen, at any depth.
const CLI::App& chosen(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : chosen(*commands.front());
}

// "airlight experiment run"
std::string full_name(const CLI::App& command) {
  return command.get_parent() ? full_name(*command.get_parent()) + " " + command.get_name() : command.get_name();
}

}  // namespace

Commands::Commands()
    : app("airlight: five published methods for real-time fog and smoke, compared with unbiased references",
          "airlight") {
  app.set_version_flag("--version", fmt::format("airlight {} ({})", version(), commit()));
  app.option_defaults()->always_capture_default(false);
  app.footer(
      "Commands that may use a GPU (render, experiment run, gates, explain, choose, serve, verify, doctor) take --gpu WHICH.");
  app.allow_extras();
  app.require_subcommand(0, 1);  // a further word that is a command's name is an argument
}

void Commands::add_data(CLI::App* command) {
  command->add_option("--data", data, "folder of large inputs (default: the variable AIRLIGHT_DATA)");
}

void Commands::add_gpu(CLI::App* command) {
  command
      ->add_option(
          "--gpu", gpu,
          "graphics device: a number or a part of a name that `airlight doctor` lists, surfaceless, none, or auto for "
          "the first that works (default: the variable AIRLIGHT_GPU, else auto)")
      ->type_name("WHICH");
}

void Commands::add_unchecked(CLI::App* command) {
  command->add_flag("--unchecked", unchecked,
                    "also use methods that `airlight doctor --check` found wrong on the graphics device");
}

void Commands::add_limit(CLI::App* command) {
  command
      ->add_option(
          "--limit", limits,
          "memory (2GiB) or time (10min, 90s) that the command may take; work estimated to need more is refused before "
          "it begins (default: the memory of the machine, no limit on time)")
      ->type_name("AMOUNT");
}

void Commands::on(CLI::App* command, std::function<int()> act) {
  command->final_callback([this, act = std::move(act)] { action = act; });
}

CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& about) {
  CLI::App* command = parent.add_subcommand(name, about);
  command->allow_extras();
  command->fallthrough(false);
  return command;
}

void add_pairs(CLI::App* command, const std::string& flag, Pairs& pairs, const std::string& doc) {
  command
      ->add_option_function<std::vector<std::string>>(
          flag,
          [&pairs, flag](const std::vector<std::string>& given) {
            for (const std::string& text : given) {
              const std::size_t equals = text.find('=');
              const std::string name = trimmed(text.substr(0, equals));
              if (equals == std::string::npos || name.empty())
                throw Error(fmt::format("{} '{}': expected name=value", flag, text));
              pairs[name] = trimmed(text.substr(equals + 1));
            }
          },
          doc)
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void require(const std::string& value, const std::string& what) {
  if (value.empty()) throw Error(fmt::format("{} is missing; see --help", what));
}

void add_tone(CLI::App* command, std::string& text) {
  command->add_option("--tone", text, "tone curve of the PNG: clamp (default), aces or agx");
}

scene::Tone tone_of(const std::string& text) {
  std::vector<std::string> names;
  for (const auto& [name, tone] : scene::tones()) {
    if (name == text) return tone;
    names.push_back(name);
  }
  throw Error(fmt::format("--tone '{}': expected one of {}", text, fmt::join(names, ", ")));
}

void check_exposure(double exposure) {
  if (!(std::abs(exposure) <= 100))
    throw Error(fmt::format("--exposure {}: expected a number in [-100, 100]", exposure));
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

void refuse_extras(const CLI::App& app) {
  const CLI::App& command = chosen(app);
  const auto extras = app.remaining(true);
  const auto commands = command_names(command);
  if (!extras.empty()) {
    const std::string& word = extras.front();
    const bool option = word.size() > 1 && word[0] == '-';
    const auto candidates = option ? option_names(command) : commands;
    if (candidates.empty())
      throw Error(fmt::format("unexpected argument '{}'; see {} --help", word, full_name(command)));
    throw Error(fmt::format("unknown {} '{}'{}; see {} --help", option ? "option" : "command", word,
                            scene::nearest_hint(word.substr(0, word.find('=')), candidates), full_name(command)));
  }
  if (!commands.empty()) throw Error(fmt::format("expected a command: {}", fmt::join(commands, ", ")));
}

}  // namespace airlight::experiments::cli
