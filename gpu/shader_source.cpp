#include "gpu/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "scene/base/error.h"
#include "scene/base/printable.h"
#include "scene/load/content_hash.h"

namespace airlight::gpu {
namespace {

std::string text_of(const std::string& file, const std::string& from) {
  if (const char* folder = std::getenv("AIRLIGHT_SHADERS"); folder && *folder) {
    const std::string path = std::string(folder) + "/" + file;
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw Error(fmt::format("{}no shader {} (AIRLIGHT_SHADERS)", from, path));
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  const auto found = embedded_shaders().find(file);
  if (found == embedded_shaders().end()) throw Error(fmt::format("{}no shader gpu/{}", from, file));
  return found->second;
}

void append(const std::string& file, const std::string& from, ShaderSource& source) {
  if (std::find(source.files.begin(), source.files.end(), file) != source.files.end()) return;
  const int number = int(source.files.size());
  source.files.push_back(file);
  std::istringstream lines(text_of(file, from));
  source.text += fmt::format("#line 1 {}  // gpu/{}\n", number, file);
  int at = 0;
  for (std::string line; std::getline(lines, line);) {
    ++at;
    if (line.rfind("#include", 0) != 0) {
      source.text += line + "\n";
      continue;
    }
    const std::size_t open = line.find('"'), close = line.rfind('"');
    if (open == close) throw Error(fmt::format("gpu/{}:{}: expected #include \"file\"", file, at));
    append(line.substr(open + 1, close - open - 1), fmt::format("gpu/{}:{}: ", file, at), source);
    source.text += fmt::format("#line {} {}  // gpu/{}\n", at + 1, number, file);
  }
}

}  // namespace

ShaderSource shader_source(const std::string& file, const std::map<std::string, std::string>& definitions) {
  ShaderSource source;
  source.text = "#version 450 core\n";
  for (const auto& [name, value] : definitions) source.text += fmt::format("#define {} {}\n", name, value);
  append(file, "", source);
  if (const char* ulps = std::getenv("AIRLIGHT_GPU_ULPS"); ulps && *ulps) {
    const std::string_view text(ulps);
    int units = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), units);
    if (code != std::errc() || end != text.data() + text.size() || units < 0 || units > 1024)
      throw Error(
          fmt::format("AIRLIGHT_GPU_ULPS = '{}': expected a whole number from 0 to 1024", scene::printable(text, 100)));
    ShaderSource errors;
    append("common/ulp_errors.glsl", "", errors);
    const std::size_t at = source.text.find("#line 1 0");
    source.text.insert(at, fmt::format("#define ULP_ERRORS {}\n{}", units, errors.text));
  }
  return source;
}

double injected_error() {
  const char* ulps = std::getenv("AIRLIGHT_GPU_ULPS");
  return ulps ? std::atof(ulps) * std::exp2(-23) : 0;
}

void dump_shader(const ShaderSource& source) {
  const char* folder = std::getenv("AIRLIGHT_DUMP_SHADERS");
  if (!folder || !*folder) return;
  scene::load::ContentHash hash;
  hash.tag(source.text);
  const std::filesystem::path file = source.files.front();
  std::string name = (file.parent_path() / file.stem()).generic_string();
  std::replace(name.begin(), name.end(), '/', '-');
  std::filesystem::create_directories(folder);
  const auto path =
      std::filesystem::path(folder) / (name + "-" + hash.digits().substr(0, 12) + file.extension().string());
  std::ofstream stream(path, std::ios::binary);
  stream << source.text;
  if (!stream.flush()) throw Error(fmt::format("{} cannot be written (AIRLIGHT_DUMP_SHADERS)", path.string()));
}

std::string foreign_shaders() {
  const char* folder = std::getenv("AIRLIGHT_SHADERS");
  if (!folder || !*folder) return {};
  std::error_code failure;
  std::map<std::string, std::string> texts;
  std::filesystem::recursive_directory_iterator file(folder, failure);
  if (failure) throw Error(fmt::format("{}: {} (AIRLIGHT_SHADERS)", folder, failure.message()));
  for (; file != std::filesystem::recursive_directory_iterator(); ++file) {
    if (!file->is_regular_file(failure)) continue;
    const std::string name = std::filesystem::relative(file->path(), folder).generic_string(),
                      end = file->path().extension();
    if (end == ".comp" || end == ".glsl" || end == ".vert" || end == ".frag") texts[name] = text_of(name, "");
  }
  if (texts == embedded_shaders()) return {};  // a copy of them
  scene::load::ContentHash hash;
  for (const auto& [name, text] : texts) {
    hash.tag(name);
    hash.tag(text);
  }
  return hash.digits();
}

std::string with_file_names(const std::string& message, const ShaderSource& source) {
  // Mesa: "0:12(3): error: ...", NVIDIA: "0(12) : error C1008: ...".
  static const std::regex mesa(R"((^|\n)(\d+):(\d+)(\(\d+\))?:)"), nvidia(R"((^|\n)(\d+)\((\d+)\) ?:)");
  std::string result = message;
  for (const std::regex& form : {mesa, nvidia}) {
    std::string changed;
    auto from = result.cbegin();
    for (std::sregex_iterator m(result.cbegin(), result.cend(), form), end; m != end; ++m) {
      const std::size_t number = std::stoul((*m)[2]);
      changed.append(from, (*m)[0].first);
      changed += number < source.files.size()
                     ? fmt::format("{}gpu/{}:{}:", (*m)[1].str(), source.files[number], (*m)[3].str())
                     : (*m)[0].str();
      from = (*m)[0].second;
    }
    changed.append(from, result.cend());
    result = changed;
  }
  while (!result.empty() && std::isspace(static_cast<unsigned char>(result.back()))) result.pop_back();
  return result;
}

}  // namespace airlight::gpu
