// Optical depth towards one light, prepared: a map of texels seen from the light, each with the optical depth along its
// ray (encoding.h). It stands for shadow rays through media: a look-up costs the same however far the light is.
//
// The map holds the varying density. A constant density (homogeneous media, the constant under Gaussians) is added in
// closed form, which is exact at its boundary, cheaper than a lookup, and works for unbounded media. Varying densities
// are bounded, so that a map's depths always have an end.
//
// Texels hold optical depths of all media together, in float. Encodings approximate exp(-optical depth) of the sum, which
// is no sum over media, and a look-up costs the same for any number of them. They hold three, one for each colour
// channel; one where every medium is grey, or where only one varies: the channels are then multiples of each other, and
// so are their encodings, but for avsm, which bends where its own channel does.
//
// Error: order 2 in a texel's side and in the steps' length where the density is smooth; order 1 where it jumps across
// the light's rays. Encodings: README.md.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "reference/light_map/encoding.h"
#include "reference/light_map/kernels.h"
#include "reference/light_map/projection.h"
#include "scene/media/medium.h"
#include "scene/renderer.h"

namespace airlight::light_map {

// The varying part of a medium's density: its density minus its constant_part, at n points in its region; `medium` is
// the number of the medium. Arrays have room for n rounded up to a multiple of 64. Called from several threads.
using Densities = std::function<void(std::size_t medium, std::size_t n, const double* x, const double* y,
                                     const double* z, float* density)>;

// Densities by the media's own functions, in double; the media must live as long as they do.
Densities densities_of(const std::vector<scene::Medium>&);

// The media that vary, as the maps of all lights hold them.
struct VariedMedia {
  struct Part {
    std::size_t number;  // of the medium
    const scene::Medium* medium;
    Box box;         // where it varies
    Rgb extinction;  // at density 1, of the planes [1/m]
    Interval extent(const Ray&, Interval t) const;
  };
  std::vector<Part> parts;
  Box box;                  // of all parts
  int planes = 0;           // optical depths of a texel: 0 (nothing varies), 1 or 3
  bool grey = true;         // all that varies is
  Rgb share = Rgb::Ones();  // of a channel in the plane that it is read from
  bool negative = false;    // a medium may have less than its constant
};
// The media must live as long.
VariedMedia varied_media(const std::vector<scene::Medium>&, const Options&);

// Memory of a light's map.
double bytes_of_map(const VariedMedia&, const Options&);

class LightMap {
 public:
  // The light must shine from one direction (is_delta). Throws Error where `options` are unsupported. Its bits do not
  // depend on the threads.
  LightMap(const scene::Light&, const std::vector<scene::Medium>&, const Options&, const Densities&,
           const scene::Execution&);

  // Optical depth from x to the light [-] per channel, infinite where a constant goes on for ever. Where a spot does not
  // shine what varies is left out. Surfaces do not count.
  Rgb optical_depth(const Point3& x) const;
  // The part of it that is in the map, and the rest.
  Rgb varied_depth(const Point3& x) const;
  Rgb constant_depth(const Point3& x) const;
  // The optical depths in the map at n points, in single precision, by vector kernels: depth[c] for each of channels(). Arrays have room for n
  // rounded up to a multiple of 64.
  void varied_depths(std::size_t n, const double* x, const double* y, const double* z, float* const* depth) const;

  // 1 where all that varies is grey, else 3.
  int channels() const { return varied_.grey ? 1 : 3; }
  bool empty() const { return varied_.planes == 0; }
  std::size_t bytes() const;
  const Projection& projection() const { return projection_; }
  // The floats of texel (i, j), i and j from -1 to size; the outermost repeat their neighbours on the map.
  const float* texel(int plane, int i, int j) const;

 private:
  struct Row;
  struct Constant {
    scene::Region region;
    Rgb extinction;  // [1/m]
  };
  void make_texels(const Densities&, const scene::Execution&);
  void march(const Densities&, int j, int begin, int end, Row&) const;
  void make_border();
  std::size_t offset(int i, int j) const;
  MapView view(int plane) const;

  scene::Light light_;
  std::vector<Constant> constants_;
  Options options_;
  Projection projection_;
  VariedMedia varied_;
  std::vector<float> texels_[3];
};

// The maps of all lights, in their order. `lights_before` and `before`: of a frame with the same media, densities and options, whose maps of
// lights with the same rays are shared; none, or as many of both. `made` is the number of the others. Throws Error, which begins with `who`,
// where they do not fit into memory.
struct Maps {
  std::vector<std::shared_ptr<const LightMap>> of_lights;
  int made = 0;
};
Maps make_maps(const std::vector<scene::Light>&, const std::vector<scene::Medium>&, const Options&, const Densities&,
               const scene::Execution&, const std::string& who, const std::vector<scene::Light>& lights_before = {},
               const std::vector<std::shared_ptr<const LightMap>>& before = {});

}  // namespace airlight::light_map
