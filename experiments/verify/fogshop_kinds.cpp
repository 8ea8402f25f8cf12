// Closed forms and the paper's variant of methods/fogshop.
#include "experiments/verify/readers.h"
#include "experiments/verify/vector_scene.h"
#include "methods/fogshop/homogeneous_airlight.h"
#include "methods/fogshop/paper_airlight.h"
#include "methods/fogshop/surface_psf.h"

namespace airlight::experiments::verification {

Check read_f(const Value& v) {
  const double u = v["in"]["u"].number(), limit = v["in"]["v"].number(), expected = v["value"].number();
  return {"", [=](VerifyProfile) { return Outcome{{relative("F", expected, fogshop::F(u, limit), 1e-12)}}; }};
}

Check read_average_depth(const Value& v) {
  const double u = v["in"]["u"].number(), expected = v["value"].number();
  return {"", [=](VerifyProfile) { return Outcome{{relative("T", expected, fogshop::average_depth(u), 1e-12)}}; }};
}

Check read_npsf(const Value& v) {
  const double gamma = v["in"]["gamma"].number(), T = v["in"]["T"].number(), expected = v["value"].number();
  return {"", [=](VerifyProfile) { return Outcome{{relative("NPSF", expected, fogshop::npsf(gamma, T), 1e-12)}}; }};
}

Check read_npsf_coefficient(const Value& v) {
  const int l = v["in"]["l"].integer_in(0, 1000);
  const double T = v["in"]["T"].number(), expected = v["value"].number();
  return {"",
          [=](VerifyProfile) { return Outcome{{relative("g", expected, fogshop::npsf_coefficient(l, T), 1e-12)}}; }};
}

Check read_airlight_homogeneous(const Value& v) {
  const Value in = v["in"];
  const double gamma = in["gamma"].number(), d_sv = in["d_sv"].number(), beta = in["beta"].number();
  const double d_vp = in["d_vp"].number_or_infinite(), expected = v["value"].number();
  return {"", [=](VerifyProfile) {
            return Outcome{{relative("L", expected, fogshop::homogeneous_airlight(gamma, d_sv, d_vp, beta), 1e-12)}};
          }};
}

Check read_airlight_paper(const Value& v) {
  const Value in = v["in"];
  scene::GaussianSum fog{{}, in["beta0"].number(), infinity};
  for (const RawGaussian& g : gaussians_from_objects(in["gaussians"])) fog.gaussians.push_back({g.b, 1 / g.a, g.c});
  const Point3 light = in["light"].vector();
  const Ray ray = ray_from(in["view"], in["dir"]);
  const double intensity = in["I0"].number(), end = in["d_r"].number_or_infinite(), expected = v["value"].number();
  return {"", [=](VerifyProfile) {
            const double got = fogshop::paper_airlight(fog, light, intensity, ray, end);
            return Outcome{{relative("L", expected, got, 1e-12)}};
          }};
}

}  // namespace airlight::experiments::verification
