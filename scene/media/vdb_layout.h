// The layout of OpenVDB files (format versions 222 to 224, since 2013), byte by byte: does a file hold whole grids?
//
// OpenVDB trusts what it reads: past the end of a file it leaves values at zero without an error, and a damaged length
// makes it write beyond its buffers. Here every length is checked before OpenVDB sees the file; nothing is decoded. All
// functions throw std::runtime_error that says what is wrong.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace airlight::scene {

struct VdbEntry {
  std::string name;
  std::string type;            // as OpenVDB calls it: "Tree_float_5_4_3", "Tree_vec3s_5_4_3_HalfFloat", ...
  std::string unique_name;     // the name and, where several grids have it, a number behind a separator
  std::string parent;          // unique name of the grid whose samples it shares; empty: it has its own
  std::size_t descriptor = 0;  // byte where its entry begins
  std::size_t begin = 0;       // of its metadata, transform and samples
  std::size_t end = 0;
};

// The grids of a file, in its order; their byte ranges lie within it.
std::vector<VdbEntry> vdb_grids(std::string_view file);

// "Tree_float_5_4_3" or "Tree_vec3s_5_4_3", stored as float or half.
bool is_of_type(const VdbEntry&, std::string_view type);

// Walks through a grid of one of these types: it must end exactly where its entry says, and its two copies of every
// mask of active voxels must agree.
void check_grid(std::string_view file, const VdbEntry&);

// The grids of the file at this path, by the library of OpenVDB (vdb_module.h). Throws Error.
std::vector<VdbEntry> list_vdb(const std::string& path);

}  // namespace airlight::scene
