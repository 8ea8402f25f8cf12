#include "reference/half_resolution_march/history.h"

#include "reference/half_resolution_march/filter.h"
#include "scene/base/flush_subnormals.h"

namespace airlight::half_resolution_march {
namespace {

constexpr double least_weight = 0.01;  // of four neighbours, of which some are left out

// The sum of weights is returned; the mean is that of the blocks that are as far as the trace.
double look_up(const LowFilm& film, const Trace& trace, double edge, FogPixel& mean) {
  const Neighbours across = neighbours_at(film.across, trace.x), down = neighbours_at(film.down, trace.y);
  const std::size_t at[4] = {film.at(across.first, down.first), film.at(across.second, down.first),
                             film.at(across.first, down.second), film.at(across.second, down.second)};
  const double weights[4] = {(1 - across.share) * (1 - down.share), across.share * (1 - down.share),
                             (1 - across.share) * down.share, across.share * down.share};
  double total = 0;
  mean.setZero();
  for (int k = 0; k < 4; ++k) {
    const double depth = film.depth.empty() ? infinity : film.depth[at[k]];
    if (depth_difference(depth, trace.depth) > edge) continue;
    mean += float(weights[k]) * film.fog[at[k]];
    total += weights[k];
  }
  if (total >= least_weight) mean /= float(total);
  return total;
}

// Limits `fog` to what blocks around (x, y) have. True if that changed it, and not all of them are clear to 1e-6. Light of clear
// blocks comes from places at the edge of smoke, and rounding decides on which side they are.
bool limit(const LowFilm& film, int x, int y, FogPixel& fog) {
  FogPixel least = film.fog[film.at(x, y)], most = least;
  for (int j = std::max(0, y - 1); j <= std::min(film.height() - 1, y + 1); ++j)
    for (int i = std::max(0, x - 1); i <= std::min(film.width() - 1, x + 1); ++i) {
      least = least.min(film.fog[film.at(i, j)]);
      most = most.max(film.fog[film.at(i, j)]);
    }
  const FogPixel limited = fog.max(least).min(most);
  const bool all_clear = (least.min(fog).segment<3>(3) > 1 - 1e-6f).all(), changed = (limited != fog).any();
  fog = limited;
  return changed && !all_clear;
}

}  // namespace

Trace trace_of(const LowFilm& film, int x, int y, const Ray& ray, double distance, double t_end,
               const scene::View& view, const scene::View& last) {
  const auto on_film = [&](const scene::View& by, double t) {
    return scene::film_position(by.camera, ray.at(t), by.width, by.height);
  };
  Trace trace;
  trace.in_media = true;
  const Vec3 now = on_film(view, distance), before = on_film(last, distance);
  trace.seen = before[2] > 0 && before[0] >= 0 && before[0] <= last.width && before[1] >= 0 && before[1] <= last.height;
  trace.x = film.across.center(x) + (before[0] - now[0]);
  trace.y = film.down.center(y) + (before[1] - now[1]);
  trace.depth = t_end == infinity ? infinity : on_film(last, t_end)[2];
  return trace;
}

void blend(const Options& options, const History& history, const std::vector<Trace>& traces, double edge, LowFilm& film,
           const scene::Execution& execution, Counters& counters) {
  std::vector<FogPixel> blended(film.fog.size());
  counters += scene::parallel_sum<Counters>(film.height(), execution, [&](int y, Counters& of_row) {
    const scene::FlushSubnormals flush;
    for (int x = 0; x < film.width(); ++x) {
      const std::size_t at = film.at(x, y);
      const Trace& trace = traces[at];
      blended[at] = film.fog[at];
      if (!trace.in_media) continue;
      FogPixel old;
      if (!trace.seen || look_up(history.film, trace, edge, old) < least_weight) {
        ++of_row.history_rejected;
        continue;
      }
      ++of_row.history_used;
      if (options.clamp && limit(film, x, y, old)) ++of_row.history_clamped;
      blended[at] += float(options.history_weight) * (old - film.fog[at]);
    }
  });
  film.fog.swap(blended);
}

}  // namespace airlight::half_resolution_march
