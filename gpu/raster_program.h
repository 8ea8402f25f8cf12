// A raster program: a vertex and a fragment shader of one name, and its draw call.
#pragma once
#include "gpu/linked_program.h"

namespace airlight::gpu {

class RasterProgram : public LinkedProgram {
 public:
  // Compiles gpu/<name>.vert and gpu/<name>.frag. Throws Error with file and line if the compiler objects.
  RasterProgram(Context&, const std::string& name, const std::map<std::string, std::string>& definitions);

  // Draws `instances` times `vertices` vertices as triangles into the framebuffer that is bound. There are no vertex
  // arrays: shaders fetch what they need from storage buffers by gl_VertexID and gl_InstanceID. Nothing to draw is no
  // call. Counted in draws().
  void draw(long vertices, int instances = 1);

  // Draws of all programs of this process so far.
  static long draws();
};

}  // namespace airlight::gpu
