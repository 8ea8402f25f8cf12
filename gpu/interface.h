// Interface between host and shaders of a method: numbers of storage blocks as definitions, layouts of structures.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "gpu/linked_program.h"

namespace airlight::gpu {

struct Binding {
  const char* name;  // AT_<name> in shaders
  int number;
};
void define(const std::vector<Binding>&, std::map<std::string, std::string>& definitions);

// Where the host has a variable of a storage block: bytes from the block's beginning, and between elements of the array
// that it is in (0: in none).
struct Layout {
  const char* variable;
  std::size_t offset, stride;
};
// Throws Error if the driver has one of them at another offset. Members that the compiler removed are not checked.
void check_layouts(const LinkedProgram&, const std::string& file, const std::vector<Layout>&);

}  // namespace airlight::gpu
