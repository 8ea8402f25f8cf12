#include "methods/fogshop/low_resolution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "methods/fogshop/environment_lighting.h"
#include "scene/base/stopwatch.h"

namespace airlight::fogshop {
namespace {

constexpr double edge_ratio = 1.1, far_away = 1e37, black = 1e30;

// The four low pixels around a pixel, and their bilinear weights.
struct Corners {
  std::array<std::size_t, 4> place;
  std::array<double, 4> weight;
};

Corners corners_of(const LowResolution& r, int x, int y) {
  const auto along = [&](int pixel, int low_size, int place[2]) {
    const double at = (pixel + 0.5) / r.factor - 0.5;
    const int first = int(std::floor(at));
    place[0] = std::clamp(first, 0, low_size - 1);
    place[1] = std::clamp(first + 1, 0, low_size - 1);
    return at - first;
  };
  int column[2], row[2];
  const double u = along(x, r.low_width(), column), v = along(y, r.low_height(), row);
  Corners c;
  for (int k = 0; k < 4; ++k) {
    c.place[k] = std::size_t(row[k / 2]) * r.low_width() + column[k % 2];
    c.weight[k] = (k % 2 ? u : 1 - u) * (k / 2 ? v : 1 - v);
  }
  return c;
}

double finite(double distance) { return std::min(distance, far_away); }

// The corner whose distance is closest to d; of equals the one with the greatest weight.
int most_alike(const Corners& c, const std::vector<double>& low_distance, double d) {
  int best = 0;
  const auto difference = [&](int k) { return std::abs(finite(low_distance[c.place[k]]) - finite(d)); };
  for (int k = 1; k < 4; ++k) {
    const double a = difference(k), b = difference(best);
    if (a < b || (a == b && c.weight[k] > c.weight[best])) best = k;
  }
  return best;
}

}  // namespace

std::vector<double> low_distances(const scene::Scene& scene, const scene::View& view, const LowResolution& r,
                                  const scene::Execution& execution) {
  std::vector<double> distance(std::size_t(r.low_width()) * r.low_height());
  scene::parallel_for(r.low_height(), execution, [&](int y) {
    for (int x = 0; x < r.low_width(); ++x)
      distance[std::size_t(y) * r.low_width() + x] =
          camera_end(scene, camera_ray(view.camera, r.factor * (x + 0.5), r.factor * (y + 0.5), r.width, r.height)).t;
  });
  return distance;
}

std::vector<unsigned char> edge_pixels(const LowResolution& r, const std::vector<double>& low_distance,
                                       const std::vector<double>& distance) {
  std::vector<unsigned char> edge(std::size_t(r.width) * r.height, 0);
  const int reach = r.factor / 2;
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      double least = infinity, most = 0;
      const auto add = [&](double d) {
        least = std::min(least, finite(d));
        most = std::max(most, finite(d));
      };
      for (int j = std::max(0, y - reach); j <= std::min(r.height - 1, y + reach); ++j)
        for (int i = std::max(0, x - reach); i <= std::min(r.width - 1, x + reach); ++i)
          add(distance[std::size_t(j) * r.width + i]);
      for (const std::size_t place : corners_of(r, x, y).place) add(low_distance[place]);
      edge[std::size_t(y) * r.width + x] = most > edge_ratio * least;
    }
  return edge;
}

AirlightImage upsample(const LowResolution& r, const AirlightImage& low, const std::vector<unsigned char>& edge,
                       const std::vector<double>& low_distance, const std::vector<double>& distance) {
  AirlightImage image;
  image.airlight.resize(std::size_t(r.width) * r.height);
  image.depth.resize(image.airlight.size());
  image.evaluations = low.evaluations;
  image.crossed = low.crossed;
  image.candidates = low.candidates;
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      const std::size_t i = std::size_t(y) * r.width + x;
      Corners c = corners_of(r, x, y);
      if (!edge.empty() && edge[i]) {
        const int k = most_alike(c, low_distance, distance[i]);
        c.weight = {0, 0, 0, 0};
        c.weight[k] = 1;
      }
      Rgb airlight = Rgb::Zero();
      double depth = 0;
      for (int k = 0; k < 4; ++k) {
        airlight += c.weight[k] * low.airlight[c.place[k]];
        depth += c.weight[k] * std::min(low.depth[c.place[k]], black);
      }
      image.airlight[i] = airlight;
      image.depth[i] = depth;
    }
  return image;
}

AirlightImage low_resolution_airlight(const scene::Scene& scene, const Model& model, const ViewModel& view_model,
                                      const scene::View& view, const std::vector<double>& distance,
                                      bool surfaces_end_rays, const scene::Execution& execution,
                                      std::vector<scene::StageTime>& times, std::map<std::string, double>& counters) {
  const Options& o = model.options;
  const LowResolution r{view.width, view.height, o.downsample};
  scene::Stopwatch watch;
  const auto lap = [&](const char* stage) { times.push_back({stage, watch.lap()}); };

  std::vector<double> low_distance(std::size_t(r.low_width()) * r.low_height(), infinity);
  if (surfaces_end_rays) {
    low_distance = low_distances(scene, view, r, execution);
    lap("distances, low resolution");
  }
  if (model.environment) low_distance = up_to_environment(o, low_distance);
  const AirlightImage low = airlight_pass(model, view_model, view, low_distance, execution, r.factor);
  lap("airlight");
  std::vector<unsigned char> edge;
  if (surfaces_end_rays && o.upsample != Options::Upsample::bilinear) edge = edge_pixels(r, low_distance, distance);
  AirlightImage image = upsample(r, low, edge, low_distance, distance);
  lap("upsampling");
  counters["pixels_low"] = double(low.airlight.size());
  counters["pixels_edge"] = std::accumulate(edge.begin(), edge.end(), 0.0);
  if (!edge.empty() && o.upsample == Options::Upsample::recompute) {
    airlight_again(model, view_model, view, distance, edge, execution, image);
    lap("edges at full resolution");
  }
  return image;
}

}  // namespace airlight::fogshop
