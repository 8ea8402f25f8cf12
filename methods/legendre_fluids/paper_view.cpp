#include "methods/legendre_fluids/paper_view.h"

#include "scene/camera_rays.h"

namespace airlight::legendre_fluids {
namespace {

constexpr double column_rounding = 1e-9;  // of a depth [-], less than a film's single precision
constexpr int within = 3;                 // in place of an axis: the camera is in the box

}  // namespace

PaperView::PaperView(const scene::LegendreBox& box, const PaperLight& light, const Scattered& scattered,
                     const Rgb& sigma_t, const scene::View& view, bool ends)
    : scattered_(scattered), sigma_t_(sigma_t), width_(view.width), shape_(light.shape()) {
  const scene::CameraRays rays(view.camera, view.width, view.height);
  const Vec3 per_metre = 2 * box.box().size().cwiseInverse();
  const Ray first = rays(0.5, 0.5);
  origin_ = box.local(first.origin);
  across_ = (rays(1.5, 0.5).origin - first.origin).cwiseProduct(per_metre);
  down_ = (rays(0.5, 1.5).origin - first.origin).cwiseProduct(per_metre);
  slope_ = first.direction.cwiseProduct(per_metre);
  for (const Eigen::VectorXd& series : scattered.series) {
    face_.emplace_back();
    for (int a = 0; a < 3; ++a) face_.back()[std::size_t(a)] = light.on_face(series, a, slope_[a] > 0 ? -1 : 1);
  }
  if (ends)
    columns_.emplace(box, -view.camera.forward, column_rounding / sigma_t.maxCoeff(), LightColumns::Below::as_it_is);
}

template <class T, class Then>
void PaperView::for_lanes(int y, const std::vector<int>& pixels, const T& t, const Then& then) const {
  const auto all = int(pixels.size());
  for (int begin = 0; begin < all; begin += lanes) {
    Lanes x, way;
    for (int lane = 0; lane < lanes; ++lane) {
      const int pixel = pixels[std::size_t(std::min(begin + lane, all - 1))];
      x[lane] = pixel;
      way[lane] = t(std::size_t(pixel));
    }
    LightColumns::LocalLanes local;
    for (int a = 0; a < 3; ++a)
      local[std::size_t(a)] = (origin_[a] + y * down_[a] + across_[a] * x + slope_[a] * way).max(-1).min(1);
    then(&pixels[std::size_t(begin)], std::min(lanes, all - begin), local);
  }
}

void PaperView::clip(int y, const Row& row, Clipped& clipped) const {
  clipped.enter.resize(std::size_t(width_));
  clipped.leave.resize(std::size_t(width_));
  const Lanes number = Lanes::LinSpaced(0, lanes - 1);
  for (int begin = 0; begin < width_; begin += lanes) {
    Lanes enter = Lanes::Zero(), leave = Lanes::Constant(infinity), face = Lanes::Constant(within);
    for (int a = 0; a < 3; ++a) {
      const Lanes at = origin_[a] + y * down_[a] + across_[a] * (begin + number);
      if (slope_[a] == 0) {
        leave = (at.abs() <= 1).select(leave, -infinity);
        continue;
      }
      const double side = slope_[a] > 0 ? 1 : -1;
      const Lanes in = (-side - at) / slope_[a];
      face = (in > enter).select(double(a), face);
      enter = enter.max(in);
      leave = leave.min((side - at) / slope_[a]);
    }
    for (int lane = 0; lane < std::min(lanes, width_ - begin); ++lane) {
      const auto pixel = std::size_t(begin + lane);
      if (!(enter[lane] < leave[lane] && enter[lane] < row.end[pixel])) continue;
      clipped.enter[pixel] = enter[lane];
      clipped.leave[pixel] = leave[lane];
      clipped.pixels[std::size_t(face[lane])].push_back(begin + lane);
    }
  }
}

void PaperView::row(int y, Row& row) const {
  row.airlight.assign(std::size_t(width_), Rgb::Zero());
  row.column.assign(std::size_t(width_), 0);
  Clipped clipped;
  clip(y, row, clipped);
  const auto enter = [&](std::size_t x) { return clipped.enter[x]; };
  const auto last = [&](std::size_t x) { return std::min(clipped.leave[x], row.end[x]); };
  std::vector<int> with_column, ending;
  std::array<Lanes, 3> value;  // of the series
  value.fill(Lanes::Zero());
  const auto values = [&](int face, const LightColumns::LocalLanes& at) {
    scene::TensorShape shape = shape_;
    if (face != within) shape[std::size_t(face)] = 1;
    for (std::size_t s = 0; s < scattered_.series.size(); ++s) {
      const Eigen::VectorXd& series = face == within ? scattered_.series[s] : face_[s][std::size_t(face)];
      value[s] = series_values(shape, series.data(), at[0], at[1], at[2]);
    }
  };
  const auto in_channels = [&](int lane) {
    Rgb all;
    for (int c = 0; c < 3; ++c) all[c] = scattered_.scale[c] * value[scattered_.of_channel[std::size_t(c)]][lane];
    return all;
  };
  for (int face = 0; face < 4; ++face) {
    const std::vector<int>& pixels = clipped.pixels[std::size_t(face)];
    for_lanes(y, pixels, enter, [&](const int* x, int count, const LightColumns::LocalLanes& at) {
      values(face, at);
      for (int lane = 0; lane < count; ++lane) row.airlight[std::size_t(x[lane])] = in_channels(lane);
    });
    with_column.clear(), ending.clear();
    for (const int x : pixels) {
      const auto pixel = std::size_t(x);
      const bool ends = row.end[pixel] < clipped.leave[pixel];
      if (ends) ending.push_back(x);
      if (ends || row.seen[pixel]) with_column.push_back(x);
    }
    for_lanes(y, with_column, last, [&](const int* x, int count, const LightColumns::LocalLanes& at) {
      Lanes length = Lanes::Zero();
      for (int lane = 0; lane < count; ++lane) length[lane] = last(std::size_t(x[lane])) - enter(std::size_t(x[lane]));
      const Lanes column = face == within ? columns_->over(at, length) : columns_->to_face(face, at);
      for (int lane = 0; lane < count; ++lane) row.column[std::size_t(x[lane])] = column[lane];
    });
    if (scattered_.series.empty()) continue;
    for_lanes(y, ending, last, [&](const int* x, int count, const LightColumns::LocalLanes& at) {
      values(within, at);
      for (int lane = 0; lane < count; ++lane) {
        const auto pixel = std::size_t(x[lane]);
        row.airlight[pixel] -= (-sigma_t_ * row.column[pixel]).exp() * in_channels(lane);
      }
    });
    row.met += long(pixels.size());
    for (const int x : pixels) row.negative += row.airlight[std::size_t(x)].minCoeff() < 0;
  }
}

}  // namespace airlight::legendre_fluids
