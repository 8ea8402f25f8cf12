// Common part of compute and raster programs: compiled stages linked together, and uniforms by name.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gpu/context.h"
#include "scene/math/types.h"

namespace airlight::gpu {

class LinkedProgram {
 public:
  // Compiles gpu/<file> of each stage (shader_source.h) with the same definitions. Throws Error with file and line if
  // the compiler or the linker objects, Unavailable in one line if for more storage blocks than the device has.
  LinkedProgram(Context&, const std::vector<std::pair<GLenum, std::string>>& stages,
                const std::map<std::string, std::string>& definitions);
  LinkedProgram(const LinkedProgram&) = delete;

  // A name that no stage mentions is an error; one that the compiler removed is not.
  void set(const std::string& name, int value);
  void set(const std::string& name, float value);
  void set(const std::string& name, double value) { set(name, float(value)); }
  void set(const std::string& name, bool value) { set(name, int(value)); }
  void set(const std::string& name, const Vec3& value);
  void set(const std::string& name, const Rgb& value) { set(name, Vec3(value.matrix())); }
  void set(const std::string& name, const Mat3& value);
  void set_double(const std::string& name, double value);       // a uniform double
  void set_double(const std::string& name, const Vec3& value);  // a uniform dvec3

  // Where the driver has a variable of a storage block, "edges[0].a[0]": bytes from the block's beginning, and between
  // the elements of the block's array that it is in (0: in none, or the block is a uniform one). Nothing where the compiler removed it.
  struct Place {
    int offset, stride;
  };
  std::optional<Place> place_of(const std::string& variable) const;

 protected:
  // Does `work`, a dispatch or a draw of so many invocations. Where the driver makes pipelines late, the first time counts them by
  // `statistic` (of ARB_pipeline_statistics_query) and throws Error if the number is another.
  template <class Work>
  void watch(GLenum statistic, long invocations, Work work) {
    const bool first = is_watched() && invocations > 0;
    if (first) begin_count(statistic);
    work();
    if (first) require_count(statistic, invocations);
  }
  bool is_watched() const { return !ran_ && context_.makes_pipelines_late(); }

  Context& context_;
  std::string files_;  // for messages: "gpu/a.vert, gpu/a.frag"
  Handle id_;

 private:
  std::optional<Place> place_of_uniform(const std::string& variable) const;
  int location(const std::string& name);
  void begin_count(GLenum statistic);
  void require_count(GLenum statistic, long invocations);

  std::string text_;
  std::map<std::string, int> locations_;
  bool ran_ = false;  // seen to run
  Handle count_;
};

}  // namespace airlight::gpu
