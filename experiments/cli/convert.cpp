#include <fmt/format.h>

#include <bit>
#include <filesystem>

#include "experiments/cli/commands.h"
#include "scene/atomic_file.h"
#include "scene/error.h"
#include "scene/film.h"

namespace airlight::experiments::cli {

int convert(const ConvertOptions& options) {
  const std::string kind = std::filesystem::path(options.out).extension().string();
  if (kind != ".png" && kind != ".pfm") throw Error(fmt::format("{}: expected a name in .png or .pfm", options.out));
  const scene::Film film = scene::read_exr(options.in);
  if (kind == ".png") {
    scene::write_png(options.out, film, options.layer, options.exposure);
    return 0;
  }
  static_assert(std::endian::native == std::endian::little);
  const std::vector<float>& values = film.layer(options.layer);
  std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", film.width, film.height);
  const std::size_t row = std::size_t(film.width) * 3;
  for (int y = film.height - 1; y >= 0; --y)  // rows from bottom to top
    bytes.append(reinterpret_cast<const char*>(values.data() + row * std::size_t(y)), row * sizeof(float));
  scene::write_file_atomically(options.out, bytes);
  return 0;
}

}  // namespace airlight::experiments::cli
