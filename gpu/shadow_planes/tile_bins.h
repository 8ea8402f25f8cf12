// Lists of the silhouette edges that the rays of each tile of 16 x 16 pixels may cross, by way of blocks of 128 x 128.
#pragma once
#include <memory>

#include "gpu/shadow_planes/silhouettes.h"
#include "scene/renderer.h"

namespace airlight::gpu {

class TileBins {
 public:
  static constexpr int tile = 16, block = 128;  // pixels

  explicit TileBins(Context& context) : context_(context), needed_(context, "room for lists", 4) {}

  // Fills the lists of a view. Where they have no room they are made greater and filled again, which overflows()
  // counts. Throws Unavailable where one storage block cannot hold them.
  void fill(const scene::View&, const Point3& light, const LightEdges&);

  // Binds 3 (first and count of every tile's edges), 4 (the edges' places).
  void bind() const;
  static int columns(const scene::View& view) { return (view.width + tile - 1) / tile; }

  int entries() const { return entries_; }      // of all tiles' lists together
  int overflows() const { return overflows_; }  // so far

 private:
  struct Level {
    std::unique_ptr<Buffer> ranges, lists;
  };
  int fill(Level&, const Level* parent, int side, const scene::View&, const Point3& light, const LightEdges&);

  Context& context_;
  Buffer needed_;
  Level blocks_, tiles_;
  int entries_ = 0, overflows_ = 0;
};

}  // namespace airlight::gpu
