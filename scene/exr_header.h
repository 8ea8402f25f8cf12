// The header of an OpenEXR file, before OpenEXR reads it.
#pragma once
#include <string>

namespace airlight::scene {

// Walks the attributes (name, type, size, value): OpenEXR would allocate any size it is told. Throws Error, one line: no
// such file, no EXR, truncated, damaged, deep or multi-part.
void check_exr_attributes(const std::string& path);

}  // namespace airlight::scene
