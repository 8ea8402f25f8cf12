// Transfers between host and device, counted where they are done: a frame's traffic is the difference of two of these.
#pragma once
#include <map>
#include <string>

namespace airlight::gpu {

struct Traffic {
  long bytes_up = 0, bytes_down = 0;  // of buffers and textures; uniforms are not counted
  long syncs = 0;                     // waits of the host for the device
  long allocations = 0;               // buffers, textures, queries, framebuffers
  long dispatches = 0, draws = 0;
  long program_look_ups = 0;  // of programs by file and definitions

  // Counters by the names of Rendering::counters. Counters of Prepared::next begin with "next_".
  std::map<std::string, double> counters(const std::string& prefix = "") const {
    return {{prefix + "bytes_up", double(bytes_up)},
            {prefix + "bytes_down", double(bytes_down)},
            {prefix + "syncs", double(syncs)},
            {prefix + "allocations", double(allocations)},
            {prefix + "dispatches", double(dispatches)},
            {prefix + "draws", double(draws)},
            {prefix + "program_look_ups", double(program_look_ups)}};
  }
};

inline Traffic operator-(const Traffic& a, const Traffic& b) {
  return {a.bytes_up - b.bytes_up,
          a.bytes_down - b.bytes_down,
          a.syncs - b.syncs,
          a.allocations - b.allocations,
          a.dispatches - b.dispatches,
          a.draws - b.draws,
          a.program_look_ups - b.program_look_ups};
}

}  // namespace airlight::gpu
