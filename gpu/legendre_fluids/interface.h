// What host and shaders of this method must agree about, said once.
#pragma once
#include <map>
#include <string>

#include "gpu/program.h"

namespace airlight::gpu::legendre {

// Storage blocks, AT_... in shaders. What no shader has at the same time shares a number.
namespace at {
enum Binding {
  start = 1,
  state = 2,
  rates = 3,
  pressure = 4,
  spread = 5,
  status = 6,
  gathered = 7,
  regions = 0,
  // a uniform block
  matrices = 0,
};
}  // namespace at

// Where expand.comp goes on to, and collect.comp comes from.
enum class GoesOn { nowhere, to_points, to_modes };
enum class ComesFrom { points, modes, forces };

using Definitions = std::map<std::string, std::string>;

// A program of this folder: `file` without folder and .comp, a work group of x invocations.
Program& program(Context&, const std::string& file, int x, Definitions definitions);

}  // namespace airlight::gpu::legendre
