#include "reference/froxel_fog/frames.h"

#include "reference/froxel_fog/fit.h"
#include "scene/base/flush_subnormals.h"
#include "scene/picture.h"

namespace airlight::froxel_fog {

Vec3 jitter(Jitter kind, int frame) {
  if (kind == Jitter::none) return Vec3::Constant(0.5);
  if (kind == Jitter::hdrp) {
    constexpr int places[] = {7, 3, 11, 5, 9, 1, 13};
    return {0.5, 0.5, places[frame % 7] / 14.0};
  }
  const auto radical_inverse = [](int base, int i) {
    double sum = 0, digit = 1.0 / base;
    for (; i > 0; i /= base, digit /= base) sum += i % base * digit;
    return sum;
  };
  return {radical_inverse(2, frame + 1), radical_inverse(3, frame + 1), radical_inverse(5, frame + 1)};
}

float history_weight(const Options& o, int frame) {
  if (o.blend == Blend::mean || frame == 0) return float(frame) / float(frame + 1);
  return float(o.history_weight);
}

void Counters::operator+=(const Counters& other) {
  media += other.media;
  rays += other.rays;
  reprojected += other.reprojected;
}

Counters inject(const lit_media::LitMedia& lit, const scene::Scene& scene, const scene::View& view, const Vec3& jitter,
                const Before& before, Volume& volume, const scene::Execution& execution) {
  const Cells& cells = volume.cells();
  const int slices = volume.slices().count();
  std::vector<double> depths, middles;
  for (int k = 0; k < slices; ++k) {
    depths.push_back(volume.slices().decode((k + jitter[2]) / slices));
    middles.push_back(volume.slices().decode((k + 0.5) / slices));
  }
  const scene::CameraRays rays(view.camera, view.width, view.height);
  return scene::parallel_sum<Counters>(cells.rows, execution, [&](int y, Counters& counters) {
    const scene::FlushSubnormals flush;
    static thread_local lit_media::Samples samples;
    static thread_local std::vector<double> t;
    for (int x = 0; x < cells.columns; ++x) {
      const Ray ray = rays((x + jitter[0]) * cells.width, (y + jitter[1]) * cells.height);
      const double metres = 1 / depth_per_metre(view.camera, ray), end = camera_end(scene, ray).t;
      ++counters.rays;
      // The froxels [first, first + size of t) are before the end, and where media are.
      const Interval media = lit.extent(ray, {0, end});
      t.clear();
      std::size_t first = 0;
      for (std::size_t k = 0; k < std::size_t(slices); ++k) {
        const double place = depths[k] * metres;
        if (!(place < end && place <= media.hi)) break;
        if (place < media.lo)
          first = k + 1;
        else
          t.push_back(place);
      }
      lit.along(ray, t, samples, counters.media);
      Froxel* const froxel = volume.column(x, y);
      const Ray middle = rays((x + 0.5) * cells.width, (y + 0.5) * cells.height);
      const double to_middle = 1 / depth_per_metre(view.camera, middle);
      for (std::size_t k = 0; k < std::size_t(slices); ++k) {
        const Froxel seen = k - first < t.size() ? Froxel{samples.source[k - first].cast<float>(),
                                                          samples.extinction[k - first].cast<float>()}
                                                 : Froxel{};
        Froxel old = froxel[k];
        float weight = before.weight;
        if (before.picture) {
          const auto known = before.picture->at(middle.at(middles[k] * to_middle));
          if (known)
            old = *known, ++counters.reprojected;
          else
            weight = 0;
        }
        froxel[k].light = seen.light + weight * (old.light - seen.light);
        froxel[k].media = seen.media + weight * (old.media - seen.media);
      }
    }
  });
}

}  // namespace airlight::froxel_fog
