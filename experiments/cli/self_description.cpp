// What the program says of its own commands and options to shells and to man: made from the tables that read the command line.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "experiments/application/build_info.h"
#include "experiments/application/folders.h"
#include "experiments/application/renderers.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/nearest.h"

namespace airlight::experiments::cli {
namespace {

// A command with the words that lead to it: "experiment run". Empty: the program.
struct Described {
  std::string words;
  const CLI::App* app;
};

void collect(const CLI::App& app, const std::string& words, std::vector<Described>& all) {
  all.push_back({words, &app});
  for (const CLI::App* command : app.get_subcommands({}))
    collect(*command, (words.empty() ? "" : words + " ") + command->get_name(), all);
}

std::vector<Described> described(const CLI::App& program) {
  std::vector<Described> all;
  collect(program, "", all);
  return all;
}

std::vector<const CLI::Option*> options_of(const CLI::App& app, bool positional) {
  std::vector<const CLI::Option*> options;
  for (const CLI::Option* option : app.get_options())
    if (option->get_positional() == positional) options.push_back(option);
  return options;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::vector<std::string> flags_of(const CLI::Option& option) {
  std::vector<std::string> flags;
  for (const std::string& name : option.get_snames()) flags.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) flags.push_back("--" + name);
  return flags;
}

// Does the option take the name of a renderer? A method of `results` or `fit` is none.
bool names_method(const CLI::Option& option) {
  return (option.check_lname("method") || option.check_lname("renderer")) &&
         option.get_description().find("render") != std::string::npos;
}

std::string replaced(const std::string& text, const std::vector<std::pair<char, std::string>>& by) {
  std::string out;
  for (const char c : text) {
    const auto found = std::find_if(by.begin(), by.end(), [&](const auto& pair) { return pair.first == c; });
    found == by.end() ? out += c : out += found->second;
  }
  return out;
}

std::string bash_script(const std::vector<Described>& all) {
  std::string paths, cases, values, methods;
  for (const Described& one : all) {
    std::vector<std::string> flags, valued;
    for (const CLI::Option* option : options_of(*one.app, false))
      for (const std::string& flag : flags_of(*option)) {
        flags.push_back(flag);
        if (names_method(*option))
          methods += fmt::format("{}'{}|{}'", methods.empty() ? "" : " | ", one.words, flag);
        else if (takes_value(*option))
          valued.push_back(fmt::format("'{}|{}'", one.words, flag));
      }
    for (const std::string& flag : valued) values += (values.empty() ? "" : " | ") + flag;
    if (!one.words.empty()) paths += fmt::format("{}'{}'", paths.empty() ? "" : " | ", one.words);
    cases += fmt::format("    '{}') commands='{}' flags='{}' ;;\n", one.words, fmt::join(command_names(*one.app), " "),
                         fmt::join(flags, " "));
  }
  return fmt::format(R"(# Completion of airlight for bash: source <(airlight completion bash)
_airlight() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} where='' commands='' flags='' i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "${{where:+$where }}${{COMP_WORDS[i]}}" in
      {}) where="${{where:+$where }}${{COMP_WORDS[i]}}" ;;
    esac
  done
  COMPREPLY=()
  case "$where|${{COMP_WORDS[COMP_CWORD-1]}}" in
    {})
      COMPREPLY=($(compgen -W '{}' -- "$word"))
      return ;;
    {}) return ;;
  esac
  case "$where" in
{}  esac
  case "$word" in
    -*) COMPREPLY=($(compgen -W "$flags" -- "$word")) ;;
    *) COMPREPLY=($(compgen -W "$commands" -- "$word")) ;;
  esac
}}
complete -o default -F _airlight airlight
)",
                     paths, methods, fmt::join(renderer_names(), " "), values, cases);
}

std::string zsh_script(const std::vector<Described>& all) {
  const auto quoted = [](const std::string& text) {
    return replaced(text, {{'\'', "'\\''"}, {'[', "\\["}, {']', "\\]"}, {':', "\\:"}});
  };
  std::string paths, cases;
  for (const Described& one : all) {
    if (!one.words.empty()) paths += fmt::format("{}'{}'", paths.empty() ? "" : "|", one.words);
    std::string specs, commands;
    for (const CLI::Option* option : options_of(*one.app, false))
      for (const std::string& flag : flags_of(*option)) {
        const std::string value = names_method(*option)  ? fmt::format(":method:({})", fmt::join(renderer_names(), " "))
                                  : takes_value(*option) ? ":" + quoted(option->get_type_name()) + ":_files"
                                                         : "";
        specs += fmt::format(" \\\n        '*{}[{}]{}'", flag, quoted(option->get_description()), value);
      }
    for (const CLI::App* command : one.app->get_subcommands({}))
      commands += fmt::format(" \\\n        '{}:{}'", command->get_name(), quoted(command->get_description()));
    cases += fmt::format("    ('{}')\n", one.words);
    if (!commands.empty()) cases += fmt::format("      commands=({})\n      _describe command commands\n", commands);
    cases += fmt::format("      _arguments{}{} ;;\n", specs, commands.empty() ? " \\\n        '*:file:_files'" : "");
  }
  return fmt::format(R"(#compdef airlight
# Completion of airlight for zsh: airlight completion zsh > a file _airlight in a folder of $fpath
_airlight() {{
  local where='' i
  local -a commands
  for ((i = 2; i < CURRENT; ++i)); do
    case "${{where:+$where }}$words[i]" in
      ({}) where="${{where:+$where }}$words[i]" ;;
    esac
  done
  case "$where" in
{}  esac
}}
if [ "$funcstack[1]" = "_airlight" ]; then _airlight "$@"; else compdef _airlight airlight; fi
)",
                     paths, cases);
}

std::string fish_script(const std::vector<Described>& all) {
  const auto quoted = [](const std::string& text) { return replaced(text, {{'\'', "\\'"}, {'\\', "\\\\"}}); };
  std::string out = "# Completion of airlight for fish: airlight completion fish | source\n";
  for (const Described& one : all) {
    std::string seen = one.words.empty() ? "__fish_use_subcommand" : "";
    for (std::size_t at = 0; at < one.words.size();) {
      const std::size_t end = std::min(one.words.find(' ', at), one.words.size());
      seen += (seen.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + one.words.substr(at, end - at));
      at = end + 1;
    }
    const std::vector<std::string> commands = command_names(*one.app);
    if (!commands.empty() && !one.words.empty())
      seen += fmt::format("; and not __fish_seen_subcommand_from {}", fmt::join(commands, " "));
    for (const CLI::App* command : one.app->get_subcommands({}))
      out += fmt::format("complete -c airlight -n '{}' -f -a {} -d '{}'\n", seen, command->get_name(),
                         quoted(command->get_description()));
    for (const CLI::Option* option : options_of(*one.app, false)) {
      out += fmt::format("complete -c airlight -n '{}'", seen);
      for (const std::string& name : option->get_snames()) out += " -s " + name;
      for (const std::string& name : option->get_lnames()) out += " -l " + name;
      if (names_method(*option))
        out += fmt::format(" -x -a '{}'", fmt::join(renderer_names(), " "));
      else if (takes_value(*option))
        out += " -r";
      out += fmt::format(" -d '{}'\n", quoted(option->get_description()));
    }
  }
  return out;
}

// Text in which roff takes no character for a command.
std::string roff(const std::string& text) {
  const std::string safe =
      replaced(text, {{'\\', "\\e"}, {'-', "\\-"}, {'\'', "\\(aq"}, {'`', "\\(ga"}, {'^', "\\(ha"}, {'~', "\\(ti"}});
  return safe.starts_with('.') ? "\\&" + safe : safe;
}

std::string page_name(const std::string& words) {
  return words.empty() ? "airlight" : "airlight-" + replaced(words, {{' ', "-"}});
}

std::string man_page(const Described& one, const std::vector<Described>& all) {
  const std::string command = "airlight" + (one.words.empty() ? "" : " " + one.words);
  std::string name = page_name(one.words), title = name;
  std::transform(title.begin(), title.end(), title.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  std::string about = one.app->get_description();
  if (about.starts_with("airlight: ")) about = about.substr(10);
  std::string out = fmt::format(".TH {} 1 \"\" \"airlight {}\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.B {}\n",
                                roff(title), version(), roff(name), roff(about), roff(command));
  if (!options_of(*one.app, false).empty()) out += "[OPTIONS]\n";
  if (!one.app->get_subcommands({}).empty()) out += "COMMAND\n";
  for (const CLI::Option* argument : options_of(*one.app, true))
    out += fmt::format("[{}{}]\n", roff(argument->get_name(true)), argument->get_expected_max() > 1 ? " ..." : "");
  if (const auto arguments = options_of(*one.app, true); !arguments.empty()) {
    out += ".SH ARGUMENTS\n";
    for (const CLI::Option* argument : arguments)
      out += fmt::format(".TP\n.I {}\n{}\n", roff(argument->get_name(true)), roff(argument->get_description()));
  }
  out += ".SH OPTIONS\n";
  for (const CLI::Option* option : options_of(*one.app, false)) {
    const std::string value = takes_value(*option) ? " \\fI" + roff(option->get_type_name()) + "\\fR" : "";
    out += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(fmt::format("{}", fmt::join(flags_of(*option), ", "))), value,
                       roff(option->get_description()));
  }
  if (const auto commands = one.app->get_subcommands({}); !commands.empty()) {
    out += ".SH COMMANDS\n";
    for (const CLI::App* sub : commands)
      out += fmt::format(".TP\n.B {}\n{}\n", roff(sub->get_name()), roff(sub->get_description()));
  }
  out +=
      ".SH EXIT STATUS\n0: success. 1: a gate or comparison failed. 2: bad input or usage. 3: hardware or a library is missing. 130: "
      "interrupted.\n.SH SEE ALSO\n";
  std::vector<std::string> others;
  for (const Described& other : all)
    if (&other != &one) others.push_back(fmt::format(".BR {} (1)", roff(page_name(other.words))));
  return out + fmt::format("{}\n", fmt::join(others, " ,\n"));
}

int completion(const CLI::App& program, const std::string& shell) {
  const std::vector<std::string> shells{"bash", "zsh", "fish"};
  if (shell.empty()) throw Error("SHELL is missing; expected bash, zsh or fish");
  const std::vector<Described> all = described(program);
  if (shell == "bash")
    fmt::print("{}", bash_script(all));
  else if (shell == "zsh")
    fmt::print("{}", zsh_script(all));
  else if (shell == "fish")
    fmt::print("{}", fish_script(all));
  else
    throw Error(
        fmt::format("unknown shell '{}'{}; expected bash, zsh or fish", shell, scene::nearest_hint(shell, shells)));
  return 0;
}

int man(const CLI::App& program, const std::vector<std::string>& command, const std::string& folder) {
  const std::vector<Described> all = described(program);
  if (!folder.empty()) {
    if (!command.empty()) throw Error("--out writes the pages of all commands; expected no COMMAND");
    make_folder(folder);
    for (const Described& one : all)
      scene::write_file_atomically(fmt::format("{}/{}.1", folder, page_name(one.words)), man_page(one, all));
    return 0;
  }
  const std::string words = fmt::format("{}", fmt::join(command, " "));
  std::vector<std::string> names;
  for (const Described& one : all) {
    if (one.words == words) {
      fmt::print("{}", man_page(one, all));
      return 0;
    }
    names.push_back(one.words);
  }
  throw Error(fmt::format("unknown command '{}'{}; see airlight --help", words, scene::nearest_hint(words, names)));
}

}  // namespace

void add_completion(Commands& commands) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* c =
      add_command(commands.app, "completion", "print a script that completes commands and options in a shell");
  c->add_option("SHELL", *shell, "bash, zsh or fish (required)");
  commands.on(c, [&commands, shell] { return completion(commands.app, *shell); });
}

void add_man(Commands& commands) {
  const auto command = std::make_shared<std::vector<std::string>>();
  const auto folder = std::make_shared<std::string>();
  CLI::App* c = add_command(commands.app, "man", "print the manual page of a command, for man -l");
  c->add_option("COMMAND", *command, "command, e.g. experiment run (default: the program itself)");
  c->add_option("-o,--out", *folder, "write the pages of all commands into this folder")->type_name("FOLDER");
  commands.on(c, [&commands, command, folder] { return man(commands.app, *command, *folder); });
}

}  // namespace airlight::experiments::cli
