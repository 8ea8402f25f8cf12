#include "gpu/linked_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <regex>

#include "gpu/shader_source.h"
#include "scene/base/error.h"

namespace airlight::gpu {
namespace {

std::string refusal(const std::string& files, const char* what, Context& context, const char* log,
                    const ShaderSource& source) {
  context.forget_errors();  // the driver's message would repeat this error
  return fmt::format("{} was {} by {}:\n{}", files, what, context.renderer(), with_file_names(log, source));
}

// A likely reason for a driver's refusal; empty if the shader stays within the device's storage blocks. Counts blocks
// in the text, also in branches that definitions left out.
std::string beyond_storage(const std::string& file, GLenum stage, const std::string& text,
                           const std::map<std::string, std::string>& definitions, const Context& context) {
  static const std::regex block(R"(layout\s*\([^)]*binding\s*=\s*(\w+)\s*\)[^;{]*\bbuffer\b)");
  const auto number = [&](const std::string& word) {  // 0 of names that a shader defines itself
    const auto found = definitions.find(word);
    return std::atoi((found == definitions.end() ? word : found->second).c_str());
  };
  const Limits& limits = context.limits();
  int blocks = 0, greatest = 0;
  for (std::sregex_iterator found(text.begin(), text.end(), block), end; found != end; ++found, ++blocks)
    greatest = std::max(greatest, number((*found)[1]));
  const int offered = stage == GL_COMPUTE_SHADER  ? limits.storage_blocks
                      : stage == GL_VERTEX_SHADER ? limits.vertex_storage_blocks
                                                  : limits.fragment_storage_blocks;
  if (blocks > offered)
    return fmt::format("gpu/{} has {} storage blocks, {} offers {}", file, blocks, context.renderer(), offered);
  if (greatest >= limits.storage_bindings)
    return fmt::format("gpu/{} binds a storage block to number {}, {} offers {}", file, greatest, context.renderer(),
                       limits.storage_bindings);
  return {};
}

}  // namespace

LinkedProgram::LinkedProgram(Context& context, const std::vector<std::pair<GLenum, std::string>>& stages,
                             const std::map<std::string, std::string>& definitions)
    : context_(context) {
  const Use use(context_);
  const Gl& gl = context_.gl();
  id_ = Handle(context, gl.CreateProgram(), [](const Gl& gl, GLuint id) { gl.DeleteProgram(id); });
  ShaderSource source;
  GLint ok = 0;
  char log[4096] = {};
  std::string beyond;
  for (const auto& [stage, file] : stages) {
    source = shader_source(file, definitions);
    text_ += source.text;
    if (beyond.empty()) beyond = beyond_storage(file, stage, source.text, definitions, context);
    files_ += (files_.empty() ? "gpu/" : ", gpu/") + file;
    const Handle shader(context, gl.CreateShader(stage), [](const Gl& gl, GLuint id) { gl.DeleteShader(id); });
    const char* text = source.text.c_str();
    gl.ShaderSource(shader, 1, &text, nullptr);
    gl.CompileShader(shader);
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (!ok) {
      if (!beyond.empty()) throw Unavailable("gpu: " + beyond);
      gl.GetShaderInfoLog(shader, sizeof log, nullptr, log);
      throw Error(refusal("gpu/" + file, "refused", context_, log, source));
    }
    gl.AttachShader(id_, shader);  // lives on in the program
  }
  gl.LinkProgram(id_);
  gl.GetProgramiv(id_, GL_LINK_STATUS, &ok);
  if (!ok) {
    if (!beyond.empty()) throw Unavailable("gpu: " + beyond);
    gl.GetProgramInfoLog(id_, sizeof log, nullptr, log);
    throw Error(refusal(files_, "not linked", context_, log, source));
  }
  context_.check("compiling " + files_);
  for (const auto& [stage, file] : stages) dump_shader(shader_source(file, definitions));
  context_.label(GL_PROGRAM, id_, files_);
}

void LinkedProgram::begin_count(GLenum statistic) {
  GLuint id = 0;
  context_.gl().GenQueries(1, &id);  // Mesa's CreateQueries knows no statistics
  count_ = Handle(context_, id, [](const Gl& gl, GLuint query) { gl.DeleteQueries(1, &query); });
  context_.gl().BeginQuery(statistic, count_);
}

void LinkedProgram::require_count(GLenum statistic, long invocations) {
  GLuint64 counted = 0;
  context_.gl().EndQuery(statistic);
  context_.gl().GetQueryObjectui64v(count_, GL_QUERY_RESULT, &counted);
  count_ = Handle();
  context_.check("running " + files_);
  if (counted != GLuint64(invocations))
    throw Error(fmt::format("gpu: {} ran {} invocations of {}, expected {}: its driver made no pipeline for it",
                            context_.renderer(), counted, files_, invocations));
  ran_ = true;
}

std::optional<LinkedProgram::Place> LinkedProgram::place_of(const std::string& variable) const {
  const Gl& gl = context_.gl();
  const GLuint index = gl.GetProgramResourceIndex(id_, GL_BUFFER_VARIABLE, variable.c_str());
  if (index == GL_INVALID_INDEX) return place_of_uniform(variable);
  const GLenum wanted[2] = {GL_OFFSET, GL_TOP_LEVEL_ARRAY_STRIDE};
  GLint found[2] = {0, 0};
  gl.GetProgramResourceiv(id_, GL_BUFFER_VARIABLE, index, 2, wanted, 2, nullptr, found);
  return Place{found[0], found[1]};
}

std::optional<LinkedProgram::Place> LinkedProgram::place_of_uniform(const std::string& variable) const {
  const Gl& gl = context_.gl();
  const GLuint index = gl.GetProgramResourceIndex(id_, GL_UNIFORM, variable.c_str());
  if (index == GL_INVALID_INDEX) return std::nullopt;
  const GLenum wanted = GL_OFFSET;
  GLint offset = 0;
  gl.GetProgramResourceiv(id_, GL_UNIFORM, index, 1, &wanted, 1, nullptr, &offset);
  return Place{offset, 0};
}

int LinkedProgram::location(const std::string& name) {
  const auto known = locations_.find(name);
  if (known != locations_.end()) return known->second;
  if (text_.find(name.substr(0, name.find('['))) == std::string::npos)  // of an array, its name
    throw Error(fmt::format("{} has no uniform '{}'", files_, name));
  return locations_[name] = context_.gl().GetUniformLocation(id_, name.c_str());
}

void LinkedProgram::set(const std::string& name, int value) {
  context_.gl().ProgramUniform1i(id_, location(name), value);
}
void LinkedProgram::set(const std::string& name, float value) {
  context_.gl().ProgramUniform1f(id_, location(name), value);
}
void LinkedProgram::set(const std::string& name, const Vec3& v) {
  context_.gl().ProgramUniform3f(id_, location(name), float(v[0]), float(v[1]), float(v[2]));
}
void LinkedProgram::set(const std::string& name, const Mat3& m) {
  const Eigen::Matrix3f f = m.cast<float>();
  context_.gl().ProgramUniformMatrix3fv(id_, location(name), 1, GL_FALSE, f.data());
}
void LinkedProgram::set_double(const std::string& name, double value) {
  context_.gl().ProgramUniform1d(id_, location(name), value);
}
void LinkedProgram::set_double(const std::string& name, const Vec3& v) {
  context_.gl().ProgramUniform3d(id_, location(name), v[0], v[1], v[2]);
}

}  // namespace airlight::gpu
