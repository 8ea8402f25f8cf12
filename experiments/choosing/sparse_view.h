// Every n-th pixel of a film, along both axes: a small film whose pixels are pixels of the large one. A quick reference of these pixels judges
// a picture of the whole film, so that what depends on the film's size (froxels, half resolution) is judged as it will be seen.
#pragma once
#include "scene/renderer.h"

namespace airlight::experiments {

struct SparseView {
  scene::View whole;
  scene::View small;  // its pixel (x, y) is pixel (left + stride x, top + stride y) of the whole film
  int stride = 1;     // odd: then a pixel's centre is the centre of a pixel
  int left = 0, top = 0;
};

// The small film is about `width` pixels wide, as near as an odd stride allows, and has at least one pixel.
SparseView sparse_view(const scene::View& whole, int width);

// The pixels of the small film, all layers. The film is of the whole view.
scene::Film pick(const scene::Film& film, const SparseView&);

}  // namespace airlight::experiments
