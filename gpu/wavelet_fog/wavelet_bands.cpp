// What variant `pre` needs beside the grids of all levels, the bands of wavelets and their filters; and tables of path integrals.
#include <fmt/format.h>

#include <algorithm>

#include "gpu/wavelet_fog/leveled_fog.h"
#include "methods/wavelet_fog/band_grid.h"
#include "methods/wavelet_fog/leveled_fog.h"

namespace airlight::gpu::wavelet_fog {
namespace {

using scene::IndexRange;

const airlight::wavelet_fog::Family& wavelets_of(const scene::Medium& medium) {
  const int degree = std::get<scene::FogmapPointer>(medium.field)->map.degree();
  return airlight::wavelet_fog::family(airlight::wavelet_fog::family_of_degree(degree));
}

}  // namespace

// Filters of wavelet_cell.glsl.
void FogOnDevice::add_wavelets(Definitions& definitions) const {
  const airlight::wavelet_fog::Family& family = wavelets_of(medium_);
  const auto add = [&](const std::string& name, const Taps& taps) {
    definitions[name + "_TAPS"] = std::to_string(taps.values.size());
    definitions[name + "_FIRST"] = fmt::format("({})", taps.first);
    definitions[name + "_VALUES"] = listed(taps.values);
    return taps.first + int(taps.values.size());
  };
  const int n = family.degree, first = std::min(family.p.first, family.q.first);
  const int end = std::max(add("P", family.p), add("Q", family.q));
  definitions["LEAST_TAP"] = fmt::format("({})", first);
  definitions["WINDOW"] = std::to_string((end - 1 - first + n) / 2 + 1);
  const int of_wavelet = airlight::wavelet_fog::UnitPieces{n, family.q}.wavelet();
  definitions["WAVELET_COEFFICIENTS"] = std::to_string(of_wavelet * (2 * (n + 1) + of_wavelet));
}

// The paper's tables of path integrals, and what path_table.glsl is compiled with: LeveledFog::lay_bands.
void FogOnDevice::add_table(Definitions& definitions) {
  const scene::Fogmap& fog = *std::get<scene::FogmapPointer>(medium_.field);
  airlight::wavelet_fog::UnitPieces pieces{fog.map.degree(), {}};
  if (options_.variant == airlight::wavelet_fog::Options::Variant::pre && data_.levels > 0)
    pieces.q = wavelets_of(medium_).q;
  const bool moments = options_.fade > 0 || !std::holds_alternative<scene::SameAtAllHeights>(fog.profile);
  const airlight::wavelet_fog::PathTable table(pieces, options_.table, options_.lookup, moments);
  path_table_ = std::make_unique<Buffer>(context_, "tables of path integrals", table.values());
  definitions.insert({{"TABLE", std::to_string(options_.table)},
                      {"BILINEAR", options_.lookup == airlight::wavelet_fog::PathTable::Lookup::bilinear ? "1" : "0"},
                      {"CHANNELS", moments ? "2" : "1"},
                      {"PIECES", std::to_string(pieces.count())},
                      {"WAVELET_PIECES", std::to_string(pieces.wavelet())},
                      {"WAVELET_FIRST", fmt::format("({})", pieces.wavelet() > 0 ? pieces.wavelet_first() : 0)},
                      {"MOST_FALL", fmt::format("{:.9g}", airlight::wavelet_fog::BandGrid::most_fall)}});
}

// Bands of each level, from the finest on: where they lie, in cells of the finer grid, then ad, da and dd.
void FogOnDevice::add_bands(const std::vector<int>& grids) {
  const airlight::wavelet_fog::Family& f = wavelets_of(medium_);
  const airlight::wavelet_fog::UnitPieces pieces{f.degree, f.q};
  const auto low = [&](int band, int axis) { return axis == band; };  // by p_tilde
  const auto range_of = [&](std::size_t l, int band) {
    return coarse_range(grids_.range(grids[l]), low(band, 0) ? f.p_tilde : f.q_tilde,
                        low(band, 1) ? f.p_tilde : f.q_tilde);
  };
  for (std::size_t l = 0; l + 1 < grids.size(); ++l) {
    IndexRange cells;  // BandGrid::lay_cells
    for (int b = 0; b < 3; ++b) {
      IndexRange reached = range_of(l, b);
      for (int a = 0; a < 2; ++a) {
        reached.lo[a] += low(b, a) ? 0 : pieces.wavelet_first();
        reached.size[a] += (low(b, a) ? pieces.scaling() : pieces.wavelet()) - 1;
      }
      cells = b == 0 ? reached : airlight::wavelet_fog::united(cells, reached);
    }
    for (int a = 0; a < 2; ++a) {
      cells.lo[a] *= 2;
      cells.size[a] = 2 * cells.size[a] - f.degree;
    }
    grids_.reuse_scratch();
    const int place = grids_.scratch(cells);  // without values
    if (l == 0) data_.details = place;
    for (int b = 0; b < 3; ++b) grids_.add(range_of(l, b));
  }
  for (std::size_t l = 0; l + 1 < grids.size(); ++l)
    for (int b = 0; b < 3; ++b) {
      grids_.reuse_scratch();
      grids_.down(grids[l], low(b, 0) ? f.p_tilde : f.q_tilde, low(b, 1) ? f.p_tilde : f.q_tilde,
                  data_.details + 4 * int(l) + 1 + b);
    }
}

}  // namespace airlight::gpu::wavelet_fog
