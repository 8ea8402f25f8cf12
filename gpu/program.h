// A compute program: a shader file with definitions, its uniforms by name, its dispatch.
#pragma once
#include "gpu/buffer.h"
#include "gpu/linked_program.h"

namespace airlight::gpu {

class Program : public LinkedProgram {
 public:
  // Compiles gpu/<file> (shader_source.h). Throws Error with file and line if the compiler objects. Shaders declare
  // their local size with LOCAL_SIZE_X, _Y, _Z of the definitions, 1 where not given. Throws Unavailable if the
  // device has no such groups.
  Program(Context&, const std::string& file, const std::map<std::string, std::string>& definitions);

  // Runs enough work groups for `x` * `y` * `z` invocations, then a barrier for everything that follows. Throws Error
  // if a limit of the device is passed or the driver objects. An empty size dispatches nothing. Counted in
  // dispatches().
  void dispatch(int x, int y = 1, int z = 1);

  // Dispatches three numbers of groups that the device has written at `offset` of a buffer.
  void dispatch_indirect(const Buffer& groups, std::size_t offset);

  // Dispatches of all programs of this process so far.
  static long dispatches();

 private:
  template <class Dispatch>
  void run(Dispatch, long groups);

  int local_[3];
};

}  // namespace airlight::gpu
