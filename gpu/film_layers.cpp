#include "gpu/film_layers.h"

namespace airlight::gpu {

void bind_film_layers(Frame& frame, std::size_t pixels, Program& p, const LayerBlocks& at, const KeptLayers& kept) {
  const auto bind = [&](const char* name, int block, bool is_kept) {
    // A block must have a buffer, read or not.
    const Buffer& buffer = frame.buffers.get(is_kept ? name : "mean", 12 * pixels);
    buffer.bind(block);
    if (is_kept) frame.download.add(name, buffer, 12 * pixels);
  };
  bind("mean", at.mean, true);
  bind("transmittance", at.transmittance, true);
  bind("surface", at.surface, true);
  bind("airlight", at.airlight, kept.airlight);
  bind("ambient", at.ambient, kept.ambient.has_value());
  p.set("has_airlight", kept.airlight);
  p.set("has_ambient", kept.ambient.has_value());
  p.set("ambient", kept.ambient.value_or(Rgb::Zero()));
}

}  // namespace airlight::gpu
