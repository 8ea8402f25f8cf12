#include "scene/convert/medium_form.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "scene/base/content_key.h"
#include "scene/base/content_store.h"
#include "scene/base/error.h"
#include "scene/base/stopwatch.h"
#include "scene/convert/fogmap_columns.h"
#include "scene/convert/gaussian_fit.h"
#include "scene/convert/legendre_projection.h"
#include "scene/media/fogmap.h"
#include "scene/media/legendre_box.h"
#include "scene/media/voxel_grid.h"

namespace airlight::scene {
namespace {

constexpr int sampled_voxels = 96;  // along the longest side, of media that are no grid
constexpr double widest = 0.5;     // of a Gaussian, over the cube root of the box's volume: few of them have to be wide
constexpr int test_points = 48;    // along an axis
constexpr int column_samples = 2;  // squared: rays of a fogmap's pixel
constexpr int spline_degree = 1;

void bind(SettingBinder& b, MediumConversion& c) {
  b.choice("to", c.to, medium_forms(), "form that all media take");
  b.integer("voxels", c.voxels, 2, 1024, "of a grid, along the longest side").where("to", {"grid"});
  b.integer("count", c.gaussians, 1, most_fit_gaussians, "of Gaussians").where("to", {"gaussians"});
  b.flag("cut", c.cut, "Gaussians end at three widths").where("to", {"gaussians"});
  b.integer("order", c.coefficients, 1, LegendreBox::most, "coefficients of a Legendre box along each axis")
      .where("to", {"legendre"});
  b.flag("damped", c.damped, "waves that jumps leave in a Legendre box").where("to", {"legendre"});
  b.integer("cells", c.pixels, 1, 8192, "of a fogmap, along the longer side").where("to", {"fogmap"});
  b.flag("lamps", c.lamps, "directional lights become far point lights");
}

// The box in which a medium is sampled.
Box sampled_box(const std::vector<Medium>& media, std::size_t i) {
  Box box = bounding_box(media[i]);
  if (!box.empty() && box.size().allFinite() && (box.size().array() > 0).all()) return box;
  const std::string reason = fmt::format("{} {}: a conversion needs one with an end in all directions", label(media, i),
                                         box.empty() ? "is empty" : "has no end");
  throw NotSupported(reason, reason);
}

GridPointer sample(const Medium& medium, const Box& box, int voxels, const Execution& execution) {
  auto grid = std::make_shared<VoxelGrid>();
  grid->voxel_size = box.size().maxCoeff() / voxels;
  grid->size = (box.size() / grid->voxel_size).array().ceil().cast<int>().max(1);
  // Samples in the middle of voxels, which together have the box's middle.
  grid->translation =
      0.5 * (box.lo + box.hi) - 0.5 * grid->voxel_size * (grid->size - Eigen::Vector3i::Ones()).cast<double>();
  grid->clamp_border = true;
  const Eigen::Vector3i n = grid->size;
  grid->values.resize(std::size_t(n[0]) * std::size_t(n[1]) * std::size_t(n[2]));
  parallel_for(n[2], execution, [&](int k) {
    float* value = grid->values.data() + std::size_t(k) * std::size_t(n[0]) * std::size_t(n[1]);
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) *value++ = float(density(medium, sample_to_world(*grid, Point3(i, j, k))));
  });
  return grid;
}

GridPointer own_or_sampled(const Medium& medium, const Box& box, const Execution& execution) {
  if (const auto* grid = std::get_if<GridPointer>(&medium.field);
      grid && std::holds_alternative<Unbounded>(medium.region))
    return *grid;
  return sample(medium, box, sampled_voxels, execution);
}

// A fit that is kept: seconds, then the five numbers of each Gaussian.
struct Fit {
  double seconds = 0;
  GaussianSum sum;
};

std::optional<Fit> kept_fit(const Execution& execution, const std::string& name) {
  if (!execution.store) return {};
  const auto path = execution.store->find(name);
  if (!path) return {};
  std::ifstream in(*path);
  Fit fit;
  fit.sum.cutoff = fit_cutoff;
  in >> fit.seconds;
  for (Gaussian g{}; in >> g.center[0] >> g.center[1] >> g.center[2] >> g.width >> g.amplitude;)
    fit.sum.gaussians.push_back(g);
  return fit;
}

Fit fit(const Medium& medium, const Box& box, int count, const std::string& hash, const Execution& execution) {
  const std::string name = "converted/" + content_key({hash, std::to_string(count)}) + ".txt";
  if (const auto kept = kept_fit(execution, name)) return *kept;
  Stopwatch watch;
  FitOptions options;
  options.gaussians = count;
  options.widths.hi = widest;
  options.threads = execution.threads;
  Fit made;
  made.sum = fit_gaussians(*own_or_sampled(medium, box, execution), options).sum;
  made.seconds = watch.lap();
  if (execution.store)
    execution.store->keep(name, [&](const std::filesystem::path& path) {
      std::string text = fmt::format("{}\n", made.seconds);
      for (const Gaussian& g : made.sum.gaussians)
        text += fmt::format("{} {} {} {} {}\n", g.center[0], g.center[1], g.center[2], g.width, g.amplitude);
      write_file_atomically(path.string(), text);
    });
  return made;
}

struct Form {
  Medium medium;
  std::size_t numbers;
  std::optional<double> seconds;  // where they are not those of now
};

Form in_form(const Medium& medium, const Box& box, const MediumConversion& c, const std::string& hash,
             const Execution& execution) {
  Form form{medium, 1, {}};
  form.medium.region = box;
  switch (c.to) {
    case MediumForm::grid: {
      const GridPointer grid = sample(medium, box, c.voxels, execution);
      form.medium.field = grid;
      form.medium.region = Unbounded{};  // its samples end half a voxel inside or on the box
      form.numbers = grid->values.size();
      break;
    }
    case MediumForm::gaussians: {
      const Fit made = fit(medium, box, c.gaussians, hash, execution);
      GaussianSum sum = made.sum;
      if (!c.cut) sum.cutoff = infinity;
      form.medium.field = sum;
      form.medium.region = Unbounded{};
      form.numbers = 5 * made.sum.gaussians.size();
      form.seconds = made.seconds;
      break;
    }
    case MediumForm::legendre: {
      ProjectionOptions options;
      options.shape = {c.coefficients, c.coefficients, c.coefficients};
      options.box = box;
      options.lanczos = options.limiter = c.damped;
      form.medium.field = project_to_legendre(medium, options).field;
      form.medium.region = Unbounded{};
      form.numbers = std::size_t(c.coefficients) * std::size_t(c.coefficients) * std::size_t(c.coefficients);
      break;
    }
    case MediumForm::fogmap: {
      const DensityField field = own_or_sampled(medium, box, execution);
      const GroundPixels pixels = ground_pixels(field, c.pixels);
      ColumnFogmap fog = fogmap_from_columns(field, pixels, column_samples, spline_degree);
      form.medium.field = std::make_shared<const Fogmap>(std::move(fog.map));
      form.medium.region = Slab{Vec3::UnitY(), fog.heights.lo, fog.heights.hi};
      form.numbers = std::size_t(pixels.width) * std::size_t(pixels.height);
      break;
    }
    case MediumForm::homogeneous: {
      const GridPointer grid = sample(medium, box, sampled_voxels, execution);
      double sum = 0;
      for (const float value : grid->values) sum += double(value);
      form.medium.field = Homogeneous{sum / double(grid->values.size())};
      break;
    }
  }
  return form;
}

// Their rays are parallel, and their irradiance is even, to 2 in `far_lamp`.
void make_lamps(Scene& scene) {
  Box all;
  for (std::size_t i = 0; i < scene.media.size(); ++i) all = unite(all, sampled_box(scene.media, i));
  if (scene.geometry) all = unite(all, scene.geometry->bounds());
  const double distance = far_lamp * all.size().norm();
  for (Light& light : scene.lights)
    if (const auto* sun = std::get_if<DirectionalLight>(&light)) {
      PointLight lamp;
      lamp.position = all.center() + distance * sun->to_light;
      lamp.intensity = sun->irradiance * distance * distance;
      light = lamp;
    }
}

// Points off any grid's samples: an irrational part of a cell from its corner.
void compare(const Medium& medium, const Medium& converted, const Box& box, const Execution& execution,
             ConvertedMedium& found) {
  struct Sums {
    double difference = 0, square = 0, mass = 0, converted_mass = 0;
  };
  std::vector<Sums> slices(test_points);
  parallel_for(test_points, execution, [&](int k) {
    Sums& sums = slices[std::size_t(k)];
    for (int j = 0; j < test_points; ++j)
      for (int i = 0; i < test_points; ++i) {
        const Vec3 share = (Vec3(i, j, k) + Vec3(0.6180340, 0.4142136, 0.7320508)) / test_points;
        const Point3 x = box.lo + share.cwiseProduct(box.size());
        const double a = density(medium, x), b = density(converted, x);
        sums.difference += (a - b) * (a - b);
        sums.square += a * a;
        sums.mass += a;
        sums.converted_mass += b;
      }
  });
  Sums all;
  for (const Sums& s : slices) {
    all.difference += s.difference;
    all.square += s.square;
    all.mass += s.mass;
    all.converted_mass += s.converted_mass;
  }
  found.density_error = all.square > 0 ? std::sqrt(all.difference / all.square) : 0;
  found.mass_ratio = all.mass > 0 ? all.converted_mass / all.mass : 1;
}

}  // namespace

const Choices<MediumForm>& medium_forms() {
  static const Choices<MediumForm> forms{{"grid", MediumForm::grid},
                                         {"gaussians", MediumForm::gaussians},
                                         {"legendre", MediumForm::legendre},
                                         {"fogmap", MediumForm::fogmap},
                                         {"homogeneous", MediumForm::homogeneous}};
  return forms;
}

MediumConversion read_conversion(const std::map<std::string, std::string>& given, const std::string& where) {
  return read_settings(bind, Settings(list_settings(bind), given, where));
}

std::string canonical(const MediumConversion& c) {
  std::string text;
  for (const auto& [name, form] : medium_forms())
    if (form == c.to) text = "to=" + name;
  switch (c.to) {
    case MediumForm::grid:
      text += fmt::format(" voxels={}", c.voxels);
      break;
    case MediumForm::gaussians:
      text += fmt::format(" count={}{}", c.gaussians, c.cut ? "" : " cut=false");
      break;
    case MediumForm::legendre:
      text += fmt::format(" order={}{}", c.coefficients, c.damped ? "" : " damped=false");
      break;
    case MediumForm::fogmap:
      text += fmt::format(" cells={}", c.pixels);
      break;
    case MediumForm::homogeneous:
      break;
  }
  return text + (c.lamps ? " lamps=true" : "");
}

ConvertedScene convert_media(const Scene& scene, const MediumConversion& conversion, const Execution& execution,
                             const std::string& program) {
  ConvertedScene converted{scene, {}};
  for (std::size_t i = 0; i < scene.media.size(); ++i) {
    const Medium& medium = scene.media[i];
    const Box box = sampled_box(scene.media, i);
    ConvertedMedium found;
    found.medium = label(scene.media, i);
    Stopwatch watch;
    const Form form =
        in_form(medium, box, conversion, fmt::format("{} {} {}", scene.matter_hash, i, program), execution);
    found.seconds = form.seconds.value_or(watch.lap());
    found.numbers = form.numbers;
    compare(medium, form.medium, box, execution, found);
    converted.scene.media[i] = form.medium;
    converted.media.push_back(std::move(found));
  }
  if (conversion.lamps) make_lamps(converted.scene);
  finish(converted.scene);
  return converted;
}

}  // namespace airlight::scene
