#include "experiments/driver/pictures.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "experiments/application/folders.h"

namespace airlight::experiments {
namespace {

// Without standard errors and batches an image counts as exact.
scene::Film without_noise_layers(scene::Film film) {
  for (auto it = film.layers.begin(); it != film.layers.end();) {
    const std::string& name = it->first;
    const bool noise = name == "se" || name.ends_with(".se") || name.find("batch.") != std::string::npos;
    it = noise ? film.layers.erase(it) : std::next(it);
  }
  return film;
}

}  // namespace

std::string file_name(const std::string& text) {
  std::string out;
  for (const char c : text) out += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.' ? c : '_';
  if (out.starts_with('.')) out.front() = '_';  // else "..", the folder above, or a hidden file
  return out;
}

std::string picture_name(const std::string& method, const std::string& setting) {
  return file_name(setting.empty() ? method : method + "_" + setting);
}

double exposure_of(const scene::Film& film, const std::string& layer) {
  std::vector<double> y;
  const std::vector<float>& v = film.layer(layer);
  for (std::size_t i = 0; i + 2 < v.size(); i += 3) y.push_back(luminance(Rgb(v[i], v[i + 1], v[i + 2])));
  if (y.empty()) return 0;
  const auto at = y.begin() + std::ptrdiff_t(0.99 * double(y.size() - 1));
  std::nth_element(y.begin(), at, y.end());
  return *at > 0 ? std::log2(0.8 / *at) : 0;
}

std::vector<Measure> compare(const Experiment& e, const MethodCase& m, const scene::Film& film,
                             const scene::Film& reference, const scene::Film& converted, const Masks& masks) {
  if (m.picture_only) return {};
  std::vector<Measure> all;
  for (const std::string& metric : e.metrics) {
    const scene::Film& truth = is_of_converted(metric) ? converted : reference;
    const auto noise = m.count_noise ? ImageNoise::counted : ImageNoise::removed;
    const std::vector<Measure> one = measure({metric}, film, truth, e.layer, masks, noise);
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

void keep_picture(const std::filesystem::path& images, const std::string& name, const scene::Film& film,
                  const std::string& layer, double exposure) {
  const std::filesystem::path file = images / name;
  make_folder(file.parent_path());
  require_finite(film, file.string() + ".exr");  // the noise layers too, which decide on intervals
  scene::write_exr(file.string() + ".exr", without_noise_layers(film));
  scene::write_png(file.string() + ".png", film, layer, exposure);
}

}  // namespace airlight::experiments
