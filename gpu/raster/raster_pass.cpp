#include "gpu/raster/raster_pass.h"

#include <algorithm>
#include <cmath>

#include "gpu/view_uniforms.h"
#include "scene/base/error.h"

namespace airlight::gpu {
namespace {

using scene::Camera;
using scene::View;

// Range of x/z (perspective) or x of a sphere whose centre is at (x, z) in the camera's frame; all if it reaches behind
// the camera. Tangents of the circle that the sphere is seen as from above.
Interval seen_range(double x, double z, double r, bool perspective) {
  if (!perspective) return {x - r, x + r};
  if (!(z > r * (1 + 1e-6))) return {-infinity, infinity};
  const double root = r * std::sqrt(x * x + (z - r) * (z + r)), below = (z - r) * (z + r);
  return {(x * z - root) / below, (x * z + root) / below};
}

// Share of the film in the area that the rays cover, along each side.
struct Share {
  double x, y;
};

// The rectangle of each solid in the image, a pixel wider, -1 to 1, y downwards.
std::vector<std::array<float, 4>> rectangles(const std::vector<Solid>& solids, const View& view, const HitGrid& grid,
                                             const Share& share) {
  const Camera& camera = view.camera;
  const HalfFilm half = half_film(view);
  const auto place = [](double v, double half_size, double share, double pixel) {
    return float(std::clamp((v / half_size + 1) * share - 1 + pixel, -1.0, 1.0));
  };
  std::vector<std::array<float, 4>> result;
  for (const Solid& s : solids) {
    if (s.kind == 0) {
      result.push_back({-1, -1, 1, 1});
      continue;
    }
    const Vec3 to = Point3(s.point[0], s.point[1], s.point[2]) - camera.position;
    const bool perspective = camera.kind == Camera::Kind::perspective;
    const double z = to.dot(camera.forward);
    const Interval x = seen_range(to.dot(camera.right), z, s.radius, perspective);
    const Interval y = seen_range(-to.dot(camera.up), z, s.radius, perspective);
    const double px = 2.0 / grid.columns(view), py = 2.0 / grid.rows(view);
    result.push_back({place(x.lo, half.x, share.x, -px), place(y.lo, half.y, share.y, -py),
                      place(x.hi, half.x, share.x, px), place(y.hi, half.y, share.y, py)});
  }
  return result;
}

}  // namespace

RasterPass::RasterPass(Context& context)
    : context_(context), mesh_(context.raster_program("raster/mesh")), solid_(context.raster_program("raster/solid")) {
  if (context.limits().vertex_storage_blocks < 3 || context.limits().fragment_storage_blocks < 3)
    throw Unavailable("gpu: the vertex shaders of " + context.renderer() + " read no storage buffers");
}

HitImage& RasterPass::image(int width, int height) {
  // Two sizes are kept: a low resolution is drawn beside the film's.
  const auto found = std::find_if(images_.begin(), images_.end(), [&](const std::unique_ptr<HitImage>& image) {
    return image->width() == width && image->height() == height;
  });
  if (found != images_.end()) {
    std::rotate(images_.begin(), found, found + 1);
  } else {
    images_.insert(images_.begin(), std::make_unique<HitImage>(context_, width, height));
    images_.resize(std::min<std::size_t>(images_.size(), 2));
  }
  return *images_.front();
}

void RasterPass::find(const SurfacesOnDevice& surfaces, const View& view, const Buffer& distances,
                      const Buffer* primitives, const HitGrid& grid) {
  const HitImage& image = this->image(grid.columns(view), grid.rows(view));
  const double extent = surfaces.extent(view.camera.position);
  const HalfFilm half = half_film(view);
  const Share share{view.width / (double(grid.block) * image.width()),
                    view.height / (double(grid.block) * image.height())};
  const auto places = rectangles(surfaces.solids(), view, grid, share);
  if (!rectangles_ || rectangles_->bytes() != places.size() * sizeof(places[0]))
    rectangles_ = std::make_unique<Buffer>(context_, "rectangles", places.size() * sizeof(places[0]));
  rectangles_->upload(places);
  surfaces.bind();
  rectangles_->bind(13);
  image.begin();
  for (const SurfacesOnDevice::Run& run : surfaces.runs()) {
    RasterProgram& program = run.mesh ? mesh_ : solid_;
    set_view(program, view);
    program.set("block", grid.block);
    program.set_double("depth_scale", std::ldexp(1.0, -std::min(120, std::ilogb(extent) + 41)));
    if (run.mesh) {
      program.set_double("view_across", Vec3(view.camera.right / half.x));
      program.set_double("view_upwards", Vec3(view.camera.up / half.y));
      program.set_double("view_extent", extent);
      program.set_double("share_x", share.x);
      program.set_double("share_y", share.y);
      program.set("first_triangle", run.first);
      program.draw(3L * run.count);
    } else {
      program.set("triangle_count", surfaces.triangles());
      program.set("first_solid", run.first);
      program.draw(6, run.count);
    }
  }
  image.end();
  image.copy_distances(distances, 4 * grid.first);
  if (primitives) image.copy_primitives(*primitives, 4 * grid.first);
}

}  // namespace airlight::gpu
