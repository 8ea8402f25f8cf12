// Light of suns that the media scatter once, in the shadow of surfaces: the twin of methods/wavelet_fog/sun_scattering.h.
//
// A ray takes as many rounds of two dispatches as it needs, one that looks for edges of shadows and one that sums up the light between
// them: the first frame looks after each whether any ray is left, later ones take twice as many rounds without a look.
#pragma once
#include "gpu/raster/first_hits.h"
#include "gpu/wavelet_fog/leveled_fog.h"
#include "methods/wavelet_fog/sun_map.h"

namespace airlight::gpu::wavelet_fog {

using Fogs = std::vector<std::unique_ptr<FogOnDevice>>;

class SunOnDevice {
 public:
  // The fogs outlive this, and what ends the rays, which may be null where there are no surfaces.
  SunOnDevice(Context&, const scene::Scene&, const Fogs&, const FirstHits*, const airlight::wavelet_fog::Options&);

  // After the fogs became others; after they were refreshed.
  void write();
  void refresh();

  // Adds up all suns of the scene to `airlight`, 3 floats a pixel. Maps of columns are made for each sun in every frame.
  void render(const scene::Scene&, const scene::View&, FrameBuffers&, const Buffer* distances, const Buffer& airlight,
              const Buffer& counters, bool counts);
  // By the counters of the last frame: rays were left, and it is to be drawn again; then it looks.
  bool left_rays(const std::vector<unsigned>& counters);

 private:
  void compile();
  void bind_media() const;
  void fill_maps(const Vec3& to_sun, FrameBuffers&, const Buffer& unused);
  void begin(const scene::View&, const Buffer* distances, bool counts);
  void march(const scene::View&, int first_row, int rows, const Buffer& counters);

  Context& context_;
  const Fogs& fogs_;
  const FirstHits* surfaces_;  // null: nothing shades
  airlight::wavelet_fog::Options options_;
  int points_ = 0;               // of a cell
  std::vector<Program*> steps_;  // by medium
  Program *sums_ = nullptr, *start_ = nullptr, *light_ = nullptr;
  Program *shadows_ = nullptr, *pack_ = nullptr;  // null: not needed
  // Buffers for several media together.
  std::unique_ptr<Buffer> media_, grids_, values_, emptiness_;
  std::vector<int> first_value_, first_word_;
  int rounds_ = 0, most_rounds_ = 0;   // that frames took; that this one took
  bool looks_ = true, looked_ = true;  // this frame; the one before
  int mark_ = 0;                       // of the last round that was asked
};

// Directional lights that shine.
std::vector<const scene::DirectionalLight*> suns_of(const scene::Scene&);

}  // namespace airlight::gpu::wavelet_fog
