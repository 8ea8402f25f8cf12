#include "methods/legendre_fluids/lit_media.h"

#include <algorithm>

#include "scene/light/background.h"
#include "scene/light/scattered_lights.h"
#include "scene/math/legendre_range.h"
#include "scene/media/same_medium.h"

namespace airlight::legendre_fluids {
namespace {

constexpr int least_beside_kinks =
    12;  // coefficients: with fewer, stretches are cut into many where what is positive is no polynomial

// The density along a ray [m]: by as many Gauss points as are exact, or what is positive of it.
double column(const scene::LegendreBox& field, const Ray& ray, Interval t) {
  if (field.negative()) return scene::density_integral(field, ray, t);
  t = scene::extent(field, ray, t);
  if (t.empty()) return 0;
  const auto [nx, ny, nz] = field.shape();
  const scene::LegendrePoints& rule = scene::legendre_points((nx + ny + nz - 3) / 2 + 1);
  const Vec3 middle = field.local(ray.at(0.5 * (t.lo + t.hi)));
  const Vec3 half = t.length() * ray.direction.cwiseQuotient(field.box().size());
  const auto count = int(rule.node.size());
  double sum = 0;
  for (int begin = 0; begin < count; begin += lanes) {
    Lanes node = Lanes::Zero(), weight = Lanes::Zero();
    const int here = std::min(lanes, count - begin);
    node.head(here) = rule.node.segment(begin, here);
    weight.head(here) = rule.weight.segment(begin, here);
    sum += (weight * series_values(field.shape(), field.coefficients().data(), middle[0] + half[0] * node,
                                   middle[1] + half[1] * node, middle[2] + half[2] * node))
               .sum();
  }
  return std::max(0.0, 0.5 * t.length() * sum);
}

}  // namespace

std::string unsupported_field(const std::vector<scene::Medium>& media, std::size_t i) {
  const scene::Medium& medium = media[i];
  std::string why = scene::unknown_field<scene::LegendrePointer, scene::Homogeneous>(media, i);
  if (!why.empty()) return why;
  const bool box = std::holds_alternative<Box>(medium.region);
  if (std::holds_alternative<scene::Homogeneous>(medium.field))
    return box ? ""
               : fmt::format("{} is homogeneous in a region that is {}, expected a box", scene::label(media, i),
                             scene::region_name(medium.region));
  if (box || std::holds_alternative<scene::Unbounded>(medium.region)) return "";
  return fmt::format("{} has a region that is a {}, expected none or a box", scene::label(media, i),
                     scene::region_name(medium.region));
}

scene::LegendrePointer field_within_region(const scene::Medium& medium) {
  const Box* region = std::get_if<Box>(&medium.region);
  if (const auto* constant = std::get_if<scene::Homogeneous>(&medium.field))
    return std::make_shared<const scene::LegendreBox>(*region, scene::TensorShape{1, 1, 1},
                                                      Eigen::VectorXd::Constant(1, constant->density * std::sqrt(8.0)));
  const scene::LegendrePointer& field = std::get<scene::LegendrePointer>(medium.field);
  if (!region) return field;
  const Box inside = intersect(*region, field->box());
  if (!(inside.size().array() > 0).all()) return nullptr;
  if (inside.lo == field->box().lo && inside.hi == field->box().hi) return field;
  const Point3 lo = field->local(inside.lo), hi = field->local(inside.hi);
  std::array<Eigen::MatrixXd, 3> part;
  for (std::size_t a = 0; a < 3; ++a)
    part[a] = scene::legendre_restriction(field->shape()[a], lo[Eigen::Index(a)], hi[Eigen::Index(a)]);
  return std::make_shared<const scene::LegendreBox>(
      inside, field->shape(), scene::along_axes(part[0], part[1], part[2], field->coefficients(), field->shape()));
}

bool same_density(const scene::Medium& a, const scene::Medium& b) {
  scene::Medium other = b;
  other.sigma_t = a.sigma_t, other.albedo = a.albedo, other.phase = a.phase;
  const auto *x = std::get_if<scene::LegendrePointer>(&a.field), *y = std::get_if<scene::LegendrePointer>(&b.field);
  if (x && y && (*x)->shape() == (*y)->shape() && (*x)->box().lo == (*y)->box().lo &&
      (*x)->box().hi == (*y)->box().hi && (*x)->coefficients() == (*y)->coefficients())
    other.field = a.field;
  return scene::same_medium(a, other);
}

double negative_share(const scene::TensorShape& shape, const Eigen::VectorXd& coefficients) {
  std::array<Eigen::MatrixXd, 3> values;
  std::array<Eigen::VectorXd, 3> weight;
  for (std::size_t a = 0; a < 3; ++a) {
    const scene::LegendrePoints points(shape[a], 4 * shape[a]);
    values[a] = points.values;
    weight[a] = 0.5 * points.weight;
  }
  const Eigen::VectorXd all = scene::along_axes(values[0], values[1], values[2], coefficients, shape);
  double share = 0;
  Eigen::Index at = 0;
  for (const double x : weight[0])
    for (const double y : weight[1])
      for (const double z : weight[2]) share += all[at++] < 0 ? x * y * z : 0;
  return share;
}

bool may_shadow(const scene::Surface& surface, const Box& box, const Vec3& to_light) {
  const auto least = [](const Box& b, const Vec3& d) {
    return d.cwiseProduct((d.array() > 0).select(b.lo, b.hi)).sum();
  };
  return scene::match(
      surface.shape,
      [&](const scene::TriangleMesh& mesh) {
        double most = -infinity;
        for (const Point3& v : mesh.vertices) most = std::max(most, v.dot(to_light));
        return most > least(box, to_light);
      },
      [&](const scene::Sphere& s) { return s.center.dot(to_light) + s.radius > least(box, to_light); },
      [&](const scene::Plane& plane) {
        const double rising = plane.normal.dot(to_light), at = plane.point.dot(plane.normal);
        return rising < 0 ? -least(box, -plane.normal) > at : rising > 0 && least(box, plane.normal) < at;
      });
}

std::vector<bool> shadowed_lights(const scene::Scene& scene, const LitMedia& lit) {
  std::vector<bool> shadowed;
  for (const scene::DirectionalLight& light : lit.lights) {
    bool any = false;
    for (const LitMedium& m : lit.media)
      for (const scene::Surface& surface : scene.surfaces)
        any = any || may_shadow(surface, m.field->box(), light.to_light);
    shadowed.push_back(any);
  }
  return shadowed;
}

LitMedia::LitMedia(const scene::Scene& scene, const LitMedia* before) {
  for (const scene::Light& light : scene.lights)
    if (const auto* sun = std::get_if<scene::DirectionalLight>(&light);
        sun && (scatter(scene.media, light) || (scene.geometry && scene::shines(light))))
      lights.push_back(*sun);
  for (const scene::Medium& medium : scene.media) {
    if (!extinguishes(medium)) continue;
    const LitMedium* known = before && media.size() < before->media.size() ? &before->media[media.size()] : nullptr;
    if (known && !same_density(*known->medium, medium)) known = nullptr;
    LitMedium lit{&medium, known ? known->field : field_within_region(medium)};
    if (!lit.field || lit.field->greatest() == 0) continue;
    if (known) lit.negative_share = known->negative_share;
    int along = 2;
    for (const int n : lit.field->shape()) along += n - 1;
    coefficients = std::max(coefficients, along);
    grey = grey && (medium.sigma_t == medium.sigma_t[0]).all();
    media.push_back(std::move(lit));
  }
  const auto negative = [](const LitMedium& m) { return m.field->negative(); };
  if (std::any_of(media.begin(), media.end(), negative)) coefficients = std::max(coefficients, least_beside_kinks);
}

int LitMedia::find_columns(double rounding, const LitMedia* before) {
  int made = 0;
  for (std::size_t i = 0; i < media.size(); ++i) {
    LitMedium& m = media[i];
    m.rounding = rounding / m.medium->sigma_t.maxCoeff();
    const LitMedium* known = before && i < before->media.size() ? &before->media[i] : nullptr;
    if (known && (known->field != m.field || known->rounding != m.rounding)) known = nullptr;
    for (const scene::DirectionalLight& light : lights) {
      std::size_t found = 0;
      while (known && found < known->columns.size() && before->lights[found].to_light != light.to_light) ++found;
      const bool keeps = known && found < known->columns.size();
      m.columns.push_back(keeps ? known->columns[found]
                                : std::make_shared<const LightColumns>(*m.field, light.to_light, m.rounding));
      made += keeps ? 0 : 1;
    }
  }
  return made;
}

double LitMedia::greatest_negative_share() {
  double most = 0;
  for (LitMedium& m : media) {
    if (!m.negative_share)
      m.negative_share = m.field->negative() ? negative_share(m.field->shape(), m.field->coefficients()) : 0;
    most = std::max(most, *m.negative_share);
  }
  return most;
}

Rgb LitMedia::light_depth(const Point3& x, std::size_t light) const {
  Rgb depth = Rgb::Zero();
  for (const LitMedium& m : media) depth += m.medium->sigma_t * m.columns[light]->at(x);
  return depth;
}

Rgb LitMedia::view_depth(const Ray& ray, double end) const {
  Rgb depth = Rgb::Zero();
  for (const LitMedium& m : media) depth += m.medium->sigma_t * column(*m.field, ray, {0, end});
  return depth;
}

}  // namespace airlight::legendre_fluids
