// A compute program: a shader file with definitions, its uniforms by name, its dispatch.
#pragma once
#include <map>
#include <string>

#include "gpu/context.h"
#include "scene/math/types.h"

namespace airlight::gpu {

class Program {
 public:
  // Compiles gpu/<file> (shader_source.h). Throws Error with file and line if the compiler objects. Shaders declare
  // their local size with LOCAL_SIZE_X, _Y, _Z of the definitions, 1 where not given; their product is at most 128.
  Program(Context&, const std::string& file, const std::map<std::string, std::string>& definitions);
  ~Program();
  Program(const Program&) = delete;

  // A name that the shader does not mention is an error; one that the compiler removed is not.
  void set(const std::string& name, int value);
  void set(const std::string& name, float value);
  void set(const std::string& name, double value) { set(name, float(value)); }
  void set(const std::string& name, bool value) { set(name, int(value)); }
  void set(const std::string& name, const Vec3& value);
  void set(const std::string& name, const Rgb& value) { set(name, Vec3(value.matrix())); }
  void set(const std::string& name, const Mat3& value);

  // Runs enough work groups for `x` * `y` * `z` invocations, then a barrier for everything that follows. Throws Error
  // if a limit of the device is passed or the driver objects. An empty size dispatches nothing. Counted in
  // dispatches().
  void dispatch(int x, int y = 1, int z = 1);

  // Of all programs of this process so far.
  static long dispatches();

 private:
  int location(const std::string& name);

  Context& context_;
  std::string file_, text_;
  GLuint id_ = 0;
  int local_[3];
  std::map<std::string, int> locations_;
};

}  // namespace airlight::gpu
