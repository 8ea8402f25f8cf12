#include "scene/light/environment.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/base/file_ending.h"
#include "scene/film/color_image.h"
#include "scene/film/exr_header.h"
#include "scene/film/film.h"
#include "scene/light/lat_long.h"
#include "scene/light/lat_long_density.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::scene {

struct EnvironmentLight::Tables {
  LatLongDensity density;
};

namespace {

constexpr double uniform_share = 0.05;
constexpr double uniform_pdf = 1 / (4 * pi);

void check(const EnvironmentLight& light) {
  if (!light.scale.allFinite()) throw Error("environment: the radiance or scale is not finite");
  const Mat3& r = light.to_map;
  if (!(r * r.transpose()).isIdentity(1e-9) || !(r.col(0).dot(r.col(1).cross(r.col(2))) > 0))
    throw Error("environment: expected a rotation");
}

void check(const EnvironmentMap& map) {
  if (map.width < 1 || map.height < 1 || map.rgb.size() != 3 * std::size_t(map.width) * std::size_t(map.height))
    throw Error(fmt::format("environment map of {} x {} texels with {} values", map.width, map.height, map.rgb.size()));
  for (std::size_t i = 0; i < map.rgb.size(); ++i)
    if (!(map.rgb[i] >= 0) || !std::isfinite(map.rgb[i]))
      throw Error(fmt::format("texel ({}, {}) holds {}, expected finite values of at least 0", i / 3 % map.width,
                              i / 3 / map.width, map.rgb[i]));
}

// Lossy compression (DWA) leaves small negative values where a map is dark: what is below 1 % of the mean becomes 0.
void remove_residue(EnvironmentMap& map) {
  double sum = 0;
  for (const float v : map.rgb) sum += v > 0 ? v : 0;
  const double residue = 0.01 * sum / double(map.rgb.size());
  for (float& v : map.rgb)
    if (v < 0 && v >= -residue) v = 0;
}

// Null if there is nothing to prefer.
std::shared_ptr<const EnvironmentLight::Tables> make_tables(int width, int height, const std::vector<double>& values,
                                                            const std::vector<float>& rgb = {}) {
  auto tables =
      std::make_shared<EnvironmentLight::Tables>(EnvironmentLight::Tables{LatLongDensity(width, height, values, rgb)});
  return tables->density.positive() ? tables : nullptr;
}

Vec3 sample_uniform(double u1, double u2) {
  const double y = 1 - 2 * u1;
  return from_lat_long(u2, y, std::sqrt(std::max(0.0, 4 * u1 * (1 - u1))));
}

}  // namespace

EnvironmentLight make_constant_environment(const Rgb& radiance) {
  EnvironmentLight light;
  light.scale = radiance;
  light.source = "constant";
  check(light);
  if (!(radiance >= 0).all()) throw Error("environment: a negative radiance");
  return light;
}

EnvironmentLight make_map_environment(std::shared_ptr<const EnvironmentMap> map, const Mat3& to_map, const Rgb& scale,
                                      std::string source) {
  EnvironmentLight light;
  light.scale = scale;
  light.to_map = to_map;
  light.source = std::move(source);
  check(light);
  if (!map) throw Error("environment: no map");
  if (!(scale >= 0).all()) throw Error("environment: a negative scale");
  check(*map);
  std::vector<double> values(map->rgb.size() / 3);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = luminance(scale * Rgb(map->rgb[3 * i], map->rgb[3 * i + 1], map->rgb[3 * i + 2]));
  light.tables = make_tables(map->width, map->height, values, map->rgb);
  light.map = std::move(map);
  return light;
}

EnvironmentLight make_sh_environment(std::vector<Rgb> coefficients, const Mat3& to_map, const Rgb& scale) {
  const int order = int(std::lround(std::sqrt(double(coefficients.size()))));
  if (order < 1 || order > max_sh_order || std::size_t(order) * order != coefficients.size())
    throw Error(fmt::format("environment: {} spherical-harmonic coefficients, expected 1, 4, 9, ... {}",
                            coefficients.size(), max_sh_order * max_sh_order));
  for (const Rgb& c : coefficients)
    if (!c.allFinite()) throw Error("environment: a spherical-harmonic coefficient is not finite");
  EnvironmentLight light;
  light.scale = scale;
  light.to_map = to_map;
  light.sh = std::move(coefficients);
  light.source = "sh";
  check(light);
  const int height = std::max(16, 8 * order), width = 2 * height;
  std::vector<double> values;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const Vec3 w = from_lat_long(LatLong{(i + 0.5) / width, pi * (j + 0.5) / height});
      values.push_back(luminance((scale * evaluate_sh(light.sh, w)).abs()));
    }
  light.tables = make_tables(width, height, values);
  return light;
}

std::shared_ptr<const EnvironmentMap> read_environment_map(const std::string& path) {
  auto map = std::make_shared<EnvironmentMap>();
  if (file_ending(path) != ".exr") {
    ColorImage image = read_color_image(path);
    *map = {image.width, image.height, std::move(image.rgb)};
    return map;
  }
  const Film film = read_exr(path);
  if (is_cube_map(path))
    throw Error(fmt::format("{}: found a cube map, expected a map of longitude and latitude", path));
  map->width = film.width;
  map->height = film.height;
  try {
    map->rgb = film.layer("mean");
    remove_residue(*map);
    check(*map);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
  return map;
}

Rgb radiance(const EnvironmentLight& light, const Vec3& w) {
  if (light.map) {
    if (!light.tables) return Rgb::Zero();
    return light.scale *
           light.tables->density.colour(find_cell(to_lat_long(light.to_map * w), light.map->width, light.map->height));
  }
  if (!light.sh.empty()) return light.scale * evaluate_sh(light.sh, light.to_map * w);
  return light.scale;
}

Vec3 sample_environment(const EnvironmentLight& light, double u1, double u2) {
  if (!light.tables) return sample_uniform(u1, u2);
  const Vec3 w = u1 < uniform_share ? sample_uniform(u1 / uniform_share, u2)
                                    : light.tables->density.sample((u1 - uniform_share) / (1 - uniform_share), u2);
  return light.to_map.transpose() * w;
}

double pdf_environment(const EnvironmentLight& light, const Vec3& w) {
  if (!light.tables) return uniform_pdf;
  return uniform_share * uniform_pdf + (1 - uniform_share) * light.tables->density.pdf(light.to_map * w);
}

EnvironmentValue evaluate_environment(const EnvironmentLight& light, const Vec3& w) {
  if (!light.map || !light.tables) return {radiance(light, w), pdf_environment(light, w)};
  // The density's grid is the map's.
  const Vec3 v = light.to_map * w;
  const LatLongCell cell = find_cell(to_lat_long(v), light.map->width, light.map->height);
  return {light.scale * light.tables->density.colour(cell),
          uniform_share * uniform_pdf + (1 - uniform_share) * light.tables->density.pdf(cell, v[1])};
}

}  // namespace airlight::scene
