#include "gpu/raster_program.h"

#include <atomic>

namespace airlight::gpu {
namespace {

std::atomic<long> draw_count{0};

}  // namespace

long RasterProgram::draws() { return draw_count; }

RasterProgram::RasterProgram(Context& context, const std::string& name,
                             const std::map<std::string, std::string>& definitions)
    : LinkedProgram(context, {{GL_VERTEX_SHADER, name + ".vert"}, {GL_FRAGMENT_SHADER, name + ".frag"}}, definitions) {}

void RasterProgram::draw(long vertices, int instances) {
  if (vertices <= 0 || instances <= 0) return;
  const Gl& gl = context_.gl();
  GLuint nothing = 0;  // core contexts want a vertex array, also an empty one
  gl.CreateVertexArrays(1, &nothing);
  gl.BindVertexArray(nothing);
  gl.UseProgram(id_);
  constexpr GLenum invocations = 0x82F0;  // GL_VERTEX_SHADER_INVOCATIONS_ARB
  watch(invocations, vertices * instances,
        [&] { gl.DrawArraysInstanced(GL_TRIANGLES, 0, GLsizei(vertices), instances); });
  gl.BindVertexArray(0);
  gl.DeleteVertexArrays(1, &nothing);
  ++draw_count;
  ++context_.traffic().draws;
  context_.check_closely(files_);
}

}  // namespace airlight::gpu
