// How a command line is read, whatever the command: options that several commands share, pairs, and words that are none of a command's own.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/film/tone_curve.h"

namespace airlight::experiments::cli {

// Shared state of all commands: the parser, options that several commands take, and the action of the chosen command.
struct Commands {
  Commands();

  CLI::App app;
  std::string data;
  std::optional<std::string> gpu;
  bool unchecked = false;
  std::vector<std::string> limits;
  std::function<int()> action;  // of the chosen command; returns the exit code
  bool lists_devices = false;   // the chosen command itself tells of a device that is not there

  void add_data(CLI::App* command);       // --data
  void add_gpu(CLI::App* command);        // --gpu
  void add_unchecked(CLI::App* command);  // --unchecked
  void add_limit(CLI::App* command);      // --limit
  void on(CLI::App* command, std::function<int()> act);
};

CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& about);

using Pairs = std::map<std::string, std::string>;  // from key=value

// An option key=value, several times; blanks around the "=" do not count. Parsing throws Error for what is no pair.
void add_pairs(CLI::App* command, const std::string& flag, Pairs&, const std::string& doc);

// Throws Error if an argument or option was not given.
void require(const std::string& value, const std::string& what);

// --tone, the curve of an 8-bit picture; and what its text means. Throws Error for one that is unknown.
void add_tone(CLI::App* command, std::string& text);
scene::Tone tone_of(const std::string& text);

// Throws Error for an --exposure that is no number in [-100, 100].
void check_exposure(double exposure);

std::vector<std::string> command_names(const CLI::App&);

// Throws Error, with the nearest that there is, for the first word that the chosen command knows nothing of, and where it needs one more.
void refuse_extras(const CLI::App&);

}  // namespace airlight::experiments::cli
