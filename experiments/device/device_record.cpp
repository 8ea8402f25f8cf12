#include "experiments/device/device_record.h"

#include <fmt/format.h>

#include <cstdlib>

#include "experiments/application/build_info.h"
#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/application/say.h"
#include "gpu/context.h"
#include "gpu/shader_source.h"
#include "scene/base/atomic_file.h"
#include "scene/base/content_key.h"
#include "scene/flow/flow.h"

namespace airlight::experiments {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

// All that an answer depends on.
std::vector<std::string> identity() {
  return {gpu::Context::get().driver(), source_id(), gpu::foreign_shaders(), fmt::format("{}", gpu::injected_error())};
}

fs::path record_file() { return device_records() / (content_key(identity()) + ".json"); }

const char* name_of(Computes what) { return what == Computes::pictures ? "pictures" : "flows"; }

Json to_json(const Parity& p) {
  return {{"method", p.method},          {"computes", name_of(p.computes)},
          {"settings", p.settings},      {"failed", p.failed()},
          {"measured", p.measured},      {"error", fmt::format("{}", p.error)},  // as text: JSON knows no infinity
          {"tolerance", p.tolerance},    {"failure", p.failure},
          {"unavailable", p.unavailable}};
}

Parity from_json(const nlohmann::json& j) {
  Parity p;
  p.method = j.at("method").get<std::string>();
  p.computes = j.at("computes").get<std::string>() == name_of(Computes::flows) ? Computes::flows : Computes::pictures;
  p.settings = j.at("settings").get<std::string>();
  p.measured = j.at("measured").get<std::string>();
  p.error = std::stod(j.at("error").get<std::string>());
  p.tolerance = j.at("tolerance").get<double>();
  p.failure = j.at("failure").get<std::string>();
  p.unavailable = j.at("unavailable").get<std::string>();
  return p;
}

}  // namespace

fs::path device_records() {
  const auto variable = [](const char* name) {
    const char* text = std::getenv(name);
    return fs::path(text ? text : "");
  };
  if (const fs::path cache = variable("XDG_CACHE_HOME"); !cache.empty()) return cache / "airlight" / "devices";
  if (const fs::path home = variable("HOME"); !home.empty()) return home / ".cache" / "airlight" / "devices";
  return {};
}

std::optional<DeviceRecord> find_device_record() {
  const fs::path file = record_file();
  std::error_code ignored;
  if (device_records().empty() || !fs::exists(file, ignored)) return std::nullopt;
  try {
    const nlohmann::json j = read_json(file.string());
    if (j.at("identity").get<std::vector<std::string>>() != identity()) throw Error("it is of another device");
    DeviceRecord record{j.at("checked").get<std::string>(), {}};
    for (const nlohmann::json& finding : j.at("findings")) record.findings.push_back(from_json(finding));
    return record;
  } catch (const std::exception& reason) {
    say(fmt::format("warning: {}: not a record of `airlight doctor --check`: {}", file.string(), reason.what()));
    return std::nullopt;
  }
}

fs::path keep_device_record(const DeviceRecord& record) {
  if (device_records().empty())
    throw Error("the findings are not kept: neither XDG_CACHE_HOME nor HOME is set, expected a folder for caches");
  Json findings = Json::array();
  for (const Parity& p : record.findings) findings.push_back(to_json(p));
  const Json j{{"device", gpu::Context::name_of_device()},
               {"program", fmt::format("airlight {} ({})", version(), commit())},
               {"checked", record.checked},
               {"identity", identity()},
               {"findings", findings}};
  fs::path file = record_file();
  scene::make_private_folder(device_records());
  scene::write_file_atomically(file.string(), j.dump(2) + "\n");
  return file;
}

void refuse_failed_method(const scene::Component& method) {
  static const std::optional<DeviceRecord> record = find_device_record();  // a process has one device
  if (!record) return;
  const Computes what = dynamic_cast<const scene::Solver*>(&method) ? Computes::flows : Computes::pictures;
  for (const Parity& p : record->findings) {
    if (p.method != method.name() || p.computes != what || !p.failed()) continue;
    throw Unavailable(
        fmt::format("{} is refused on {}: {} (`airlight doctor --check` of {}); --unchecked uses it all the same",
                    p.method, gpu::Context::get().renderer(), finding(p), record->checked));
  }
}

}  // namespace airlight::experiments
