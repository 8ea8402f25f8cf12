// The march of `variant = paper` on the device through the oracle's Gaussians, slice by slice of its own: sums with all three weights, and
// the integral that they tend to. Sources are the oracle's, towards the ray's origin by the shader of the centres.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "gpu/compensated_ray_marching/centre_tables.h"
#include "gpu/compensated_ray_marching/marched_smoke.h"
#include "gpu/view_uniforms.h"
#include "tests/gpu/device.h"
#include "tests/oracle_vectors.h"

namespace march_vectors_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::compensated_ray_marching;
using gpu::Buffer;
namespace at = gpu::compensated_ray_marching::at;

namespace {

constexpr double parity = 1e-4;  // row 30 of the stress list

scene::Medium medium_of(const json& in) {
  scene::GaussianSum sum;
  sum.cutoff = number(in.at("cut"));
  for (const json& b : in.at("rbf_x_y_z_r_w")) sum.gaussians.push_back({vec(b), number(b[3]), number(b[4])});
  scene::Medium medium;
  medium.sigma_t = Rgb::Constant(number(in.at("sigma_t")));
  medium.field = sum;
  return medium;
}

scene::View along(const Ray& ray) {
  const Vec3 up = std::abs(ray.direction.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitX();
  scene::View view{scene::look_at(ray.origin, ray.origin + ray.direction, up), 1, 1};
  view.camera.kind =
      scene::Camera::Kind::orthographic;  // which looks at all centres from one direction, as the oracle's rays do
  view.camera.height = 1;
  return view;
}

class MarchOnDevice {
 public:
  MarchOnDevice(gpu::Context& context, const json& in)
      : context_(context),
        medium_(medium_of(in)),
        options_(of_paper()),
        field_(medium_, options_),
        density_(context, field_, middle_, true),
        tables_(context, number(in.at("order")), Transmittance::series, 3, false),
        axis_(vec(in.at("slice_axis"))) {
    std::vector<double> centres;
    for (const json& b : in.at("rbf_x_y_z_r_w"))
      for (std::size_t k = 0; k < 5; ++k) centres.push_back(number(b[k]));
    count_ = centres.size() / 5;
    const std::size_t bands = in.at("source_sh_propagation")[0].size();
    std::vector<double> single(3 * bands * count_);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t b = 0; b < bands; ++b)
        for (std::size_t i = 0; i < count_; ++i)
          single[(c * bands + b) * count_ + i] = number(in.at("source_sh_propagation")[i][b]);
    centres_ = std::make_unique<Buffer>(context, "centres", centres);
    single_ = std::make_unique<Buffer>(context, "single", single);
    again_ = std::make_unique<Buffer>(context, "again", 8 * 3 * 4 * count_);
    sources_ = std::make_unique<Buffer>(context, "sources", 16 * count_);
  }

  struct Marched {
    double radiance, transmittance;
  };
  // From the ray's origin on, without what is behind.
  Marched operator()(const Ray& ray, double thickness, int count, SliceWeight weight) {
    const scene::View view = along(ray);
    gpu::Program& towards =
        gpu::compensated_ray_marching::program(context_, "centre_towards", 64, 1, tables_.definitions());
    tables_.bind(towards);
    centres_->bind(at::centres);
    single_->bind(at::single_bands);
    again_->bind(at::again);
    sources_->bind(at::centre_sources);
    towards.set("gaussian_count", int(count_));
    towards.set("perspective_", false);
    towards.set_double("eye", view.camera.position);
    towards.set_double("forward", view.camera.forward);
    towards.dispatch(int(count_));
    const double slope = std::abs(ray.direction.dot(axis_));
    const Buffer ranges(context_, "ranges",
                        std::vector<float>{0, float(thickness / slope), float(count), float(slope)}),
        airlight(context_, "airlight", 12), column(context_, "column", 4);
    auto definitions = density_.definitions();
    definitions["SCATTERS"] = "1";
    gpu::Program& march = gpu::compensated_ray_marching::program(context_, "march", 8, 8, definitions);
    ranges.bind(at::ranges);
    airlight.bind(at::airlight_layer);
    column.bind(at::column);
    sources_->bind(at::centre_sources);
    gpu::set_camera(march, view, middle_);
    density_.bind(march);
    march.set("least_source_density", field_.least_density());
    march.set("sigma_t", medium_.sigma_t);
    march.set("weight", int(weight));
    for (int first = 0; first < count; first += density_.slices()) {
      march.set("first_slice", first);
      march.dispatch(1, 1);
    }
    return {airlight.download<float>().at(0), std::exp(-medium_.sigma_t[0] * column.download<float>().at(0))};
  }
  CompensatedMarch on_processor(const json& in) const {
    MarchedSmoke smoke{std::get<scene::GaussianSum>(medium_.field), {}, {}, medium_.sigma_t};
    for (const json& list : in.at("source_sh_propagation")) {
      smoke.source.emplace_back();
      for (const json& c : list) smoke.source.back().push_back(Rgb::Constant(number(c)));
    }
    return CompensatedMarch(smoke);
  }

 private:
  static Options of_paper() {
    Options options;
    options.variant = Options::Variant::paper;
    return options;
  }

  gpu::Context& context_;
  scene::Medium medium_;
  Options options_;
  SmokeField field_;
  Point3 middle_{0.5, 0.5, 0.5};
  gpu::compensated_ray_marching::SmokeDensity density_;
  gpu::compensated_ray_marching::CentreTables tables_;
  Vec3 axis_;
  std::size_t count_ = 0;
  std::unique_ptr<Buffer> centres_, single_, again_, sources_;
};

}  // namespace

DEVICE_TEST_CASE("slices through Gaussians on the device add up to the oracle's, with all weights",
                 "[gpu][compensated_ray_marching]") {
  const gpu::Use use(context);
  int vectors = 0;
  for (const json& v : vectors_of("compensated_ray_marching", "march_compensated")) {
    const json &in = v.at("input"), &expected = v.at("expected");
    if (in.contains("residual")) continue;  // whose sum with the Gaussians the device knows at voxels alone
    MarchOnDevice march(context, in);
    const double thickness = number(in.at("slice_thickness")), background = number(in.at("background"));
    const int count = in.at("slices");
    const CompensatedMarch processor = march.on_processor(in);
    const Slices slices{vec(in.at("slice_axis")), thickness, count};
    for (std::size_t r = 0; r < in.at("rays").size(); ++r) {
      const Ray ray{vec(in.at("rays")[r].at("origin")), vec(in.at("rays")[r].at("direction"))};
      CAPTURE(v.at("id").get<std::string>(), r);
      const auto near = [&](double got, const char* name) {
        const double truth = number(expected.at(name)[r]);
        CAPTURE(name, got / truth - 1);
        CHECK(std::abs(got - truth) <= parity * truth);
      };
      const auto total = [&](const MarchOnDevice::Marched& m) { return m.radiance + m.transmittance * background; };
      near(march(ray, thickness, count, SliceWeight::exact).transmittance, "slice_transmittance");
      near(total(march(ray, thickness, count, SliceWeight::printed)), "slice_printed");
      near(total(march(ray, thickness, count, SliceWeight::paper)), "slice_paper");
      near(total(march(ray, thickness, count, SliceWeight::exact)), "slice_exact_weight");
      for (const SliceWeight weight : {SliceWeight::printed, SliceWeight::paper, SliceWeight::exact}) {
        const MarchOnDevice::Marched here = march(ray, thickness, count, weight);
        const Marched there = processor.slices(ray, slices, weight);
        CHECK(std::abs(here.radiance - there.radiance[0]) <=
              1e-5 * there.radiance[0] + 2 * gpu::test::injected_error());
        CHECK(std::abs(here.transmittance - there.transmittance[0]) <=
              1e-5 * there.transmittance[0] + 2 * gpu::test::injected_error());
      }
      const auto fine = march(ray, thickness / 16, 16 * count, SliceWeight::exact);
      near(fine.transmittance, "transmittance");
      near(total(fine), "radiance");
    }
    ++vectors;
  }
  CHECK(vectors == 2);
}

}  // namespace march_vectors_test
