#include "reference/light_map/options.h"

#include <fmt/format.h>

namespace airlight::light_map {

std::string encoding_name(Encoding encoding) {
  switch (encoding) {
    case Encoding::slices:
      return "slices";
    case Encoding::avsm:
      return "avsm";
    case Encoding::fourier:
      return "fourier";
    case Encoding::beer:
      break;
  }
  return "beer";
}

int floats_per_texel(const Options& o) {
  switch (o.encoding) {
    case Encoding::slices:
      return o.slices + 1;
    case Encoding::avsm:
      return 2 * o.nodes;
    case Encoding::fourier:
      return o.coefficients;
    case Encoding::beer:
      break;
  }
  return 3;
}

double bytes_per_plane(const Options& o) { return 4.0 * (o.size + 2.0) * (o.size + 2.0) * floats_per_texel(o); }

void bind(scene::SettingBinder& b, Options& o, const std::string& setting) {
  b.choice("map_encoding", o.encoding,
           {{"slices", Encoding::slices},
            {"avsm", Encoding::avsm},
            {"fourier", Encoding::fourier},
            {"beer", Encoding::beer}},
           "what a texel of a light's map holds: optical depths at equal distances, adaptive nodes, a Fourier series, "
           "or front, mean and total")
      .where(setting, {"map"});
  b.integer("map_size", o.size, 1, most_size, "texels a side of a light's map").where(setting, {"map"});
  b.integer("map_steps", o.steps, 1, most_steps, "steps along the ray of each texel of a light's map")
      .where(setting, {"map"});
  b.integer("map_slices", o.slices, 1, most_slices, "intervals between the optical depths that a texel holds")
      .where(setting, {"map"})
      .where("map_encoding", {"slices"});
  b.integer("map_nodes", o.nodes, 2, most_nodes, "nodes of a texel's transmittance")
      .where(setting, {"map"})
      .where("map_encoding", {"avsm"});
  b.integer("map_coefficients", o.coefficients, 1, most_coefficients,
            "coefficients of a texel's Fourier series, an odd number")
      .where(setting, {"map"})
      .where("map_encoding", {"fourier"});
}

std::string unsupported(const Options& o) {
  if (o.encoding == Encoding::fourier && o.coefficients % 2 == 0)
    return fmt::format("map_coefficients = {} is even, expected an odd number: a constant and pairs", o.coefficients);
  // Texels are addressed by 32-bit integers.
  if (bytes_per_plane(o) / 4 > 2147483647.0)
    return fmt::format("map_size = {} with {} floats a texel is {:.3g} floats, expected at most 2147483647", o.size,
                       floats_per_texel(o), bytes_per_plane(o) / 4);
  return "";
}

}  // namespace airlight::light_map
