#include "experiments/driver/junit.h"

#include <fmt/format.h>

#include "scene/base/atomic_file.h"

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

void write_junit(const std::string& file, const std::vector<GateResult>& gates, const std::string& error) {
  const GateCounts counts = count(gates);
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n<testsuite name=\"airlight gates\" tests=\"{}\" "
      "failures=\"{}\" skipped=\"{}\" errors=\"{}\">\n",
      gates.size() + !error.empty(), counts.failed, counts.skipped, int(!error.empty()));
  for (const GateResult& gate : gates) {
    const std::string group = gate.name.substr(0, gate.name.find(':'));
    out += fmt::format("<testcase classname=\"{}\" name=\"{}\" time=\"{:.3f}\">", escaped(group), escaped(gate.name),
                       gate.seconds);
    out += gate.skipped  ? fmt::format("<skipped message=\"{}\"/>", escaped(gate.text))
           : gate.passed ? fmt::format("<system-out>{}</system-out>", escaped(gate.text))
                         : fmt::format("<failure message=\"{}\"/>", escaped(gate.text));
    out += "</testcase>\n";
  }
  if (!error.empty())
    out += fmt::format("<testcase classname=\"airlight\" name=\"gates\"><error message=\"{}\"/></testcase>\n",
                       escaped(error));
  scene::write_file_atomically(file, out + "</testsuite>\n</testsuites>\n");
}

}  // namespace airlight::experiments
