// Fogmaps and the wavelets of methods/wavelet_fog.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "experiments/application/json_value.h"
#include "experiments/verify/one_ray.h"
#include "experiments/verify/readers.h"
#include "gpu/wavelet_fog/grids.h"
#include "gpu/wavelet_fog/wavelet_fog.h"
#include "methods/wavelet_fog/levels.h"
#include "methods/wavelet_fog/projection.h"
#include "scene/base/error.h"
#include "scene/math/bspline.h"
#include "scene/media/fogmap.h"
#include "scene/scene.h"

namespace airlight::experiments::verification {
namespace {

using namespace wavelet_fog;
using scene::Fogmap;

// Filters are dyadic fractions, or have 22 digits.
constexpr double rounding = 1e-15;

void compare(Outcome& outcome, const std::string& what, const std::vector<double>& expected,
             const std::vector<double>& got) {
  outcome.add(absolute(what + ": how many", double(expected.size()), double(got.size()), 0));
  for (std::size_t i = 0; i < std::min(expected.size(), got.size()); ++i)
    outcome.add(relative(fmt::format("{} {}", what, i), expected[i], got[i], rounding, rounding));
}

constexpr int most = 4096;  // indices and sizes of maps; more of them are no test

// Rows of as many numbers as `v` says in width and height.
Coefficients map_of(const Value& v, const std::string& field, std::array<int, 2> lo) {
  const std::array<int, 2> size{v["width"].integer_in(1, most), v["height"].integer_in(1, most)};
  const std::vector<double> values = v[field].numbers();
  if (values.size() != std::size_t(size[0]) * std::size_t(size[1])) v[field].complain("width times height numbers");
  return {{{lo[0], lo[1]}, {size[0], size[1]}}, values};
}

// Zeros beyond the stated indices are allowed: compared by index.
struct Listed {
  Coefficients c;  // of a sequence: one row
};
Listed sequence(const Value& v) {
  const std::vector<double> values = v["values"].numbers();
  return {{{{v["lo"].integer_in(-most, most), 0}, {int(values.size()), 1}}, values}};
}
Listed grid(const Value& v) {
  const Value lo = v["lo"];
  return {map_of(v, "values", {lo[0].integer_in(-most, most), lo[1].integer_in(-most, most)})};
}
void compare(Outcome& outcome, const std::string& what, const Coefficients& expected, const Coefficients& got,
             double share = 4e-15, double floor = 4e-15) {
  const scene::SplineMap e(0, expected.range, expected.values), g(0, got.range, got.values);
  for (int a = 0; a < 2; ++a)
    if (got.range.size[a] > expected.range.size[a] + 4) outcome.add(truth(what + ": no more than it needs", false));
  for (int j = std::min(expected.range.lo[1], got.range.lo[1]);
       j < std::max(expected.range.lo[1] + expected.range.size[1], got.range.lo[1] + got.range.size[1]); ++j)
    for (int i = std::min(expected.range.lo[0], got.range.lo[0]);
         i < std::max(expected.range.lo[0] + expected.range.size[0], got.range.lo[0] + got.range.size[0]); ++i)
      outcome.add(
          relative(fmt::format("{} {} {}", what, i, j), e.coefficient(i, j), g.coefficient(i, j), share, floor));
}

// A sequence as a map of one row: along v a filter of one tap leaves it alone, but halves indices; so the row is 0.
const Taps alone{0, {1}};
Coefficients down(const Coefficients& c, const Taps& taps) { return filter_down(c, taps, alone); }

scene::HeightProfile profile_of(const Value& v) {
  const std::string type = v["type"].text();
  if (type == "none") return scene::SameAtAllHeights{};
  if (type == "layers") return scene::Layers{v["z"].numbers(), v["v"].numbers()};
  if (type == "exp") return scene::ExponentialFall{v["z0"].number(), v["H"].number()};
  v["type"].complain("one of none, layers, exp");
}

// The vectors' map lies in x and y, their height is z; here it lies in x and z.
Point3 upright(const Vec3& v) { return {v[0], v[2], v[1]}; }

Fogmap fogmap_of(const Value& v) {
  Fogmap fog;
  const Coefficients c = map_of(v, "coef", {0, 0});
  fog.map = scene::SplineMap(v["degree"].integer_in(0, 3), c.range, c.values);
  fog.profile = profile_of(v["profile"]);
  fog.x0 = v["origin"][0].number();
  fog.z0 = v["origin"][1].number();
  fog.cell = v["cell"].number();
  return fog;
}

struct Segment {
  Ray ray;
  double length;
};
Segment segment_of(const Value& v) {
  const Point3 a = upright(v["A"].vector()), b = upright(v["B"].vector());
  const double length = (b - a).stableNorm();
  return {{a, length > 0 ? Vec3((b - a) / length) : Vec3(0, 1, 0)}, length};
}

// Adds to a check of optical depths those of a film of one pixel, which the device draws from A towards a wall at B, once for each settings.
Check drawn_too(Check check, const Value& v, const std::vector<Given>& settings) {
  const Segment s = segment_of(v);
  const double depth = v["expected"]["optical_depth"].number();
  const Fogmap fog = fogmap_of(v);
  const std::vector<double> c = v["coef"].numbers();
  if (!v.has("rtol_f32") || v["rtol_f32"].json().is_null())
    check.not_on_device = "the vector has no tolerance of single precision";
  else if (!(s.length > 0))
    check.not_on_device = "no pixel shows a ray without length";
  else if (!(*std::min_element(c.begin(), c.end()) >= 0 && v["sigma"].number() >= 0))
    check.not_on_device = "no renderer draws densities below 0";
  else if (depth > 60)
    check.not_on_device = "nothing is left of the transmittance in single precision";
  if (check.not_on_device != Check{}.not_on_device) return check;
  auto drawn = std::make_shared<scene::Scene>();
  drawn->width = drawn->height = 1;
  drawn->camera = view_along(s.ray, 1).camera;
  drawn->ambient_in_scatter = Rgb::Ones();
  scene::Medium medium;
  medium.field = std::make_shared<const Fogmap>(fog);
  medium.sigma_t = Rgb::Constant(v["sigma"].number());
  drawn->media = {medium};
  scene::Surface wall;
  wall.shape = scene::Plane{s.ray.at(s.length), -s.ray.direction};
  drawn->surfaces = {wall};
  finish(*drawn);
  const gpu::wavelet_fog::WaveletFog method;
  const std::vector<std::string> refused = method.supports(*drawn, {method.settings(), {}});
  if (!refused.empty()) {
    check.not_on_device = refused.front();
    return check;
  }
  const double rtol = v["rtol_f32"].number_in(0, 1);
  check.on_device = [=](VerifyProfile) {
    Outcome out;
    for (const auto& given : settings) {
      const scene::Film film = OneRay(gpu::wavelet_fog::WaveletFog(), drawn, given)(s.ray, 1);
      // From the opacity where that has more digits. Around a transmittance of 1 or 0 the film's own rounding is added.
      const double opacity = film.layer("ambient")[0], clear = film.layer("transmittance")[0];
      out.add(relative(given.at("variant"), depth, opacity < 0.5 ? -std::log1p(-opacity) : -std::log(clear), rtol,
                       (depth == 0 ? rtol : 0) + 1.2e-7));
    }
    return out;
  };
  return check;
}

// The scene file that a user would have written, of what a vector has.
std::string scene_of(const Value& v) {
  std::vector<std::string> values;
  for (std::size_t i = 0; i < v["coef"].size(); ++i) {
    const Value c = v["coef"][i];
    values.push_back(c.json().is_string() ? c.text() : fmt::format("{}", c.number()));
  }
  std::string profile;
  if (v.has("profile") && v["profile"]["type"].text() == "layers")
    profile = fmt::format("profile = {{ type = \"layers\", heights = {}, factors = {} }}\n",
                          v["profile"]["z"].numbers(), v["profile"]["v"].numbers());
  return fmt::format(
      "[film]\nwidth = 1\nheight = 1\n[camera]\ntype = \"perspective\"\nposition = [0, 0, 0]\nlook_at = [0, 0, 1]\n"
      "vertical_fov = 1\n[[medium]]\ntype = \"fogmap\"\ncell = 1\ndegree = {}\nsize = [{}, {}]\nvalues = [{}]\n{}region = {{ type = \"slab\", lo = 0, hi = 1 "
      "}}\n",
      v["degree"].integer(), v["width"].integer(), v["height"].integer(), fmt::join(values, ", "), profile);
}

// The fault that the refusal must name.
std::string fault_of(const Value& v) {
  for (std::size_t i = 0; i < v["coef"].size(); ++i) {
    if (v["coef"][i].json().is_string()) return fmt::format("values[{}]", i);
    const int width = std::max(1, v["width"].integer());
    if (v["coef"][i].number() < 0) return fmt::format("column {}, row {}", int(i) % width, int(i) / width);
  }
  if (v["width"].integer() * v["height"].integer() == 0) return "size";
  if (number_or(v, "mu", 1) > 1) return "mu";
  return v.has("levels") ? "levels" : "heights";
}

}  // namespace

Check read_sequence(const Value& v) {
  const int n = v["degree"].integer_in(0, 3);
  const auto p = v["p"].numbers(), q = v["chui_wang_q"].numbers(), r = v["restriction"].numbers();
  const std::vector<double> firsts = {v["p_offset"].number(), v["chui_wang_q_offset"].number(),
                                      v["restriction_offset"].number()};
  return {"", [=](VerifyProfile) {
            Outcome outcome;
            compare(outcome, "p", p, two_scale(n).values);
            compare(outcome, "q", q, semi_orthogonal(n).values);
            compare(outcome, "restriction", r, restriction(n).values);
            compare(outcome, "offsets", firsts,
                    {double(two_scale(n).first), double(semi_orthogonal(n).first), double(restriction(n).first)});
            return outcome;
          }};
}

Check read_family(const Value& v) {
  const std::string name = v["family"].text();
  const int degree = v["degree"].integer();
  const std::vector<std::vector<double>> taps = {v["p"].numbers(), v["q"].numbers(), v["p_tilde"].numbers(),
                                                 v["q_tilde"].numbers()};
  const std::vector<double> offsets = v["offsets"].numbers();
  if (offsets.size() != 4) v["offsets"].complain("four offsets");
  return {"", [=](VerifyProfile) {
            const Family& f = family(name);
            Outcome outcome;
            outcome.add(absolute("degree", degree, f.degree, 0));
            const Taps* got[4] = {&f.p, &f.q, &f.p_tilde, &f.q_tilde};
            for (int i = 0; i < 4; ++i) {
              compare(outcome, fmt::format("filter {}", i), taps[i], got[i]->values);
              outcome.add(absolute(fmt::format("offset {}", i), offsets[i], got[i]->first, 0));
            }
            return outcome;
          }};
}

Check read_basis(const Value& v) {
  const int n = v["degree"].integer_in(0, 3);
  const std::vector<double> u = v["u"].numbers(), expected = v["expected"].numbers();
  return {"", [=](VerifyProfile) {
            std::vector<double> got;
            for (const double x : u) got.push_back(scene::bspline(n, x));
            Outcome outcome;
            compare(outcome, "N", expected, got);
            return outcome;
          }};
}

Check read_analysis_1d(const Value& v) {
  const Listed c = sequence(v["c"]), a = sequence(v["expected"]["a"]);
  std::vector<Listed> d;
  for (std::size_t l = 0; l < v["expected"]["d"].size(); ++l) d.push_back(sequence(v["expected"]["d"][l]));
  const std::string name = v["family"].text();
  return {"", [=](VerifyProfile) {
            Outcome outcome;
            Coefficients coarse = c.c;
            for (std::size_t l = 0; l < d.size(); ++l) {
              compare(outcome, fmt::format("d {}", l), d[l].c, down(coarse, family(name).q_tilde));
              coarse = down(coarse, family(name).p_tilde);
            }
            compare(outcome, "a", a.c, coarse);
            return outcome;
          }};
}

Check read_analysis_2d(const Value& v) {
  const Listed c = grid(v["c"]);
  const Value e = v["expected"];
  const std::vector<Listed> bands = {grid(e["aa"]), grid(e["ad"]), grid(e["da"]), grid(e["dd"])};
  const std::string name = v["family"].text();
  if (v["levels"].integer() != 1) v["levels"].complain("1");
  const char* names[] = {"aa", "ad", "da", "dd"};
  return {"",
          [=](VerifyProfile) {
            const Bands b = split(c.c, family(name));
            const Coefficients* got[] = {&b.aa, &b.ad, &b.da, &b.dd};
            Outcome outcome;
            for (std::size_t i = 0; i < 4; ++i) compare(outcome, names[i], bands[i].c, *got[i]);
            return outcome;
          },
          [=](VerifyProfile) {
            const Family& f = family(name);
            const Taps* along[] = {&f.p_tilde, &f.q_tilde};
            gpu::wavelet_fog::Grids grids(gpu::Context::get());
            grids.add(c.c.range);
            std::vector<int> got;
            for (std::size_t i = 0; i < 4; ++i) {
              const Taps &u = *along[i / 2], &w = *along[i % 2];
              got.push_back(grids.add(coarse_range(c.c.range, u, w)));
              grids.reuse_scratch();
              grids.down(0, u, w, got.back());
            }
            grids.allocate();
            grids.upload(c.c.values);
            grids.run();
            Outcome outcome;
            for (std::size_t i = 0; i < 4; ++i)
              compare(outcome, names[i], bands[i].c, {grids.range(got[i]), grids.download(got[i])}, 0, 1e-6);
            return outcome;
          }};
}

Check read_restriction_1d(const Value& v) {
  const Listed c = sequence(v["c"]), a = sequence(v["expected"]["a"]);
  const int n = v["degree"].integer_in(0, 3);
  return {"", [=](VerifyProfile) {
            Outcome outcome;
            compare(outcome, "a", a.c, down(c.c, restriction(n)));
            return outcome;
          }};
}

Check read_projection_1d(const Value& v) {
  const Listed c = sequence(v["c"]), a = sequence(v["expected"]["a"]);
  const int n = v["degree"].integer_in(0, 3);
  return {"", [=](VerifyProfile) {
            Outcome outcome;
            compare(outcome, "a", a.c, orthogonal_projection(c.c, n));
            return outcome;
          }};
}

Check read_fogmap_depth(const Value& v) {
  const Fogmap fog = fogmap_of(v);
  const Segment s = segment_of(v);
  const double sigma = v["sigma"].number(), tolerance = v["rtol_f64"].number();
  const Value e = v["expected"];
  const double depth = e["optical_depth"].number(), clear = e["transmittance"].number(), opaque = e["opacity"].number();
  const Check check{
      "", [=](VerifyProfile) {
        const double got = sigma * scene::density_integral(fog, s.ray, {0, s.length});
        const double back = sigma * scene::density_integral(fog, {s.ray.at(s.length), -s.ray.direction}, {0, s.length});
        const double floor = depth == 0 ? tolerance : 1e-300;
        return Outcome{{relative("optical depth", depth, got, tolerance, floor),
                        relative("transmittance", clear, std::exp(-got), tolerance * (1 + std::abs(depth))),
                        relative("opacity", opaque, -std::expm1(-got), tolerance, floor),
                        relative("backwards", depth, back, tolerance, floor)}};
      }};
  return drawn_too(check, v, {{{"variant", "direct"}}, {{"variant", "skip"}}});
}

Check read_multiresolution(const Value& v) {
  const Fogmap fog = fogmap_of(v);
  const Segment s = segment_of(v);
  const std::string name = v["family"].text();
  const int L = v["levels"].integer_in(0, 12);
  const double mu = v["mu"].number(), sigma = v["sigma"].number(), tolerance = v["rtol_f64"].number();
  const double depth = v["expected"]["optical_depth"].number(), full = v["expected"]["full_optical_depth"].number();
  const Check check{
      "", [=](VerifyProfile) {
        const Coarse coarse = name == "restrict" ? Coarse::restricted : Coarse::wavelet;
        const Levels levels = make_levels(fog.map, name, coarse, L, true);
        const scene::MapLine line = line_over(fog, s.ray);
        const double length = length_in_box(levels, line, s.length);
        Visits visits;
        return Outcome{
            {relative("summed", depth,
                      sigma * summed_depth(levels, fog.profile, line, {0, infinity}, length, mu, visits), tolerance),
             relative("telescoped", depth,
                      sigma * telescoped_depth(levels, fog.profile, line, {0, infinity}, length, mu, visits),
                      tolerance),
             relative("full", full, sigma * scene::density_integral(fog, s.ray, {0, s.length}), tolerance)}};
      }};
  std::vector<Given> settings;
  for (const char* variant : {"paper", "tele"})
    settings.push_back({{"variant", variant},
                        {"coarse", name == "restrict" ? "restricted" : "wavelet"},
                        {"levels", std::to_string(L)},
                        {"mu", fmt::format("{}", mu)}});
  return drawn_too(check, v, settings);
}

Check read_composite(const Value& v) {
  const double depth = v["optical_depth"].number(), behind = v["L_P"].number(), fog = v["L_fog"].number();
  const double clear = v["expected"]["transmittance"].number(), expected = v["expected"]["L"].number();
  return {"", [=](VerifyProfile) {
            return Outcome{{relative("transmittance", clear, std::exp(-depth), rounding),
                            relative("L", expected, composite(depth, behind, fog), rounding)}};
          }};
}

Check read_reject(const Value& v) {
  const std::string fault = fault_of(v);
  const std::string text = scene_of(v);
  const bool leveled = v.has("levels");
  const int levels = leveled ? v["levels"].integer() : 0;
  const double mu = v.has("mu") ? v["mu"].number() : 1;
  const std::string name = leveled ? v["family"].text() : "";
  return {
      "", [=](VerifyProfile) {
        try {
          const scene::Scene scene = scene::parse_scene(text, "vector", ".");
          require_share(mu);
          if (leveled)
            make_levels(std::get<scene::FogmapPointer>(scene.media.at(0).field)->map, name, Coarse::wavelet, levels,
                        false);
        } catch (const Error& e) {
          return Outcome{{truth("refused, names " + fault, std::string(e.what()).find(fault) != std::string::npos)}};
        }
        return Outcome{{truth("refused", false)}};
      }};
}

}  // namespace airlight::experiments::verification
