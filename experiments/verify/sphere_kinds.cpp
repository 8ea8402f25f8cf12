// Homogeneous spheres with all orders: extinction 1/m, optical radius = radius; and single rays with their orders
// apart.
#include <cmath>
#include <cstdlib>

#include "experiments/verify/monte_carlo.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/vector_scene.h"

namespace airlight::experiments::verification {
namespace {

scene::Scene one_medium(const scene::Medium& medium, const scene::Light& light) {
  scene::Scene scene;
  scene.media = {medium};
  scene.lights = {light};
  scene::finish(scene);
  return scene;
}

scene::Medium isotropic_sphere(double radius, double albedo) {
  return fog(scene::Sphere{Point3::Zero(), radius}, 1, albedo, scene::Isotropic{});
}

scene::Light uniform_sky() { return scene::make_constant_environment(Rgb::Ones()); }

// Along a chord of impact b, from outside.
Ray chord(double b, double radius) { return {Point3(b, 0, -2 * radius), Vec3::UnitZ()}; }

Effort effort_for(VerifyProfile profile, int quick) {
  return fixed(std::uint64_t(1) << (profile == VerifyProfile::quick ? quick : quick + 5), profile);
}

Comparison of(const std::string& what, double expected, double expected_se, const path_tracer::Estimate& got,
              double accuracy, double k = accept_se) {
  return statistical(what, expected, expected_se, got.mean[0], got.error[0], k, accuracy);
}

// "0.5" and its value.
std::vector<std::pair<double, Value>> by_number(const Value& v) {
  std::vector<std::pair<double, Value>> list;
  for (const std::string& name : v.fields()) {
    const Value field = v[name];
    char* end = nullptr;
    const double x = std::strtod(name.c_str(), &end);
    if (end == name.c_str() || *end || !(x >= 0 && x < 1)) field.complain("an impact in [0, 1) as its name");
    list.push_back({x, field});
  }
  return list;
}

scene::Region shape_from(const Value& in, const std::string& shape) {
  if (shape == "sphere") return scene::Sphere{Point3::Zero(), in.has("R") ? in["R"].number_in(1e-9, 1e9) : 1};
  if (shape != "box") in.complain("a sphere or a box");
  if (!in.has("lo")) return Box{Point3::Zero(), Point3::Ones()};
  return Box{in["lo"].vector(), in["hi"].vector()};
}

}  // namespace

Check read_sphere_environment(const Value& v) {
  const double radius = v["input"]["optical_radius"].number_in(0, 1e4), albedo = v["input"]["albedo"].number_in(0, 1);
  const Value e = v["expected"];
  const double centre = e["J_centre"].number(), accuracy = v["accuracy"]["abs"].number();
  std::vector<std::pair<double, double>> chords;
  for (const auto& [b, value] : by_number(e["L"])) chords.push_back({b, value.number()});
  const std::vector<double> orders = e["orders_b0.5"].numbers();
  if (orders.size() > 6) e["orders_b0.5"].complain("at most 6 orders");
  const std::string id = v["id"].text();
  return {
      "", [=](VerifyProfile profile) {
        const scene::Scene scene = one_medium(isotropic_sphere(radius, albedo), uniform_sky());
        const Effort effort = effort_for(profile, 17);
        Outcome out;
        out.add(of("J at the centre", centre, 0,
                   Measurement(scene, isotropic_detector(Point3::Zero()), 1, id + "J").run(effort).total, accuracy));
        for (const auto& [b, value] : chords) {
          const std::string name = "L b " + std::to_string(b).substr(0, 4);
          out.add(of(name, value, 0, Measurement(scene, chord(b * radius, radius), 1, id + name).run(effort).total,
                     accuracy));
        }
        const auto got = Measurement(scene, chord(0.5 * radius, radius), int(orders.size()), id + "orders").run(effort);
        for (std::size_t m = 0; m < orders.size(); ++m)
          out.add(of("b 0.5 order " + std::to_string(m + 1), orders[m], 0, got.orders[m + 1], accuracy));
        return out;
      }};
}

Check read_sphere_central_point(const Value& v) {
  const double radius = v["input"]["optical_radius"].number_in(0, 1e4), albedo = v["input"]["albedo"].number_in(0, 1);
  const double accuracy = v["accuracy"]["abs"].number();
  struct Chord {
    double b, first, second, all;
  };
  std::vector<Chord> chords;
  for (const auto& [b, value] : by_number(v["expected"]["L1_L2_Lall"])) {
    if (value.size() != 3) value.complain("order 1, order 2, all orders");
    chords.push_back({b, value[0].number(), value[1].number(), value[2].number()});
  }
  const std::string id = v["id"].text();
  return {"", [=](VerifyProfile profile) {
            const scene::Scene scene =
                one_medium(isotropic_sphere(radius, albedo), scene::PointLight{Point3::Zero(), Rgb::Ones(), 0});
            const Effort effort = effort_for(profile, 18);
            Outcome out;
            for (const Chord& c : chords) {
              const std::string name = "b " + std::to_string(c.b).substr(0, 4);
              const auto got = Measurement(scene, chord(c.b * radius, radius), 2, id + name).run(effort);
              out.add(of(name + " order 1", c.first, 0, got.orders[1], accuracy));
              out.add(of(name + " order 2", c.second, 0, got.orders[2], accuracy));
              out.add(of(name + " all", c.all, 0, got.total, accuracy));
            }
            return out;
          }};
}

Check read_single_scattering_environment(const Value& v) {
  const Value in = v["input"];
  const scene::Medium medium =
      fog(shape_from(in, in["kind"].text()), in["sigma_t"].number_in(0, 1e4), in["albedo"].number_in(0, 1),
          phase_from(in["phase"]["name"], number_or(in["phase"], "g", 0)));
  const Ray ray = ray_from(in["o"], in["d"]);
  const double expected = v["expected"]["L1"].number(), accuracy = v["accuracy"]["abs"].number();
  const std::string id = v["id"].text();
  return {"", [=](VerifyProfile profile) {
            const auto got = Measurement(one_medium(medium, uniform_sky()), ray, 1, id).run(effort_for(profile, 19));
            return Outcome{{of("L1", expected, 0, got.orders[1], accuracy)}};
          }};
}

// "Two-sample z, all seven numbers of the vector at once, |z| < 4": orders 0 to 4, all, and the mean collisions of an
// analog walk, one that dies with the probability 1 - albedo at each.
Check read_multiple_scattering(const Value& v) {
  const Value in = v["input"], e = v["expected"];
  const double g = in["g"].number();
  if (!(g > -1 && g < 1)) in["g"].complain("-1 < g < 1");
  const scene::Medium medium = fog(shape_from(in, in["shape"].text()), in["sigma_t"].number_in(0, 1e4),
                                   in["albedo"].number_in(0, 1), scene::HenyeyGreenstein{g});
  const std::string& type = in["light"].text();
  scene::Light light;
  if (type == "environment L=1")
    light = uniform_sky();
  else if (type == "directional")
    light = scene::DirectionalLight{in["to_light"].vector().normalized(), Rgb::Constant(in["E"].number())};
  else if (type == "point")
    light = scene::PointLight{in["pos"].vector(), Rgb::Constant(in["I"].number()), 0};
  else
    in["light"].complain("directional, point or environment L=1");
  const Ray ray = ray_from(in["o"], in["d"]);
  struct Number {
    std::string name;
    int order;  // -1: all
    double mean, error;
  };
  std::vector<Number> numbers;
  for (const char* name : {"o0", "o1", "o2", "o3", "o4", "all"}) {
    if (!e.has(name)) continue;
    if (e[name].size() != 2) e[name].complain("mean and standard error");
    numbers.push_back({name, name[0] == 'o' ? name[1] - '0' : -1, e[name][0].number(), e[name][1].number()});
  }
  if (numbers.empty()) e.complain("o0 to o4, or all");
  const double collisions = e["mean_collisions_analog"].number();
  const double histories = e["histories"].number();
  const std::string id = v["id"].text();
  // The quick profile (CI) leaves out sharp phase functions, which take minutes in dense fog or under a near light.
  const bool paper_only = std::abs(in["g"].number()) >= 0.9;
  return {"", [=](VerifyProfile profile) {
            if (paper_only && profile == VerifyProfile::quick)
              return Outcome{{}, int(numbers.size()) + 1, "for the paper profile"};
            const auto got = Measurement(one_medium(medium, light), ray, 4, id).run(effort_for(profile, 20));
            Outcome out;
            for (const Number& n : numbers)
              out.add(of(n.name, n.mean, n.error, n.order < 0 ? got.total : got.orders[n.order], 0, 4));
            // The vector does not tell the error of its count: it is ours, scaled by the numbers of histories. Sixteen
            // repeats make a Student's t of 15 degrees: 5.5 standard errors are as rare as 4 of a known one.
            const Effort half = effort_for(profile, 19);
            const auto count = Measurement(one_medium(medium, light), ray, 4, id + "collisions").collisions(half);
            const double error = count.error[0] * std::sqrt(double(half.least) / histories);
            out.add(of("analog collisions", collisions, error, count, 0, 5.5));
            return out;
          }};
}

}  // namespace airlight::experiments::verification
