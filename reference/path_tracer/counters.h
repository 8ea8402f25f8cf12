// Statistics of a render. Counters are integers, so that their sums do not depend on the order of threads.
#pragma once
#include <cstdint>
#include <map>
#include <string>

namespace airlight::path_tracer {

struct Counters {
  std::uint64_t paths = 0;
  std::uint64_t rays = 0;        // path segments: camera, after scatterings, after reflections
  std::uint64_t lookups = 0;     // density evaluations by tracking, real and null collisions
  std::uint64_t collisions = 0;  // real ones
  std::uint64_t columns = 0;     // noise-free optical depths of one medium along one segment
  std::uint64_t shadow_rays = 0;
  std::uint64_t connections = 0;
  std::uint64_t violations = 0;  // density above its majorant: a render with any is void

  Counters& operator+=(const Counters& o) {
    paths += o.paths;
    rays += o.rays;
    lookups += o.lookups;
    collisions += o.collisions;
    columns += o.columns;
    shadow_rays += o.shadow_rays;
    connections += o.connections;
    violations += o.violations;
    return *this;
  }
  std::map<std::string, double> named() const {
    return {{"paths", double(paths)},
            {"rays", double(rays)},
            {"density_lookups", double(lookups)},
            {"collisions", double(collisions)},
            {"mean_collisions", paths ? double(collisions) / double(paths) : 0.0},
            {"columns", double(columns)},
            {"shadow_rays", double(shadow_rays)},
            {"connections", double(connections)},
            {"majorant_violations", double(violations)}};
  }
};

}  // namespace airlight::path_tracer
