// One marched ray: equal steps through what media hold of it.
#pragma once
#include "reference/half_resolution_march/options.h"
#include "reference/lit_media/lit_media.h"

namespace airlight::half_resolution_march {

struct Fog {
  Rgb airlight = Rgb::Zero();       // [W/m^2/sr]
  Rgb transmittance = Rgb::Ones();  // from the camera to the end of the ray
  double distance = 0;              // mean distance that airlight comes from [m]; only with reproject
};

// The part of a ray that is marched: from where media begin (or the camera) to where they end, at most to t_end. Endless media are cut
// where the thinnest channel has the optical depth `horizon`.
struct Stretch {
  Interval t;
  double in_media = 0;       // length between the first and the last medium [m]
  Rgb beyond = Rgb::Ones();  // what is left of each channel behind the cut, 0 or 1
};
Stretch marched_stretch(const lit_media::LitMedia&, const Ray&, double t_end, bool from_camera);

// Arrays of a thread, kept between rays.
struct Steps {
  std::vector<double> t;
  lit_media::Samples samples;
};

// n equal steps of length h, each sampled at the share `offset` of it, extinction k and source S there:
//   analytic  L += T S (1 - exp(-k h)) / k,  T *= exp(-k h): exact for constant k and S
//   riemann   T *= exp(-k h),  L += T S h: order 1, too dark, as in common shaders
// The mean distance weighs steps by the airlight that they add to all channels. Without airlight it is the middle of the stretch.
Fog march(const lit_media::LitMedia&, const Options&, const Ray&, const Stretch&, double offset, Steps&,
          lit_media::Counters&);

}  // namespace airlight::half_resolution_march
