#include "reference/path_tracer/sampling.h"

#include <catch2/catch.hpp>

#include "reference/path_tracer/surface_sampling.h"
#include "tests/reference/path_tracer/scenes.h"

namespace sampling_test {

using namespace airlight;
using namespace airlight::path_tracer;
using namespace airlight::path_tracer::test;

namespace {

const double extremes[] = {0x1p-53, 0x1p-33, 0.5, 1 - 0x1p-33, 1 - 0x1p-53};

}  // namespace

// The density integrates to 1 if u -> t has dt/du = 1/pdf: the mean of 1/pdf over a midpoint rule in u is the length.
// 1/pdf is smooth in u; midpoints converge as n^-2.
TEST_CASE("equiangular density is the derivative of the sampling", "[path_tracer]") {
  for (const double D : {-3.0, 0.5, 7.0})
    for (const double h : {1e-2, 1.0, 50.0}) {
      const Equiangular angles({{1, 2, 3}, {0, 1, 0}}, {1, 2 + D, 3 + h}, {0.25, 4});
      double length = 0;
      const int n = 400000;  // (f(1) - f(0)) / (24 n^2) of the worst, f = d(1/pdf)/du = 8.5e6, is 2e-6
      for (int i = 0; i < n; ++i) length += 1 / angles.pdf(angles.sample((i + 0.5) / n)) / n;
      CHECK(length == Approx(3.75).epsilon(1e-6));
    }
}

TEST_CASE("every sampler is finite at the ends of the uniforms", "[path_tracer]") {
  for (const double u : extremes)
    for (const double v : extremes) {
      CAPTURE(u, v);
      for (const double end : {2.0, infinity})
        for (const double h : {1e-9, 1.0, 1e9}) {
          const Equiangular angles({{0, 0, 0}, {0, 0, 1}}, {h, 0, 1}, {0, end});
          const double t = angles.sample(u);
          CHECK((t >= 0 && t <= end && std::isfinite(t)));
          CHECK((angles.pdf(t) > 0 && std::isfinite(angles.pdf(t))));
        }
      for (const char* const name : {"isotropic", "rayleigh", "hg", "hazy", "murky"})
        for (const double g : {0.0, 1e-12, 0.999, -0.999}) {
          const scene::PhaseFunction phase = phase_of(name, g);
          const double c = scene::sample_phase_cosine(phase, u);
          CHECK((c >= -1 && c <= 1));
          CHECK(scene::phase_value(phase, c) > 0);
          CHECK(turned(Vec3(0.6, 0, 0.8), c, v).norm() == Approx(1).epsilon(1e-12));
        }
      for (const scene::Material& material : {scene::Material(scene::Lambert{}), scene::Material(scene::Phong{}),
                                              scene::Material(scene::Phong{Rgb::Zero(), Rgb::Ones(), 1e5})}) {
        const Vec3 normal(0, 1, 0), in = Vec3(1, 1, 0).normalized();
        const Vec3 out = sample_reflection(material, normal, in, v, u, v);
        CHECK(out.norm() == Approx(1).epsilon(1e-12));
        CHECK(std::isfinite(pdf_reflection(material, normal, in, out)));
      }
      const auto light = white();
      CHECK(scene::sample_environment(light, u, v).norm() == Approx(1).epsilon(1e-12));
      CHECK(std::isfinite(elementary::log(u)));
    }
}

// The mean over sampled directions of reflectance * cosine / density is the reflected share of the light. For a Phong
// lobe seen along the normal none of the mirror lobe is lost below the horizon, and the cosine of the lobe's directions
// has mean (n + 1)/(n + 2) under its density: diffuse + specular (n + 2)/(n + 1) (n + 1)/(n + 2) = diffuse + specular.
TEST_CASE("reflections are sampled as their density says", "[path_tracer]") {
  const Vec3 normal = Vec3(0, 0.6, 0.8);
  const scene::Phong phong{Rgb::Constant(0.5), Rgb::Constant(0.3), 7};
  for (const scene::Material& material :
       {scene::Material(scene::Lambert{Rgb::Constant(0.8)}), scene::Material(phong)}) {
    double sum = 0, square = 0, inverse = 0, inverse_square = 0;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
      const RandomBlock block = SampleRandom(5, 1, 0, i).block(0, Purpose::scatter);
      const RandomBlock more = SampleRandom(5, 1, 0, i).block(1, Purpose::scatter);
      const Vec3 out = sample_reflection(material, normal, normal, more.coarse(0), block.fine(0), block.fine(1));
      const double pdf = pdf_reflection(material, normal, normal, out);
      const double share = pdf > 0 ? scene::brdf(material, normal, normal, out)[0] * normal.dot(out) / pdf : 0;
      sum += share;
      square += share * share;
      // Directions within 45 degrees of the normal: their solid angle by the mean of 1/pdf.
      const double cap = normal.dot(out) > std::sqrt(0.5) ? 1 / pdf : 0;
      inverse += cap;
      inverse_square += cap * cap;
    }
    const double mean = sum / n, error = std::sqrt((square / n - mean * mean) / n + 1e-30);
    CHECK(std::abs(mean - 0.8) < 4.5 * error + 1e-12);
    const double angle = inverse / n, angle_error = std::sqrt((inverse_square / n - angle * angle) / n);
    CHECK(std::abs(angle - 2 * pi * (1 - std::sqrt(0.5))) < 4.5 * angle_error);
  }
}

}  // namespace sampling_test
