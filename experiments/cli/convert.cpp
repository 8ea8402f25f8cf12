#include <fmt/format.h>

#include <bit>
#include <filesystem>

#include "experiments/cli/commands.h"
#include "scene/atomic_file.h"
#include "scene/error.h"
#include "scene/film.h"

namespace airlight::experiments::cli {
namespace {

std::string kind_of(const std::string& out) {
  const std::string kind = std::filesystem::path(out).extension().string();
  if (kind != ".png" && kind != ".pfm") throw Error(fmt::format("{}: expected a name in .png or .pfm", out));
  return kind;
}

void convert(const std::string& in, const std::string& out, const ConvertOptions& options) {
  const scene::Film film = scene::read_exr(in);
  if (kind_of(out) == ".png") {
    scene::write_png(out, film, options.layer, options.exposure);
    return;
  }
  static_assert(std::endian::native == std::endian::little);
  const std::vector<float>& values = film.layer(options.layer);
  std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", film.width, film.height);
  const std::size_t row = std::size_t(film.width) * 3;
  for (int y = film.height - 1; y >= 0; --y)  // rows from bottom to top
    bytes.append(reinterpret_cast<const char*>(values.data() + row * std::size_t(y)), row * sizeof(float));
  scene::write_file_atomically(out, bytes);
}

}  // namespace

int convert(const ConvertOptions& options) {
  for (std::size_t i = 0; i < options.files.size(); i += 2) kind_of(options.files[i + 1]);
  for (std::size_t i = 0; i < options.files.size(); i += 2) convert(options.files[i], options.files[i + 1], options);
  return 0;
}

}  // namespace airlight::experiments::cli
