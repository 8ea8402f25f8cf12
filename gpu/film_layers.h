// The film's layers on the device, for common/film_layers.glsl: every method's composition.
#pragma once
#include "gpu/frame.h"
#include "gpu/program.h"

namespace airlight::gpu {

// Storage blocks of the layers, as a method numbers them.
struct LayerBlocks {
  int mean, transmittance, surface, airlight, ambient;
};

// Which parts have layers of their own beside mean, transmittance and surface. A part that is left out
// is not added to the mean.
struct KeptLayers {
  bool airlight = true;
  std::optional<Rgb> ambient;  // the scene's ambient_in_scatter [W/m^2/sr]
};

// Binds the frame's buffers of these layers, of 3 floats a pixel, notes them for the download, and sets the program's
// uniforms.
void bind_film_layers(Frame&, std::size_t pixels, Program&, const LayerBlocks&, const KeptLayers&);

}  // namespace airlight::gpu
