// Authoring of Gaussian fog: the rules of every tool, and the undo.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "methods/fogshop/authoring/edit.h"
#include "methods/fogshop/authoring/emit.h"
#include "methods/fogshop/authoring/paint.h"
#include "methods/fogshop/authoring/screen.h"
#include "scene/base/error.h"
#include "scene/media/gaussian_sum.h"

namespace authoring_test {

using namespace airlight;
using namespace airlight::fogshop::authoring;

namespace {

const std::vector<Point3> bent = {{0, 0, 0}, {1.3, 0, 0}, {1.3, 2.1, 0}, {1.3, 2.1, 0}, {0, 2.1, 0.9}};

double length_of(const std::vector<Point3>& stroke) {
  double length = 0;
  for (std::size_t i = 1; i < stroke.size(); ++i) length += (stroke[i] - stroke[i - 1]).norm();
  return length;
}

// Arc length at which a point lies on the stroke, and its distance from it.
std::pair<double, double> place_on(const std::vector<Point3>& stroke, const Point3& x) {
  double best = infinity, where = 0, before = 0;
  for (std::size_t i = 1; i < stroke.size(); ++i) {
    const Vec3 edge = stroke[i] - stroke[i - 1];
    const double length = edge.norm();
    if (length == 0) continue;
    const double t = std::clamp((x - stroke[i - 1]).dot(edge) / length, 0.0, length);
    const double distance = (stroke[i - 1] + t * edge / length - x).norm();
    if (distance < best) {
      best = distance;
      where = before + t;
    }
    before += length;
  }
  return {where, best};
}

GaussianList painted(std::uint32_t seed = 3) {
  GaussianList list;
  list.begin();
  paint(list, {bent, {.a = 4, .c = 2, .tag = "stroke"}, {}, {}, seed});
  return list;
}

double depth(const GaussianList& list, const std::vector<Id>& ids, const Ray& ray, double d) {
  double sum = 0;
  for (const auto& g : list.all())
    if (std::find(ids.begin(), ids.end(), g.id) != ids.end()) sum += scene::line_integral({g.b, 1 / g.a, g.c}, ray, d);
  return sum;
}

}  // namespace

TEST_CASE("a stroke is resampled at equal arc length", "[fogshop][authoring]") {
  const double length = length_of(bent);
  for (const double spacing : {0.75 / 4, 0.05, 0.9, length, length * 1.001}) {
    const auto points = resample(bent, spacing);
    REQUIRE(points.size() == std::size_t(std::floor(length / spacing)) + 1);
    for (std::size_t j = 0; j < points.size(); ++j) {
      const auto [arc, off] = place_on(bent, points[j].position);
      CHECK(std::abs(arc - double(j) * spacing) < 1e-12);
      CHECK(off < 1e-12);
      CHECK(points[j].tangent.norm() == Approx(1).margin(1e-15));
    }
  }
  // On one edge neighbours are `spacing` apart.
  const auto straight = resample({{-7, 3, 11}, {5, 4, 2}}, 0.0371);
  for (std::size_t j = 1; j < straight.size(); ++j)
    CHECK(std::abs((straight[j].position - straight[j - 1].position).norm() - 0.0371) < 1e-12);
  CHECK(resample({{1, 2, 3}}, 0.1).size() == 1);
  CHECK(resample({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, 0.1).size() == 1);
  CHECK_THROWS_AS(resample({{0, 0, 0}, {1, 0, 0}}, 1e-7), Error);
}

TEST_CASE("the jitter is perpendicular to the stroke and below 1/a", "[fogshop][authoring]") {
  GaussianList list;
  list.begin();
  const Paint op{bent, {.a = 2.5, .c = 0.7}, 0.003, {}, 11};
  const auto ids = paint(list, op);
  const auto points = resample(bent, 0.003);
  REQUIRE(ids.size() == points.size());
  double greatest = 0;
  Vec3 mean = Vec3::Zero();
  double square = 0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const Vec3 offset = list.all()[j].b - points[j].position;
    CHECK(offset.norm() < 1 / 2.5);
    CHECK(std::abs(offset.dot(points[j].tangent)) < 1e-15);
    greatest = std::max(greatest, offset.norm());
    mean += offset / double(points.size());
    square += offset.squaredNorm() / double(points.size());
  }
  // Uniform in a disc of radius R: E[r^2] = R^2/2, with the variance R^4/12 per draw; each coordinate has R^2/4.
  const double n = double(points.size()), r2 = 1 / (2.5 * 2.5);
  CHECK(std::abs(square - r2 / 2) < 4 * r2 / std::sqrt(12 * n));
  CHECK(mean.norm() < 4 * std::sqrt(r2 / 2 / n));
  CHECK(greatest > 0.99 / 2.5);
  // An equal seed gives an equal fog, another seed another fog. Without jitter there is no displacement.
  GaussianList again, other, plain;
  for (GaussianList* l : {&again, &other, &plain}) l->begin();
  paint(again, op);
  CHECK(again.all() == list.all());
  paint(other, {bent, op.brush, 0.003, {}, 12});
  CHECK_FALSE(other.all() == list.all());
  paint(plain, {bent, op.brush, 0.003, 0.0, 11});
  CHECK(plain.all()[5].b == points[5].position);
}

TEST_CASE("the eraser only takes away, by its parabola", "[fogshop][authoring]") {
  GaussianList list;
  list.begin();
  for (int i = 0; i < 50; ++i) list.add({.a = 1, .c = 0.5 + 0.01 * i, .b = Point3(0.1 * i, 0, 0)});
  const auto before = list.all();
  list.begin();
  const auto ids = erase(list, {Point3(2, 0, 0), Point3(3, 0, 0)}, {1.25, 0.6});
  std::size_t at = 0, hit = 0;
  for (const auto& g : before) {
    double share = 0;
    for (const double x : {2.0, 3.0}) {
      const double r2 = (g.b[0] - x) * (g.b[0] - x) / (1.25 * 1.25);
      if (r2 < 1) share += 0.6 * (1 - r2);
    }
    hit += share > 0;
    if (share >= 1) continue;  // nothing left
    REQUIRE(at < list.all().size());
    CHECK(list.all()[at].id == g.id);
    CHECK(list.all()[at].c <= g.c);
    CHECK(std::abs(list.all()[at].c - g.c * (1 - share)) < 1e-15);
    ++at;
  }
  CHECK(at == list.all().size());
  CHECK(ids.size() == hit);
  CHECK(at < before.size());
  REQUIRE(list.undo());
  CHECK(list.all() == before);
}

TEST_CASE("copy and move carry optical depths along", "[fogshop][authoring]") {
  GaussianList list = painted();
  std::vector<Id> ids;
  for (const auto& g : list.all()) ids.push_back(g.id);
  const Ray ray{{-2, 1, -3}, Vec3(3.3, 0.2, 3).normalized()};
  const double before = depth(list, ids, ray, 7);
  REQUIRE(before > 0.1);
  for (const double scale : {1.0, 2.5}) {
    Placement to;
    to.rotation = Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized()).toRotationMatrix();
    to.scale = scale;
    to.translation = {10, -4, 3};
    const Ray carried{to.rotation * (scale * ray.origin) + to.translation, (to.rotation * ray.direction).normalized()};
    list.begin();
    const auto clones = copy(list, ids, to);
    CHECK(clones.size() == ids.size());
    CHECK(clones.front() > ids.back());
    // a -> a/k, c -> c/k keeps the depth along the carried ray, of k times the length.
    CHECK(std::abs(depth(list, clones, carried, 7 * scale) / before - 1) < 1e-12);
    to.keep = Placement::Keep::density;
    list.begin();
    CHECK(std::abs(depth(list, copy(list, ids, to), carried, 7 * scale) / before / scale - 1) < 1e-12);
    const auto all = list.all();
    list.begin();
    CHECK(move(list, ids, to) == ids);
    CHECK(std::abs(depth(list, ids, carried, 7 * scale) / before / scale - 1) < 1e-12);
    REQUIRE(list.undo());
    CHECK(list.all() == all);
  }
  CHECK_THROWS_AS(copy(list, {ids[0], 999999}, {}), Error);
}

TEST_CASE("screen points unproject to the plane and project back", "[fogshop][authoring]") {
  View view{scene::look_at({3, 2, 6}, {0, 1, 0}, Vec3::UnitY()), 640, 480};
  const Canvas canvas{Vec3(0.1, 1, 0.2).normalized(), -0.5};
  const auto x = unproject(view, {200, 400}, canvas);
  REQUIRE(x);
  CHECK(std::abs(canvas.normal.dot(*x) - canvas.d) < 1e-14);
  const auto p = project(view, *x);
  REQUIRE(p);
  CHECK((*p - ScreenPoint(200, 400)).norm() < 1e-10);
  CHECK_FALSE(unproject(view, {320, 240}, {view.camera.right, view.camera.right.dot(view.camera.position) + 1}));
  CHECK_FALSE(unproject(view, {320, 240}, {view.camera.forward, view.camera.forward.dot(view.camera.position) - 1}));
  CHECK_FALSE(project(view, view.camera.position - view.camera.forward));
  // Half-open: what lies on the lower edge is in, what lies on the upper is not.
  GaussianList list;
  list.begin();
  const Id inside = list.add({.b = *x});
  list.add({.b = view.camera.position - 2 * view.camera.forward});
  CHECK(select(list, view, *p, *p + ScreenPoint(1, 1), 0) == std::vector<Id>{inside});
  CHECK(select(list, view, *p - ScreenPoint(1, 1), *p, 0).empty());
  CHECK(select(list, view, *p, *p + ScreenPoint(1, 1), 100).empty());
  // A disc of pixels takes away what is seen under it.
  list.begin();
  CHECK(erase(list, view, {*p + ScreenPoint(2, 0)}, {4, 1}) == std::vector<Id>{inside});
  CHECK(list.all()[0].c == Approx(0.25).epsilon(1e-9));  // 1 - (1 - (2/4)^2)
}

TEST_CASE("emitted particles are where the parabola says", "[fogshop][authoring]") {
  Emitter e;
  e.position = {1, 2, 3};
  e.rate = 17;
  e.velocity = {0.3, 1, 0};
  e.acceleration = {0, -0.4, 0.1};
  e.life = 2;
  e.a0 = 5, e.a1 = 2, e.c0 = 3, e.c1 = 0.5;
  e.t0 = 0.25, e.t1 = 100;
  const double time = 9.3;
  const auto alive = particles(e, time);
  std::size_t at = 0;
  for (int k = 0; k < 400; ++k) {
    const double age = time - (e.t0 + k / e.rate);
    if (age < 0 || age >= e.life) continue;
    REQUIRE(at < alive.size());
    CHECK((alive[at].b - (e.position + e.velocity * age + 0.5 * age * age * e.acceleration)).norm() < 1e-13);
    CHECK(alive[at].a == Approx(5 - 3 * age / 2).epsilon(1e-14));
    CHECK(alive[at].c == Approx(3 - 2.5 * age / 2).epsilon(1e-14));
    ++at;
  }
  CHECK(at == alive.size());
  CHECK(at == 34);
  // The spread is a displacement of spread * age at most, and fixed for a particle's whole life.
  e.spread = 0.7;
  const auto spread = particles(e, time);
  const auto earlier = particles(e, time - 1e-3);
  REQUIRE(spread.size() == alive.size());
  for (std::size_t i = 0; i < spread.size(); ++i) {
    const double age = 2 * (5 - spread[i].a) / 3;
    CHECK((spread[i].b - alive[i].b).norm() <= 0.7 * age + 1e-12);
    CHECK((spread[i].b - earlier[i].b).norm() < 3e-3);
  }
  CHECK(particles(e, 0.2).empty());
  CHECK(particles(e, 102.1).empty());
  e.rate = 1e9;
  CHECK_THROWS_AS(particles(e, time), Error);
}

TEST_CASE("undo restores the list exactly", "[fogshop][authoring]") {
  GaussianList list = painted();
  const auto one = list.all();
  list.begin();
  erase(list, {bent[1]}, {0.8, 1});
  list.remove({0, 2, list.all().size() - 1});
  list.add({.b = {9, 9, 9}});
  list.change(1, {.a = 7, .c = 7});
  list.change(1, {.a = 8, .c = 8});
  const auto two = list.all();
  CHECK_FALSE(one == two);
  list.begin();
  copy(list, {two[3].id}, {});
  const Id latest = list.all().back().id;
  REQUIRE(list.undo());
  CHECK(list.all() == two);
  REQUIRE(list.undo());
  CHECK(list.all() == one);
  list.begin();
  CHECK(list.add({}) > latest);  // ids are not used twice
  REQUIRE(list.undo());
  REQUIRE(list.undo());
  CHECK(list.all().empty());
  CHECK_FALSE(list.undo());
}

}  // namespace authoring_test
