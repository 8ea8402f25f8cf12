#include "gpu/program.h"

#include <fmt/format.h>

#include <atomic>

#include "scene/base/error.h"

namespace airlight::gpu {
namespace {

std::atomic<long> dispatch_count{0};

const char* const size_names[] = {"LOCAL_SIZE_X", "LOCAL_SIZE_Y", "LOCAL_SIZE_Z"};

std::map<std::string, std::string> with_sizes(Context& context, const std::string& file,
                                              std::map<std::string, std::string> definitions) {
  int invocations = 1;
  for (const char* name : size_names) {
    definitions.try_emplace(name, "1");
    invocations *= std::stoi(definitions[name]);
  }
  if (invocations > context.limits().invocations)
    throw Unavailable(fmt::format("gpu/{}: {} invocations in a group, {} offers at most {}", file, invocations,
                                  context.renderer(), context.limits().invocations));
  return definitions;
}

}  // namespace

long Program::dispatches() { return dispatch_count; }

Program::Program(Context& context, const std::string& file, const std::map<std::string, std::string>& definitions)
    : LinkedProgram(context, {{GL_COMPUTE_SHADER, file}}, with_sizes(context, file, definitions)) {
  const auto all = with_sizes(context, file, definitions);
  for (int axis = 0; axis < 3; ++axis) local_[axis] = std::stoi(all.at(size_names[axis]));
}

void Program::dispatch(int x, int y, int z) {
  if (x <= 0 || y <= 0 || z <= 0) return;
  const int wanted[3] = {x, y, z};
  GLuint groups[3];
  for (int axis = 0; axis < 3; ++axis) {
    groups[axis] = GLuint((long(wanted[axis]) + local_[axis] - 1) / local_[axis]);
    if (groups[axis] > GLuint(context_.limits().groups[axis]))
      throw Error(fmt::format("{}: {} work groups, {} offers at most {}", files_, groups[axis], context_.renderer(),
                              context_.limits().groups[axis]));
  }
  const long all = long(groups[0]) * groups[1] * groups[2];
  run([&](const Gl& gl) { gl.DispatchCompute(groups[0], groups[1], groups[2]); }, all);
}

void Program::dispatch_indirect(const Buffer& groups, std::size_t offset) {
  long all = 0;
  if (is_watched()) {
    const std::vector<unsigned> words = groups.download<unsigned>();
    all = long(words.at(offset / 4)) * words.at(offset / 4 + 1) * words.at(offset / 4 + 2);
  }
  groups.bind_as(GL_DISPATCH_INDIRECT_BUFFER);
  run([&](const Gl& gl) { gl.DispatchComputeIndirect(GLintptr(offset)); }, all);
}

template <class Dispatch>
void Program::run(Dispatch dispatch, long groups) {
  constexpr GLenum invocations = 0x82F5;  // GL_COMPUTE_SHADER_INVOCATIONS_ARB
  const Gl& gl = context_.gl();
  gl.UseProgram(id_);
  watch(invocations, groups * local_[0] * local_[1] * local_[2], [&] { dispatch(gl); });
  gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
  ++dispatch_count;
  ++context_.traffic().dispatches;
  context_.check_closely(files_);
}

}  // namespace airlight::gpu
