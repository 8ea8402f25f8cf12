// One pass is what a pressure takes: there along three axes, each coefficient over its eigenvalue, and back. The
// benchmark is FFTW's own: one plan for all three axes, measured, there and back, with nothing between; in place or out
// of place, whichever is faster in that round. All of one thread, by the processor's time that it took, so that others
// who use the machine slow both alike.
#include <fftw3.h>
#include <time.h>

#include <cmath>

#include "experiments/stable_fluids/probes.h"
#include "experiments/stable_fluids/stages.h"
#include "reference/stable_fluids/transforms.h"

namespace airlight::experiments {
namespace {

using namespace stable_fluids;

// Of this thread [s].
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

template <class Real>
struct Library;
template <>
struct Library<double> {
  using Plan = fftw_plan;
  static Plan plan(int n, double* from, double* to, fftw_r2r_kind k) {
    return fftw_plan_r2r_3d(n, n, n, from, to, k, k, k, FFTW_MEASURE);
  }
  static void run(Plan p) { fftw_execute(p); }
  static void destroy(Plan p) { fftw_destroy_plan(p); }
  static double* allocate(std::size_t n) { return fftw_alloc_real(n); }
};
template <>
struct Library<float> {
  using Plan = fftwf_plan;
  static Plan plan(int n, float* from, float* to, fftw_r2r_kind k) {
    return fftwf_plan_r2r_3d(n, n, n, from, to, k, k, k, FFTW_MEASURE);
  }
  static void run(Plan p) { fftwf_execute(p); }
  static void destroy(Plan p) { fftwf_destroy_plan(p); }
  static float* allocate(std::size_t n) { return fftwf_alloc_real(n); }
};

// The library by itself, there and back.
template <class Real>
class Bare {
 public:
  Bare(int n, scene::Side::Kind sides, bool in_place)
      : count_(std::size_t(n) * n * n),
        from_(Library<Real>::allocate(count_)),
        to_(in_place ? from_ : Library<Real>::allocate(count_)) {
    using Kind = scene::Side::Kind;
    const fftw_r2r_kind there = sides == Kind::periodic ? FFTW_R2HC : sides == Kind::open ? FFTW_RODFT10 : FFTW_REDFT10;
    const fftw_r2r_kind back = sides == Kind::periodic ? FFTW_HC2R : sides == Kind::open ? FFTW_RODFT01 : FFTW_REDFT01;
    there_ = Library<Real>::plan(n, from_, to_, there);
    back_ = Library<Real>::plan(n, to_, from_, back);
  }
  Bare(const Bare&) = delete;
  ~Bare() {
    Library<Real>::destroy(there_);
    Library<Real>::destroy(back_);
    if (to_ != from_) fftw_free(to_);
    fftw_free(from_);
  }
  double seconds(const std::vector<Real>& values) {
    std::copy(values.begin(), values.end(), from_);
    const double start = processor_time();
    Library<Real>::run(there_);
    Library<Real>::run(back_);
    return processor_time() - start;
  }
  // What came back is the product of the logical lengths times what went.
  double error(const std::vector<Real>& values, double length) const {
    double most = 0;
    for (std::size_t i = 0; i < count_; ++i) most = std::max(most, std::abs(from_[i] / length - double(values[i])));
    return most;
  }

 private:
  std::size_t count_;
  Real *from_, *to_;
  typename Library<Real>::Plan there_, back_;
};

template <class Real>
Findings measure_transforms(const scene::Settings& s) {
  const auto sides = s.text("sides") == "periodic" ? scene::Side::Kind::periodic
                     : s.text("sides") == "open"   ? scene::Side::Kind::open
                                                   : scene::Side::Kind::free_slip;
  const int n = int(s.integer("n"));
  const Lattice l = make_lattice(unit_cube(sides), n);
  const Helmholtz<Real> pressure(l, at_centers, true);
  std::vector<Real> values(count_of(l.n)), ours_values;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = Real(2 * uniform32(philox4x32_10({std::uint32_t(i), std::uint32_t(i >> 32), 0, 0}, {2, 0})[0]) - 1);
  Bare<Real> in_place(n, sides, true), out_of_place(n, sides, false);
  std::vector<double> seconds, bare, share;
  repeat(int(s.integer("runs")), s.real("budget"), [&] {
    ours_values = values;
    const double start = processor_time();
    pressure.solve(ours_values, 0, 1);
    seconds.push_back(processor_time() - start);
    bare.push_back(std::min(in_place.seconds(values), out_of_place.seconds(values)));
    share.push_back(bare.back() / seconds.back());
  });
  const double length = std::pow(sides == scene::Side::Kind::periodic ? n : 2.0 * n, 3);
  Findings found;
  const auto each_cell = [&](std::vector<double> times) {
    for (double& t : times) t *= 1e9 / double(values.size());
    return times;
  };
  found.figures = {
      measured("share", share), measured("ns_per_cell", each_cell(seconds)),
      measured("library_ns_per_cell", each_cell(bare)),
      exactly("library_error", std::max(in_place.error(values, length), out_of_place.error(values, length)))};
  return found;
}

}  // namespace

std::string TransformsRate::about() const {
  return "the pressure's transforms, there and back, against one measured plan of FFTW; one thread";
}

std::vector<scene::SettingSpec> TransformsRate::settings() const {
  return {scene::integer_setting("n", "64", 1, 512, "cells a side of a cube"),
          scene::choice_setting("sides", "walls", {"walls", "periodic", "open"}, "cosines, Fourier's, sines"),
          scene::choice_setting("precision", "float", {"float", "double"}, "of the values"),
          scene::integer_setting("runs", "31", 1, 10000, "timed, each beside the library's"),
          scene::real_setting("budget", "1", 0, 1e6, "seconds after which no further run begins")};
}

std::vector<std::string> TransformsRate::figures() const {
  return {"share", "ns_per_cell", "library_ns_per_cell", "library_error"};
}

Findings TransformsRate::run(const ProbeInput&, const scene::Settings& s, const scene::Execution& given) const {
  scene::Execution execution = given;
  execution.threads = 1;
  Findings found;
  with_threads(execution, [&] {
    found = s.text("precision") == "double" ? measure_transforms<double>(s) : measure_transforms<float>(s);
  });
  return found;
}

}  // namespace airlight::experiments
