// Light of suns that fogmaps scatter, on the GPU as on the CPU.
#include "scene/geometry/shapes.h"
#include "scene/media/fogmap.h"
#include "tests/gpu/wavelet_fog/pictures.h"
#include "tests/methods/wavelet_fog/sun_scenes.h"

namespace sun_test {

using namespace airlight;
using namespace airlight::gpu::test;

namespace {

const std::pair<Point3, Point3> views[] = {
    {{-12, 2, -22}, {3, 1.5, 8}}, {{0, 1, 0}, {10, 0.5, 3}}, {{5, 25, 5}, {6, 0, 5.5}}};

const scene::HeightProfile profiles[] = {scene::Layers{{0, 3, 8}, {1, 0.8, 0}}, scene::ExponentialFall{0.5, 2.5},
                                         scene::SameAtAllHeights{}};

std::shared_ptr<scene::Scene> sunny(int degree, const scene::HeightProfile& profile,
                                    const std::pair<Point3, Point3>& view, const Vec3& to_sun) {
  auto made = scene_of(patches(degree, 40, 33, 1, 3 + degree, profile), 0.15, view.first, view.second);
  made->width = 32, made->height = 24;
  made->lights = {scene::DirectionalLight{to_sun.normalized(), Rgb(3, 2.5, 2)}};
  made->media[0].albedo = Rgb(0.9, 0.8, 0.7);
  made->name = fmt::format("degree {} {} from {}, sun at {}", degree, profile_name(profile), view.first[1], to_sun[1]);
  return made;
}

}  // namespace

DEVICE_TEST_CASE("wavelet fog: a sun on the GPU is that of the CPU", "[gpu][wavelet_fog][thorough]") {
  const scene::PhaseFunction phases[] = {scene::Isotropic{}, scene::Rayleigh{}, scene::HenyeyGreenstein{0.7},
                                         scene::Hazy{}, scene::Murky{}};
  const Vec3 suns[] = {{0.5, 0.4, 0.3}, {-1, 0.05, 0.2}, {0, 1, 0}};
  int i = 0;
  for (int degree = 0; degree <= 3; ++degree)
    for (const scene::HeightProfile& profile : profiles)
      for (const auto& view : views) {
        // Each sun with each degree, each profile and each view.
        const Vec3& to_sun = suns[std::size_t(degree + (&profile - profiles) + (&view - views)) % 3];
        const auto scene = sunny(degree, profile, view, to_sun);
        scene->media[0].phase = phases[++i % 5];
        compare(scene, {{"sun", "true"}, {"variant", degree % 2 ? "direct" : "skip"}}, 4e-6);
      }
}

DEVICE_TEST_CASE("wavelet fog: two suns, one below the horizon, thick fog and ends of rays on the GPU",
                 "[gpu][wavelet_fog]") {
  const auto scene = sunny(1, profiles[0], views[0], {0.3, 0.5, -0.4});
  scene->lights.push_back(scene::DirectionalLight{Vec3(0.6, -0.2, 0.3).normalized(), Rgb(0.5, 1, 2)});
  compare(scene, {{"sun", "true"}}, 1.6e-6);
  scene->media[0].sigma_t = Rgb(0.6, 0.3, 0);  // pieces are halved, rays end, a channel is clear
  compare(scene, {{"sun", "true"}}, 1.6e-6);
  compare(scene,
          {{"sun", "true"}, {"sun_step", "1"}, {"sun_points", "4"}, {"termination", "0.001"}, {"variant", "direct"}},
          1.8e-6);
}

DEVICE_TEST_CASE("wavelet fog: a frame under a sun stays on the device, also where the sun moves",
                 "[gpu][wavelet_fog]") {
  const gpu::wavelet_fog::WaveletFog method;
  const Given given{{"sun", "true"}};
  const auto first = sunny(1, profiles[1], views[0], {0.5, 0.4, 0.3});
  const auto prepared = method.prepare(first, {method.settings(), given}, {1, {}});
  scene::Execution none{1, {}}, all{1, {}};
  none.layers.emplace();
  prepared->render(view_of(*first), all);
  const auto second = sunny(1, profiles[1], views[0], {0.5, 0.42, 0.3});
  REQUIRE(prepared->next(second, none));
  scene::Rendering warm = prepared->render(view_of(*second), none);
  CHECK(warm.counters["bytes_up"] == 0);
  CHECK(warm.counters["bytes_down"] == 0);
  CHECK(warm.counters["syncs"] == 1);
  CHECK(warm.counters["allocations"] == 0);
  const scene::Rendering moved = prepared->render(view_of(*second), all), anew = render(method, second, given);
  for (const auto& [layer, values] : anew.film.layers) CHECK(moved.film.layer(layer) == values);
  const scene::Rendering cpu = render(wavelet_fog::WaveletFog(), second, given);
  CHECK(moved.counters.at("sun_points") == Approx(cpu.counters.at("sun_points")).epsilon(2e-3));
}

namespace {

// How many pixels of a layer differ by more than rounding: rays that pass shadows where the two backends' shadow rays do not agree.
int pixels_that_differ(const scene::Film& a, const scene::Film& b, const std::string& layer) {
  const std::vector<float>&x = a.layer(layer), &y = b.layer(layer);
  const double most = *std::max_element(x.begin(), x.end());
  int count = 0;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    double error = 0;
    for (std::size_t c = i; c < i + 3; ++c)
      error = std::max(error, std::abs(double(y[c]) - x[c]) / (std::abs(x[c]) + 0.01 * most + 1e-300));
    count += error > 1e-5 + 10 * gpu::test::injected_error() ? 1 : 0;
  }
  return count;
}

// Every layer to `bound` at the 99th percentile; and but for `most` of the pixels, all of the airlight.
void compare_under_sun(const std::shared_ptr<const scene::Scene>& scene, const Given& given, double bound, int most) {
  const scene::Rendering a = render(wavelet_fog::WaveletFog(), scene, given);
  const scene::Rendering b = render(gpu::wavelet_fog::WaveletFog(), scene, given);
  compare(*scene, given, a.film, b.film, bound);
  const int differ = pixels_that_differ(a.film, b.film, "airlight");
  if (std::getenv("AIRLIGHT_TEST_FIGURES"))
    fmt::print("  {} of {} pixels differ; {} and {} points, {} and {} shadow rays\n", differ, a.film.pixels(),
               a.counters.at("sun_points"), b.counters.at("sun_points"), a.counters.at("shadow_rays"),
               b.counters.at("shadow_rays"));
  CAPTURE(scene->name, given);
  CHECK(differ <= most);
  CHECK(b.counters.at("sun_points") == Approx(a.counters.at("sun_points")).epsilon(5e-3));
  CHECK(b.counters.at("shadow_rays") == Approx(a.counters.at("shadow_rays")).epsilon(2e-3));
}

}  // namespace

DEVICE_TEST_CASE("wavelet fog: suns behind surfaces on the GPU are those of the CPU", "[gpu][wavelet_fog][thorough]") {
  // The ten scenes in which the CPU is judged by the quadrature and the path tracer, with the map's cells that it is judged with, and
  // those without houses with houses too. Columns through thick fog are differences of
  // sums that are rounded: up to 20 of optical depth in a ball, 8 from above.
  int number = 0;
  for (airlight::test::SunCase c : airlight::test::sun_cases) {
    const double bound = number == 7 ? 2e-5 : number == 4 ? 1e-5 : 2.5e-6;
    for (const bool houses : {false, true}) {
      if (c.houses && !houses) continue;
      c.houses = houses;
      const auto scene = airlight::test::sun_scene(c, 32, 24);
      scene->name = fmt::format("{}{}", c.name, houses ? ", houses" : "");
      Given given{{"sun", "true"}};
      if (!houses) given["sun_step"] = "0.25";
      compare_under_sun(scene, given, bound, number == 7 ? 53 : 1);
    }
    ++number;
  }
}

DEVICE_TEST_CASE("wavelet fog: suns behind spheres and planes, lit surfaces on the GPU",
                 "[gpu][wavelet_fog][thorough]") {
  for (const auto& view : views) {
    const auto scene = sunny(1, profiles[0], view, {0.5, 0.4, 0.3});
    scene->lights.push_back(scene::DirectionalLight{Vec3(-0.3, 0.7, -0.2).normalized(), Rgb(0.5, 1, 2)});
    for (int i = 0; i < 8; ++i)
      scene->surfaces.push_back({"ball", scene::Sphere{{4.0 * i - 12, 1.5 + 0.5 * i, 5.0 - 3 * (i % 4)}, 0.4 + 0.2 * i},
                                 scene::Lambert{Rgb(0.3, 0.5, 0.7)}});
    scene->surfaces.push_back(
        {"ground", scene::Plane{{0, -0.5, 0}, Vec3::UnitY()}, scene::Lambert{Rgb(0.6, 0.5, 0.4)}});
    scene->surfaces.push_back(airlight::test::scene_named("wavelet_fog/valley", 4, 4)->surfaces[1]);
    finish(*scene);
    compare_under_sun(scene, {{"sun", "true"}}, 3e-6, 2);
    compare_under_sun(scene, {{"sun", "true"}, {"shadow_steps", "1000"}, {"sun_points", "2"}}, 3e-6, 2);
    scene->surfaces.resize(8);  // no triangle, rays that end nowhere
    finish(*scene);
    compare_under_sun(scene, {{"sun", "true"}}, 3e-6, 2);
  }
}

DEVICE_TEST_CASE("wavelet fog: suns in several media on the GPU are those of the CPU", "[gpu][wavelet_fog][thorough]") {
  const scene::PhaseFunction phases[] = {scene::HenyeyGreenstein{0.6}, scene::Rayleigh{}, scene::Isotropic{}};
  for (const auto& view : views)
    for (const bool houses : {false, true}) {
      const auto scene = sunny(1, profiles[0], view, {0.5, 0.4, 0.3});
      scene->width = 16, scene->height = 12;
      scene->name = fmt::format("several media{} from {}", houses ? " behind houses" : "", view.first[1]);
      for (int i = 0; i < 3; ++i) {
        scene::Medium other;
        auto fog = patches(i == 2 ? 0 : i + 2, 20 + 7 * i, 25, 1.1 + 0.15 * i, 7 + i, profiles[(i + 1) % 3]);
        fog->cos_turn = 0.8, fog->sin_turn = 0.6;
        other.field = scene::FogmapPointer(fog);
        if (i == 0) other.region = Box{{-15, -9, -15}, {15, 9, 15}};
        if (i == 1) other.region = scene::Sphere{{2, 1, 3}, 9};
        if (i == 2) other.region = scene::Slab{Vec3::UnitY(), -2, 6};
        other.sigma_t = Rgb(0.05, i == 0 ? 0 : 0.3, 0.1);
        other.albedo = Rgb(0.5, 0.9, 0.8);
        other.phase = phases[i];
        scene->media.push_back(other);
      }
      scene->lights.push_back(scene::DirectionalLight{Vec3(0, 1, 0), Rgb(0.5, 1, 2)});
      if (houses) scene->surfaces = airlight::test::scene_named("wavelet_fog/valley", 4, 4)->surfaces;
      finish(*scene);
      compare_under_sun(scene, {{"sun", "true"}}, 4e-6, 2);
    }
}

namespace {

scene::Film rows_of(const scene::Film& film, int first, int last) {
  scene::Film part(film.width, last - first);
  for (const auto& [layer, values] : film.layers)
    part.layers[layer].assign(values.begin() + 3 * first * film.width, values.begin() + 3 * last * film.width);
  return part;
}

}  // namespace

DEVICE_TEST_CASE("wavelet fog: rays under a sun are done in strips and parts on the GPU",
                 "[gpu][wavelet_fog][slow][thorough]") {
  // Rays along 2048 cells: more loops than a dispatch has on llvmpipe.
  const auto large = sunny(1, profiles[1], {{-25, 1.2, 0.1}, {20, 0.9, 0}}, {0.5, 0.4, 0.3});
  large->media[0].field = scene::FogmapPointer(patches(1, 2048, 64, 0.02, 3, profiles[1]));
  large->camera.vertical_fov = 0.02;
  large->width = 8, large->height = 6;
  large->surfaces = airlight::test::scene_named("wavelet_fog/valley", 4, 4)->surfaces;
  large->name = "2048 cells";
  finish(*large);
  compare_under_sun(large, {{"sun", "true"}, {"sun_step", "1"}}, 3e-6, 2);
  // 600 rays a row and 607 rows are a strip, which ends in a small fog below the middle.
  const auto tall = sunny(1, profiles[0], {{0, 2, -14}, {0, 6.5, 0}}, {-0.6, 0.35, -0.4});
  tall->media[0].field = scene::FogmapPointer(patches(1, 12, 8, 1, 3, profiles[0]));
  tall->surfaces = {{"box", scene::make_box({Point3(-2, -1, -1), Point3(-1, 4, 1)}), scene::Lambert{Rgb::Zero()}}};
  tall->width = 600, tall->height = 640;
  finish(*tall);
  const Given given{{"sun", "true"}};
  const scene::Film a = render(wavelet_fog::WaveletFog(), tall, given).film,
                    b = render(gpu::wavelet_fog::WaveletFog(), tall, given).film;
  for (const auto& [first, last] : {std::pair(540, 607), std::pair(607, 640)}) {
    const scene::Film part = rows_of(a, first, last);
    tall->name = fmt::format("strips, rows from {}", first);
    compare(*tall, given, part, rows_of(b, first, last), 3e-6);
    const auto& light = part.layer("airlight");
    CHECK(std::count_if(light.begin(), light.end(), [](float v) { return v > 1e-3f; }) > std::ssize(light) / 4);
  }
}

}  // namespace sun_test
