#include "experiments/driver/junit.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/atomic_file.h"

namespace airlight::experiments {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < 32 ? ' ' : c;
  }
  return out;
}

}  // namespace

void write_junit(const std::string& file, const std::vector<GateResult>& gates) {
  const auto failed = std::count_if(gates.begin(), gates.end(), [](const auto& g) { return !g.passed; });
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n<testsuite name=\"airlight gates\" tests=\"{}\" "
      "failures=\"{}\">\n",
      gates.size(), failed);
  for (const GateResult& gate : gates) {
    const std::string group = gate.name.substr(0, gate.name.find(':'));
    out += fmt::format("<testcase classname=\"{}\" name=\"{}\">", escaped(group), escaped(gate.name));
    out += gate.passed ? fmt::format("<system-out>{}</system-out>", escaped(gate.text))
                       : fmt::format("<failure message=\"{}\"/>", escaped(gate.text));
    out += "</testcase>\n";
  }
  scene::write_file_atomically(file, out + "</testsuite>\n</testsuites>\n");
}

}  // namespace airlight::experiments
