// The shaders as they were compiled into the program, or from the folder AIRLIGHT_SHADERS while one works on them.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace airlight::gpu {

// A shader's text with its includes in place, ready for the compiler.
struct ShaderSource {
  std::string text;
  std::vector<std::string> files;  // by the number that #line gives them, which compilers put into their messages
};

// `file` is relative to gpu/, e.g. "common/erf.glsl"; `#include "..."` likewise, each file at most once. `version` and
// `definitions` stand in front, and common/ulp_errors.glsl where the variable AIRLIGHT_GPU_ULPS is set. Throws Error
// (file, line, what was found) where an include leads nowhere.
ShaderSource shader_source(const std::string& file, const std::map<std::string, std::string>& definitions);

// The relative error that AIRLIGHT_GPU_ULPS puts into exp, log, sqrt, sin and cos; 0 without it. For bounds close to rounding.
double injected_error();

// Where the variable AIRLIGHT_DUMP_SHADERS names a folder: writes the text there, once for each variant, under the name
// of its file, what of its content tells variants apart, and the ending of its stage (scripts/check_shaders reads them).
// Throws Error if it cannot.
void dump_shader(const ShaderSource&);

// A compiler's message with names of files in place of their numbers: "gpu/common/erf.glsl:12: ...".
std::string with_file_names(const std::string& message, const ShaderSource&);

// Empty for the shaders that were compiled in; else the content of all files of the folder AIRLIGHT_SHADERS, as hex
// digits: a result that they made is not one of the others. Throws Error if the folder cannot be read.
std::string foreign_shaders();

// All files that were compiled in, by name; made by cmake/embed_files.cmake.
const std::map<std::string, std::string>& embedded_shaders();

}  // namespace airlight::gpu
