#include "gpu/program.h"

#include <fmt/format.h>

#include <atomic>

#include "gpu/shader_source.h"
#include "scene/error.h"

namespace airlight::gpu {
namespace {

std::atomic<long> dispatch_count{0};

}  // namespace

long Program::dispatches() { return dispatch_count; }

Program::Program(Context& context, const std::string& file, const std::map<std::string, std::string>& definitions)
    : context_(context), file_(file) {
  const Use use(context_);
  const Gl& gl = context_.gl();
  std::map<std::string, std::string> all = definitions;
  const char* const names[] = {"LOCAL_SIZE_X", "LOCAL_SIZE_Y", "LOCAL_SIZE_Z"};
  for (int axis = 0; axis < 3; ++axis) {
    all.try_emplace(names[axis], "1");
    local_[axis] = std::stoi(all[names[axis]]);
  }
  if (local_[0] * local_[1] * local_[2] > 128) throw Error("gpu/" + file + ": more than 128 invocations in a group");
  const ShaderSource source = shader_source(file, all);
  text_ = source.text;
  const GLuint shader = gl.CreateShader(GL_COMPUTE_SHADER);
  const char* text = text_.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint ok = 0;
  char log[4096] = {};
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (!ok) {
    gl.GetShaderInfoLog(shader, sizeof log, nullptr, log);
    gl.DeleteShader(shader);
    try {
      context_.check("");  // the same words again
    } catch (const Error&) {
    }
    throw Error(fmt::format("gpu/{} was refused by {}:\n{}", file, context_.renderer(), with_file_names(log, source)));
  }
  id_ = gl.CreateProgram();
  gl.AttachShader(id_, shader);
  gl.LinkProgram(id_);
  gl.DeleteShader(shader);
  gl.GetProgramiv(id_, GL_LINK_STATUS, &ok);
  if (!ok) {
    gl.GetProgramInfoLog(id_, sizeof log, nullptr, log);
    throw Error(
        fmt::format("gpu/{} was not linked by {}:\n{}", file, context_.renderer(), with_file_names(log, source)));
  }
  context_.check("compiling gpu/" + file);
}

Program::~Program() {
  const Use use(context_);
  context_.gl().DeleteProgram(id_);
}

int Program::location(const std::string& name) {
  const auto known = locations_.find(name);
  if (known != locations_.end()) return known->second;
  if (text_.find(name) == std::string::npos) throw Error(fmt::format("gpu/{} has no uniform '{}'", file_, name));
  return locations_[name] = context_.gl().GetUniformLocation(id_, name.c_str());
}

void Program::set(const std::string& name, int value) { context_.gl().ProgramUniform1i(id_, location(name), value); }
void Program::set(const std::string& name, float value) { context_.gl().ProgramUniform1f(id_, location(name), value); }
void Program::set(const std::string& name, const Vec3& v) {
  context_.gl().ProgramUniform3f(id_, location(name), float(v[0]), float(v[1]), float(v[2]));
}
void Program::set(const std::string& name, const Mat3& m) {
  const Eigen::Matrix3f f = m.cast<float>();
  context_.gl().ProgramUniformMatrix3fv(id_, location(name), 1, GL_FALSE, f.data());
}

void Program::dispatch(int x, int y, int z) {
  if (x <= 0 || y <= 0 || z <= 0) return;
  const int wanted[3] = {x, y, z};
  GLuint groups[3];
  for (int axis = 0; axis < 3; ++axis) {
    groups[axis] = GLuint((wanted[axis] + local_[axis] - 1) / local_[axis]);
    if (groups[axis] > GLuint(context_.limits().groups[axis]))
      throw Error(fmt::format("gpu/{}: {} work groups, {} offers at most {}", file_, groups[axis], context_.renderer(),
                              context_.limits().groups[axis]));
  }
  const Gl& gl = context_.gl();
  gl.UseProgram(id_);
  gl.DispatchCompute(groups[0], groups[1], groups[2]);
  gl.MemoryBarrier(GL_ALL_BARRIER_BITS);
  ++dispatch_count;
  context_.check("gpu/" + file_);
}

}  // namespace airlight::gpu
