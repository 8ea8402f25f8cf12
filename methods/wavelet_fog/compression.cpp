#include "methods/wavelet_fog/compression.h"

#include <algorithm>
#include <cmath>

#include "scene/math/bspline.h"
#include "scene/media/fogmap.h"

namespace airlight::wavelet_fog {
namespace {

const char* const families[] = {"haar", "cdf22", "cdf33"};  // by degree

// Integral of two splines of a degree, `shift` cells apart.
double overlap(int degree, int shift) {
  return scene::bspline_at_integer(2 * degree + 1, degree + 1 + std::abs(shift));
}

// L2 norm of sum_t taps_t N_n(2x - t).
double norm_of(const Taps& taps, int degree) {
  double sum = 0;
  for (std::size_t a = 0; a < taps.values.size(); ++a)
    for (std::size_t b = 0; b < taps.values.size(); ++b)
      sum += taps.values[a] * taps.values[b] * overlap(degree, int(a) - int(b));
  return std::sqrt(0.5 * sum);
}

// A coefficient of a decomposition and what it weighs.
struct Weighed {
  double weight;
  std::size_t order;
  double* value;
};

void weigh(Coefficients& band, double norm, std::vector<Weighed>& all) {
  for (double& value : band.values) all.push_back({std::abs(value) * norm, all.size(), &value});
}

}  // namespace

double l2_norm(const Coefficients& c, int degree) {
  const int width = c.range.size[0], height = c.range.size[1];
  const auto at = [&](int i, int j) {
    return i >= 0 && j >= 0 && i < width && j < height ? c.values[std::size_t(j) * width + i] : 0.0;
  };
  double sum = 0;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      if (at(i, j) == 0) continue;
      double around = 0;
      for (int b = -degree; b <= degree; ++b)
        for (int a = -degree; a <= degree; ++a) around += overlap(degree, a) * overlap(degree, b) * at(i + a, j + b);
      sum += at(i, j) * around;
    }
  return std::sqrt(std::max(0.0, sum));
}

Compressed compress(const Coefficients& map, const Family& f, int levels, double keep) {
  Decomposition d = decompose(map, f, levels);
  const double phi = norm_of(two_scale(f.degree), f.degree), psi = norm_of(f.q, f.degree);
  std::vector<Weighed> all;
  for (int l = 0; l < levels; ++l) {
    const double cell = std::ldexp(1.0, l + 1);  // the norm of a function of the plane grows with the side of its cells
    Bands& bands = d.levels[l];
    weigh(bands.ad, cell * phi * psi, all);
    weigh(bands.da, cell * phi * psi, all);
    weigh(bands.dd, cell * psi * psi, all);
    if (l + 1 == levels) weigh(bands.aa, cell * phi * phi, all);
  }
  const std::size_t wanted = std::size_t(std::ceil(keep * double(map.range.size[0]) * double(map.range.size[1])));
  Compressed result;
  if (wanted < all.size()) {
    std::nth_element(all.begin(), all.begin() + std::ptrdiff_t(wanted), all.end(),
                     [](const Weighed& a, const Weighed& b) {
                       return a.weight != b.weight ? a.weight > b.weight
                                                   : a.order < b.order;  // ties of equal weight: the same every time
                     });
    for (std::size_t i = wanted; i < all.size(); ++i) *all[i].value = 0;
  }
  for (std::size_t i = 0; i < std::min(wanted, all.size()); ++i) result.kept += *all[i].value != 0 ? 1 : 0;
  result.map = reconstruct(d, f);
  Coefficients off = map;
  for (std::size_t i = 0; i < off.values.size(); ++i) {
    result.map.values[i] = std::max(0.0, result.map.values[i]);
    off.values[i] -= result.map.values[i];
  }
  const double norm = l2_norm(map, f.degree);
  result.error = norm > 0 ? l2_norm(off, f.degree) / norm : 0;
  return result;
}

std::shared_ptr<const scene::Scene> with_maps_changed(std::shared_ptr<const scene::Scene> scene, const Options& o,
                                                      std::vector<CompressionReport>* reports) {
  if (o.keep == 1 && o.degree < 0) return scene;
  auto result = std::make_shared<scene::Scene>(*scene);
  for (scene::Medium& medium : result->media) {
    auto fog = std::make_shared<scene::Fogmap>(*std::get<scene::FogmapPointer>(medium.field));
    const int before = fog->map.degree(), n = o.degree < 0 ? before : o.degree;
    Coefficients map{fog->map.range(), fog->map.coefficients()};
    if (o.keep < 1) {
      Compressed c = compress(map, family(families[n]), o.levels, o.keep);
      map = std::move(c.map);
      if (reports) reports->push_back({c.kept, c.error});
    }
    fog->map = scene::SplineMap(n, map.range, map.values);
    const double shift = 0.5 * fog->cell * (before - n);  // bases stay centred on their pixels
    fog->x0 += shift * (fog->cos_turn + fog->sin_turn);
    fog->z0 += shift * (fog->cos_turn - fog->sin_turn);
    medium.field = scene::FogmapPointer(std::move(fog));
  }
  return result;
}

}  // namespace airlight::wavelet_fog
