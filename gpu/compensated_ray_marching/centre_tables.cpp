#include "gpu/compensated_ray_marching/centre_tables.h"

#include <fmt/format.h>

#include <cmath>

#include "methods/compensated_ray_marching/gaussian_depth.h"
#include "methods/compensated_ray_marching/sphere_shadow.h"
#include "scene/math/sh_product.h"
#include "scene/math/spherical_harmonics.h"

namespace airlight::gpu::compensated_ray_marching {
namespace {

using airlight::compensated_ray_marching::Transmittance;

struct TermData {
  int i, j;
  double value;
};

// Terms of the triple product, one row per coefficient. The list begins with the start and end of each row.
std::vector<TermData> terms_of(int order) {
  std::vector<std::vector<TermData>> rows(std::size_t(order * order));
  for (const auto& [i, j, k, value] : scene::triple_product(order).terms()) {
    const int index[3] = {i, j, k};
    for (int a = 0; a < 3; ++a) {
      const bool again = (a > 0 && index[a] == index[0]) || (a > 1 && index[a] == index[1]);
      if (again) continue;  // a coefficient that stands in the term twice
      const int b = index[(a + 1) % 3], c = index[(a + 2) % 3];
      rows[std::size_t(index[a])].push_back({b, c, value});
      if (b != c) rows[std::size_t(index[a])].push_back({c, b, value});
    }
  }
  std::vector<TermData> all;
  int at = order * order;
  for (const auto& row : rows) {
    all.push_back({at, at + int(row.size()), 0});
    at += int(row.size());
  }
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  return all;
}

// Terms for directions instead of bands: the contribution of each direction to a coefficient.
std::vector<TermData> terms_of(int order, const std::vector<airlight::compensated_ray_marching::Ordinate>& directions) {
  const int bands = order * order, count = int(directions.size());
  std::vector<TermData> all;
  for (int b = 0; b < bands; ++b) all.push_back({bands + b * count, bands + (b + 1) * count, 0});
  std::vector<std::vector<double>> harmonics;
  for (const auto& d : directions) harmonics.push_back(scene::evaluate_sh(order, d.direction));
  for (int b = 0; b < bands; ++b)
    for (int k = 0; k < count; ++k) all.push_back({k, k, harmonics[std::size_t(k)][std::size_t(b)]});
  return all;
}

std::string exact(double value) { return fmt::format("{:.17g}{}LF", value, std::floor(value) == value ? ".0" : ""); }

// Values of all tables in a row, and definitions that say where each begins.
struct Tables {
  std::vector<double> values;
  Definitions definitions;

  void number(const char* name, std::size_t value) { definitions[name] = std::to_string(value); }
  void begin(const char* name) { number(name, values.size()); }
  void add(const char* name, const std::vector<double>& list) {
    begin(name);
    values.insert(values.end(), list.begin(), list.end());
  }
};

// Factors of recurrences for spherical harmonics: scene/math/spherical_harmonics.cpp.
void add_harmonics(int order, Tables& t) {
  const auto size = std::size_t(order);
  std::vector<double> up(size * size, 0.0), back = up, first;
  double diagonal = 1 / (4 * pi);
  for (int m = 0; m <= order; ++m) {
    if (m > 0) diagonal *= (2 * m + 1) / (2.0 * m);
    first.push_back((m % 2 ? -1 : 1) * std::sqrt((m > 0 ? 2 : 1) * diagonal));
    for (int l = m + 1; l < order; ++l) {
      const double span = double(l - m) * (l + m);
      const auto at = std::size_t(l) * order + m;
      up[at] = std::sqrt((2.0 * l - 1) * (2.0 * l + 1) / span);
      if (l > m + 1) back[at] = std::sqrt((2.0 * l + 1) * (l - 1.0 - m) * (l - 1.0 + m) / ((2.0 * l - 3) * span));
    }
  }
  t.add("UP_AT", up);
  t.add("BACK_AT", back);
  t.add("FIRST_AT", first);
}

// Depths of a Gaussian about the axis to its centre.
void add_depths(int order, double cutoff, Tables& t) {
  using airlight::compensated_ray_marching::DepthTable;
  const auto size = std::size_t(order);
  t.begin("DEPTH_AT");
  const DepthTable depths(order, DepthTable::Spacing::even, airlight::compensated_ray_marching::depth_samples, cutoff);
  for (std::size_t i = 0; i < depths.samples().size(); ++i)
    t.values.push_back(depths.samples()[i] * about_axis_factor(int(i % size)));
  t.number("DEPTH_LAST", depths.samples().size() / size - 1);
}

void add_exponential(int order, Transmittance kind, Tables& t) {
  t.number("EXPONENTIAL_LINEAR", std::size_t(Transmittance::paper_linear));
  t.number("EXPONENTIAL_SQUARED", std::size_t(Transmittance::paper_squared));
  t.number("EXPONENTIAL", std::size_t(kind));
  const bool linear = kind == Transmittance::paper_linear || kind == Transmittance::paper_squared;
  t.definitions["THRESHOLD"] = exact(linear ? airlight::compensated_ray_marching::squaring_threshold
                                            : airlight::compensated_ray_marching::series_threshold);
  if (linear) {
    const auto& exponential = airlight::compensated_ray_marching::linear_exponential(order);
    t.add("LOG_A_AT", exponential.log_constants());
    t.add("LOG_B_AT", exponential.log_slopes());
    t.number("LINEAR_LAST", exponential.log_constants().size() - 1);
    t.definitions["LINEAR_LONGEST"] = exact(exponential.longest());
  } else {
    t.begin("LOG_A_AT");
    t.begin("LOG_B_AT");
    t.number("LINEAR_LAST", 1);
    t.definitions["LINEAR_LONGEST"] = "1.0LF";
  }
}

// Shadows of spheres by the angle that these fill.
void add_shadows(int order, Transmittance kind, bool objects, Tables& t) {
  t.definitions["LEAST_SINE"] = exact(std::sin(airlight::compensated_ray_marching::least_hidden));
  std::vector<std::vector<double>> shadows;
  if (objects) shadows = airlight::compensated_ray_marching::shadow_table(order, kind).samples();
  const std::size_t last = std::max<std::size_t>(shadows.size(), 2) - 1;
  t.begin("SHADOW_AT");
  for (const auto& zonal : shadows)
    for (std::size_t l = 0; l < std::size_t(order); ++l) t.values.push_back(zonal[l] * about_axis_factor(int(l)));
  t.begin("SINES_AT");
  for (std::size_t i = 0; i < shadows.size(); ++i) t.values.push_back(std::sin(0.5 * pi * double(i) / double(last)));
  t.begin("COSINES_AT");
  for (std::size_t i = 0; i < shadows.size(); ++i) t.values.push_back(std::cos(0.5 * pi * double(i) / double(last)));
  t.number("SHADOW_LAST", last);
  t.definitions["SHADOWS_PER_ANGLE"] = exact(double(last) / (0.5 * pi));
}

}  // namespace

double about_axis_factor(int l) { return std::sqrt(4 * pi / (2 * l + 1)); }

CentreTables::CentreTables(Context& context, int order, Transmittance kind, double cutoff, bool objects)
    : order_(order) {
  const auto bands = std::size_t(order) * order;
  Tables t;
  t.number("SH_ORDER", std::size_t(order));
  t.number("BANDS", bands);
  add_harmonics(order, t);
  add_depths(order, cutoff, t);
  add_exponential(order, kind, t);
  add_shadows(order, kind, objects, t);
  tables_ = std::make_unique<Buffer>(context, "tables of sources", t.values);
  std::vector<airlight::compensated_ray_marching::Ordinate> directions;
  if (kind == Transmittance::directional) directions = airlight::compensated_ray_marching::transmittance_directions();
  t.number("PARTS", directions.empty() ? bands : directions.size());
  terms_ = std::make_unique<Buffer>(context, "terms of products",
                                    directions.empty() ? terms_of(order) : terms_of(order, directions));
  definitions_ = std::move(t.definitions);
}

void CentreTables::bind(Program& p) const {
  tables_->bind(at::centre_tables);
  p.set("sh_order", order_);
}

void CentreTables::bind_terms() const { terms_->bind(at::terms); }

}  // namespace airlight::gpu::compensated_ray_marching
