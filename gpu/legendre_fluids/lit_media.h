// Media as polynomials under directional lights, as light_media.glsl reads them: the device's side of LitMedia.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "gpu/legendre_fluids/interface.h"
#include "methods/legendre_fluids/light_rays.h"

namespace airlight::gpu::legendre_fluids {

constexpr int most_densities =
    4096;  // coefficients of all media, each filled up to the same shape: 16 KiB of a uniform block

// Why shaders cannot hold media that the CPU can; empty if they can.
std::vector<std::string> unsupported(const airlight::legendre_fluids::LitMedia&);

class LightMediaOnDevice {
 public:
  // Keeps the media by reference. Throws as Buffer does.
  LightMediaOnDevice(Context&, const airlight::legendre_fluids::LitMedia&,
                     const airlight::legendre_fluids::RayOptions&);

  // The media that it keeps by reference were `before` and are now others. Uploads their densities where these differ. False, and nothing is
  // done: other definitions are needed.
  bool become(const airlight::legendre_fluids::LitMedia& before);

  int count() const { return int(media_.media.size()); }
  // Definitions for a program that includes light_media.glsl.
  const Definitions& definitions() const { return definitions_; }
  void bind(Program&, const Vec3& to_light) const;
  // Whether a density is below 0 somewhere: programs with NEGATIVE take it as 0 there.
  bool negative() const;
  // The density of a medium of n^3 coefficients becomes a field of a fluid's state, made positive where it is not; nothing leaves the device.
  // False, and nothing is done, where the medium has another shape or box.
  bool take(std::size_t medium, const Buffer& state, std::size_t field, int n, const Box&);
  // Dispatches after which every ray has left all boxes, where no density is below 0.
  int stretches() const;
  int series() const { return media_.coefficients; }  // coefficients of a density's integral along a ray

 private:
  Context& context_;
  const airlight::legendre_fluids::LitMedia& media_;
  Definitions definitions_;
  Buffer densities_, rule_;
  bool flows_ = false;             // a density is a flow's
  std::unique_ptr<Buffer> least_;  // of take(), and its program
  Program* taking_ = nullptr;
};

}  // namespace airlight::gpu::legendre_fluids
