#include "scene/picture.h"

namespace airlight::scene {

PictureLayers::PictureLayers(Film& film, const Kept& kept) : width_(std::size_t(film.width)) {
  const auto layer = [&](const char* name, bool is_kept) { return is_kept ? film.add(name).data() : nullptr; };
  mean_ = layer("mean", true);
  transmittance_ = layer("transmittance", kept.transmittance);
  airlight_ = layer("airlight", kept.airlight);
  surface_ = layer("surface", kept.surface);
  ambient_ = layer("ambient", kept.ambient);
}

void PictureLayers::put(int x, int y, const Pixel& pixel) const {
  const std::size_t at = 3 * (std::size_t(y) * width_ + std::size_t(x));
  const auto put = [at](float* layer, const Rgb& value) {
    for (std::size_t c = 0; layer && c < 3; ++c) layer[at + c] = float(value[Eigen::Index(c)]);
  };
  put(mean_, pixel.airlight + pixel.surface + pixel.ambient);
  put(transmittance_, pixel.transmittance);
  put(airlight_, pixel.airlight);
  put(surface_, pixel.surface);
  put(ambient_, pixel.ambient);
}

Rgb reflected_light(const Scene& scene, const Hit& hit, const Vec3& to_view, const Incident& in) {
  const double cosine = hit.normal.dot(in.to_light);
  if (!(cosine > 0) || (in.irradiance == 0).all()) return Rgb::Zero();
  const Material& material = scene.surfaces[std::size_t(hit.surface)].material;
  const Rgb reflected = brdf(material, hit.normal, in.to_light, to_view) * in.irradiance * cosine;
  if ((reflected == 0).all()) return Rgb::Zero();
  const Point3 start = scene.geometry->offset_origin(hit.position, hit.normal, in.to_light);
  return scene.geometry->occluded({start, in.to_light}, in.distance) ? Rgb(Rgb::Zero()) : reflected;
}

}  // namespace airlight::scene
