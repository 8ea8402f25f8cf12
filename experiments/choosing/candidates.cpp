#include "experiments/choosing/candidates.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "experiments/application/renderers.h"
#include "experiments/driver/kind.h"
#include "scene/base/error.h"

namespace airlight::experiments {
namespace {

// The settings that differ between rows of the same name, as a user tells them apart.
std::string swept(const MethodCase& m) {
  for (const auto& [key, value] : m.settings)
    if (value == m.setting) return key + " " + value;
  return m.setting;
}

// A word of a command line for the shell.
std::string quoted(const std::string& word) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || std::string("._-/=,:+").find(c) != std::string::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::vector<Candidate> candidates_of(const Experiment& e) {
  if (e.kind->component_key() != "renderer") throw Error(fmt::format("{}: its rows draw no pictures of scenes", e.id));
  std::vector<Candidate> all;
  std::set<std::string> seen, names;
  for (const MethodCase& m : e.methods) {
    if (m.layer != "mean" || m.picture_only) continue;
    const scene::Renderer& renderer = find_renderer(m.renderer, m.name);
    Candidate c{m.name, &renderer, m.settings, scene::Settings(renderer.settings(), m.settings, m.name), m.convert};
    const std::string conversion = m.convert ? canonical(*m.convert) : "";
    if (!seen.insert(renderer.name() + " " + c.settings.canonical() + " " + conversion).second) continue;
    if (!m.setting.empty()) c.name += fmt::format(" ({})", swept(m));
    // Two rows of one name are for different scenes there; here both are tried.
    if (!names.insert(c.name).second) {
      std::vector<std::string> all_given;
      for (const auto& [key, value] : m.settings) all_given.push_back(key + " " + value);
      c.name = fmt::format("{} ({})", m.name, fmt::join(all_given, ", "));
    }
    all.push_back(std::move(c));
  }
  return all;
}

std::string command_line(const Candidate& c, const std::string& scene_file, const Pairs& overrides, int threads) {
  std::string line = fmt::format("airlight render {} -m {}", quoted(scene_file), c.renderer->name());
  for (const auto& [name, value] : c.given) line += fmt::format(" --set {}", quoted(name + "=" + value));
  for (const auto& [name, value] : overrides) line += fmt::format(" --override {}", quoted(name + "=" + value));
  if (c.convert) {
    std::string form = canonical(*c.convert);
    std::replace(form.begin(), form.end(), ' ', ',');
    line += " --convert " + form;
  }
  if (threads > 0) line += fmt::format(" --threads {}", threads);
  return line + " -o picture.exr";
}

}  // namespace airlight::experiments
