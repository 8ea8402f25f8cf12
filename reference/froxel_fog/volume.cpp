#include "reference/froxel_fog/volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/froxel_fog/fit.h"
#include "scene/base/flush_subnormals.h"
#include "scene/base/limits.h"
#include "scene/camera_rays.h"

namespace airlight::froxel_fog {

Cells cells_of(const Options& o, int film_width, int film_height) {
  const auto covering = [&](int pixels) { return (pixels + o.tile - 1) / o.tile; };
  if (o.volume_size == 0) return {covering(film_width), covering(film_height), double(o.tile), double(o.tile)};
  const double ratio = 2.0 * film_width / (film_width + film_height);
  const int columns = std::max(1, int(o.volume_size * ratio)), rows = std::max(1, int(o.volume_size / ratio));
  return {columns, rows, double(film_width) / columns, double(film_height) / rows};
}

double count_froxels(const Options& o, int film_width, int film_height) {
  const Cells cells = cells_of(o, film_width, film_height);
  return double(cells.columns) * cells.rows * o.slices;
}

Volume::Volume(const Cells& cells, const Slices& slices) : cells_(cells), slices_(slices) {
  const std::size_t count = place(0, cells.rows);
  scene::require_memory(double(count) * sizeof(Froxel),
                        fmt::format("froxel_fog: {} x {} x {} froxels", cells.columns, cells.rows, slices.count()));
  froxels_.resize(count);
}

std::vector<float> filter_weights(Filter filter) {
  if (filter == Filter::none) return {1};
  if (filter == Filter::gauss7) return {0.2146F, 0.1899F, 0.1315F, 0.0713F};
  const double side = std::exp(-1.0);
  return {float(1 / (1 + 2 * side)), float(side / (1 + 2 * side))};
}

namespace {

// Filters a line of `count` froxels, `stride` apart. All weights are used as given, except the middle one, which is 1
// minus their sum: constants are preserved.
void filter_line(const std::vector<float>& weights, int count, std::size_t stride, Froxel* line,
                 std::vector<Froxel>& copy) {
  copy.resize(std::size_t(count));
  for (int i = 0; i < count; ++i) copy[std::size_t(i)] = line[std::size_t(i) * stride];
  const auto at = [&](int i) -> const Froxel& { return copy[std::size_t(std::clamp(i, 0, count - 1))]; };
  for (int i = 0; i < count; ++i) {
    Froxel& sum = line[std::size_t(i) * stride];
    const Froxel& middle = at(i);
    for (int r = 1; r < int(weights.size()); ++r) {
      const float w = weights[std::size_t(r)];
      sum.light += w * ((at(i - r).light - middle.light) + (at(i + r).light - middle.light));
      sum.media += w * ((at(i - r).media - middle.media) + (at(i + r).media - middle.media));
    }
  }
}

}  // namespace

void Volume::filter(Filter filter, const scene::Execution& execution) {
  if (filter == Filter::none) return;
  const std::vector<float> weights = filter_weights(filter);
  const int n = slices_.count();
  const std::size_t next_column = std::size_t(n), next_row = place(0, 1);
  // Rows hold the axes x and u, planes across them the axis y.
  parallel_for(cells_.rows, execution, [&](int y) {
    const scene::FlushSubnormals flush;
    static thread_local std::vector<Froxel> copy;
    for (int k = 0; k < n; ++k) filter_line(weights, cells_.columns, next_column, column(0, y) + k, copy);
    if (filter == Filter::gauss7)
      for (int x = 0; x < cells_.columns; ++x) filter_line(weights, n, 1, column(x, y), copy);
  });
  parallel_for(cells_.columns, execution, [&](int x) {
    const scene::FlushSubnormals flush;
    static thread_local std::vector<Froxel> copy;
    for (int k = 0; k < n; ++k) filter_line(weights, cells_.rows, next_row, column(x, 0) + k, copy);
  });
}

void Volume::integrate(const scene::View& view, const scene::Execution& execution) {
  const scene::CameraRays rays(view.camera, view.width, view.height);
  std::vector<double> ends;
  for (int k = 0; k <= slices_.count(); ++k) ends.push_back(slices_.decode(double(k) / slices_.count()));
  parallel_for(cells_.rows, execution, [&](int y) {
    const scene::FlushSubnormals flush;
    for (int x = 0; x < cells_.columns; ++x) {
      const double metres = 1 / depth_per_metre(view.camera, rays((x + 0.5) * cells_.width, (y + 0.5) * cells_.height));
      Rgb airlight = Rgb::Zero(), transmittance = Rgb::Ones();
      Froxel* const froxel = column(x, y);
      for (int k = 0; k < slices_.count(); ++k) {
        const double length = (ends[std::size_t(k) + 1] - ends[std::size_t(k)]) * metres;
        for (int c = 0; c < 3; ++c) {
          const double extinction = froxel[k].media[c];
          // 1 - exp(-depth) without cancelling; the integral of exp(-extinction t) over the slice.
          const double swallowed = extinction > 0 ? -std::expm1(-extinction * length) : 0;
          airlight[c] += transmittance[c] * froxel[k].light[c] * (extinction > 0 ? swallowed / extinction : length);
          transmittance[c] *= 1 - swallowed;
          froxel[k].light[c] = float(airlight[c]);
          froxel[k].media[c] = float(transmittance[c]);
        }
      }
    }
  });
}

namespace {

// The lower of two neighbours that a place between `count` points 0, 1, ... lies between, and its share of the upper one.
std::pair<int, double> axis(double place, int count) {
  const double clamped = std::clamp(place, 0.0, double(count - 1));
  const int low = std::min(int(clamped), std::max(count - 2, 0));
  return {low, clamped - low};
}

}  // namespace

Froxel Volume::froxel_at(double film_x, double film_y, double u) const {
  const auto [x, right] = axis(film_x / cells_.width - 0.5, cells_.columns);
  const auto [y, down] = axis(film_y / cells_.height - 0.5, cells_.rows);
  const auto [k, deep] = axis(u * slices_.count() - 0.5, slices_.count());
  Froxel sum;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, l = corner >> 2;
    const float w = float((i ? right : 1 - right) * (j ? down : 1 - down) * (l ? deep : 1 - deep));
    if (w == 0) continue;  // there may be no such neighbour
    const Froxel& froxel = column(x + i, y + j)[k + l];
    sum.light += w * froxel.light;
    sum.media += w * froxel.media;
  }
  return sum;
}

Volume::Seen Volume::look_up(double film_x, double film_y, double u) const {
  const auto [x, right] = axis(film_x / cells_.width - 0.5, cells_.columns);
  const auto [y, down] = axis(film_y / cells_.height - 0.5, cells_.rows);
  const auto [k, deep] = axis(u * slices_.count(), slices_.count() + 1);  // ends of slices: the first is the range's
  Seen seen{Rgb::Zero(), Rgb::Zero()};
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const double weight = (i ? right : 1 - right) * (j ? down : 1 - down);
      if (weight == 0) continue;
      const Froxel* const froxel = column(x + i, y + j);
      for (int end = 0; end < 2; ++end) {
        const double w = weight * (end ? deep : 1 - deep);
        if (w == 0) continue;
        const int before = k + end - 1;
        if (before >= 0) seen.airlight += w * froxel[before].light.cast<double>();
        seen.transmittance += before >= 0 ? Rgb(w * froxel[before].media.cast<double>()) : Rgb::Constant(w);
      }
    }
  return seen;
}

}  // namespace airlight::froxel_fog
