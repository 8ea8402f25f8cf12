#include "gpu/interface.h"

#include <fmt/format.h>

#include "scene/base/error.h"

namespace airlight::gpu {

void define(const std::vector<Binding>& bindings, std::map<std::string, std::string>& definitions) {
  for (const auto& [name, number] : bindings) definitions[std::string("AT_") + name] = std::to_string(number);
}

void check_layouts(const LinkedProgram& program, const std::string& file, const std::vector<Layout>& expected) {
  for (const auto& [variable, offset, stride] : expected) {
    const auto found = program.place_of(variable);
    if (!found || found->offset == 0) continue;  // so Mesa says of what is not used
    if (std::size_t(found->offset) == offset && (stride == 0 || std::size_t(found->stride) == stride)) continue;
    throw Error(fmt::format("gpu/{}: {} at byte {}, {} apart; expected {} and {}", file, variable, found->offset,
                            found->stride, offset, stride));
  }
}

}  // namespace airlight::gpu
