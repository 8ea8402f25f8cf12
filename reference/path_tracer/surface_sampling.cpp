#include "reference/path_tracer/surface_sampling.h"

#include <algorithm>
#include <cmath>

#include "reference/path_tracer/sampling.h"

namespace airlight::path_tracer {
namespace {

// How often the mirror lobe is chosen: its share of the reflectance.
double lobe_share(const scene::Phong& p) {
  const double diffuse = p.diffuse.mean(), specular = p.specular.mean();
  return specular > 0 ? specular / (diffuse + specular) : 0;
}

Vec3 mirrored(const Vec3& normal, const Vec3& in) { return 2 * normal.dot(in) * normal - in; }

}  // namespace

Vec3 sample_reflection(const scene::Material& material, const Vec3& normal, const Vec3& in, double u_lobe, double u,
                       double turns) {
  if (const auto* phong = std::get_if<scene::Phong>(&material); phong && u_lobe < lobe_share(*phong)) {
    // u^(1/(n+1)) by our own logarithm and exponential.
    const double c = elementary::exp(elementary::log(u) / (phong->exponent + 1));
    return turned(mirrored(normal, in), std::min(c, 1.0), turns);
  }
  return turned(normal, std::sqrt(u), std::sqrt(1 - u), turns);
}

double pdf_reflection(const scene::Material& material, const Vec3& normal, const Vec3& in, const Vec3& out) {
  const double cosine = std::max(0.0, normal.dot(out)) / pi;
  const auto* phong = std::get_if<scene::Phong>(&material);
  if (!phong) return cosine;
  const double share = lobe_share(*phong);
  const double c = mirrored(normal, in).dot(out);
  const double lobe =
      c > 0 ? (phong->exponent + 1) / (2 * pi) * elementary::exp(phong->exponent * elementary::log(std::min(c, 1.0)))
            : 0;
  return (1 - share) * cosine + share * lobe;
}

}  // namespace airlight::path_tracer
