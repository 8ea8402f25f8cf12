// How many surfaces hide the light along rays, against the oracle vectors.
#include <catch2/catch.hpp>
#include <cmath>

#include "methods/shadow_planes/shadow_volumes.h"
#include "tests/methods/shadow_planes/vectors.h"

namespace shadow_test {

using namespace airlight;
using namespace airlight::shadow_planes;
using namespace shadow_planes_test;

TEST_CASE("shadow planes: vectors of shadows", "[shadow_planes]") {
  int count = 0;
  for (const json& v : vectors_of("shadow")) {
    const json& in = v.at("input");
    CAPTURE(v.at("id").get<std::string>());
    auto scene = std::make_shared<scene::Scene>();
    scene::TriangleMesh mesh;
    for (const json& p : in.at("vertices")) mesh.vertices.push_back(vec(p));
    for (const json& t : in.at("triangles")) mesh.triangles.push_back({t[0], t[1], t[2]});
    scene->surfaces.push_back({"mesh", mesh, scene::Lambert{}});
    finish(*scene);
    const Ray ray{vec(in.at("O")), vec(in.at("dir")).normalized()};
    double end = number(in.at("far"));
    if (const auto hit = scene->geometry->first_hit(ray)) end = std::min(end, hit->t);
    const json& expected = v.at("expect");
    const ShadowVolumes shadows(std::make_shared<Occluders>(scene), vec(in.at("S")));
    const int m = shadows.count(ray.origin);
    std::vector<Crossing> crossings;
    std::vector<ShadowVolumes::Interval> lit;
    shadows.lit_parts(ray, end, m, nullptr, crossings, lit);
    // The counts, stretch by stretch; crossings at one place are one.
    const json& profile = expected.at("count_profile");
    CHECK(m == profile[0][2].get<int>());
    int now = m;
    std::size_t k = 0;
    for (const Crossing& c : crossings) {
      if (k + 1 < profile.size() && now == profile[k][2].get<int>() && c.change != 0 &&
          std::abs(c.x - number(profile[k][1])) < 1e-12)
        ++k;
      now += c.change;
      CHECK(c.x == Approx(number(profile[k][0])).epsilon(1e-13));
    }
    CHECK(k + 1 == profile.size());
    CHECK(now == profile.back()[2].get<int>());
    ++count;
  }
  CHECK(count == 7);
}

}  // namespace shadow_test
