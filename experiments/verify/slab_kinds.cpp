// Plane-parallel slabs. Optical thickness is geometric thickness here: extinction 1/m, from z = 0 to z = tau.
//
// The share of a collimated beam at cosine mu0 that comes back or passes is, by reciprocity, the radiance seen at mu0
// when the sky is uniform on one side and black on the other; the black side is an absorbing plane. Averaged over
// cosine-weighted directions it is the share of diffuse light.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "experiments/application/json_value.h"
#include "experiments/verify/monte_carlo.h"
#include "experiments/verify/readers.h"
#include "experiments/verify/vector_scene.h"

namespace airlight::experiments::verification {
namespace {

struct Layer {
  scene::PhaseFunction phase;
  double albedo, tau;
};

scene::Medium slab(const Layer& l) { return fog(scene::Slab{Vec3::UnitZ(), 0, l.tau}, 1, l.albedo, l.phase); }

constexpr double most_depth = 1e4;  // walks through more take too long
constexpr double margin = 1;        // [m] of vacuum between slab and camera

// A bright sky on the camera's side (reflection) or on the other one (transmission); the camera sits at z = -margin.
scene::Scene half_lit(const Layer& l, bool reflection) {
  scene::Scene scene;
  scene.media = {slab(l)};
  scene.lights = {scene::make_constant_environment(Rgb::Ones())};
  const double wall = reflection ? l.tau + margin : -2 * margin;
  scene.surfaces = {{"black", scene::Plane{Point3(0, 0, wall), Vec3::UnitZ()}, scene::Lambert{Rgb::Zero()}}};
  scene::finish(scene);
  return scene;
}

scene::Scene sunlit(const Layer& l, double mu0) {
  scene::Scene scene;
  scene.media = {slab(l)};
  scene.lights = {scene::DirectionalLight{slanted(-mu0), Rgb::Ones()}};
  scene::finish(scene);
  return scene;
}

const Point3 front(0, 0, -margin);

// Reflectance or transmittance (direct light included), at mu0 or, for mu0 = 0, diffuse.
Measurement share(const std::string& name, const Layer& l, bool reflection, double mu0) {
  const scene::Scene scene = half_lit(l, reflection);
  if (mu0 > 0) return {scene, Ray{front, slanted(mu0)}, 1, name};
  return {scene, cosine_detector(front, Vec3::UnitZ()), 1, name};
}

// Standard error that the table is compared at, with the pilot's doubt taken off.
constexpr double table_se = 0.9 * 3e-4;

struct TableRow {
  Layer layer;
  std::string phase;
  std::array<double, 8> value;  // R, T at mu0 = 1, 0.5, 0.1, diffuse
};
constexpr std::array<double, 4> incidence = {1, 0.5, 0.1, 0};

std::string row_name(const TableRow& r) {
  char text[64];
  std::snprintf(text, sizeof text, "%s w%g tau%g", r.phase.c_str(), r.layer.albedo, r.layer.tau);
  return text;
}

struct TableNumber {
  std::string what;
  Measurement measurement;
  double expected;
};
TableNumber table_number(const std::string& id, const TableRow& r, int i, bool reflection) {
  char what[96];
  std::snprintf(what, sizeof what, "%s %c mu %g", row_name(r).c_str(), reflection ? 'R' : 'T', incidence[i]);
  return {what, share(id + what, r.layer, reflection, incidence[i]), r.value[2 * i + !reflection]};
}

Outcome compare_table(const std::string& id, const std::vector<TableRow>& rows, double accuracy,
                      VerifyProfile profile) {
  Outcome out;
  const auto add = [&](const TableNumber& n) {
    const auto got = n.measurement.run(aim(table_se, profile)).total;
    out.add(statistical(n.what, n.expected, 0, got.mean[0], got.error[0], accept_se, accuracy));
  };
  if (profile == VerifyProfile::paper) {
    for (const TableRow& r : rows)
      for (int i = 0; i < 4; ++i)
        for (const bool reflection : {true, false}) add(table_number(id, r, i, reflection));
    return out;
  }
  // A row in nine, R and T at one incidence each. The stride 25 is prime to the lengths of the table's three nested
  // columns, so that phases, albedos and depths all take their turn. Left out are numbers too small to be seen in this
  // noise, and those that the pilot expects to take more than a second.
  const std::size_t wanted = std::max<std::size_t>(2, rows.size() / 9);
  std::size_t index = 0, done = 0;
  for (std::size_t k = 0; k < rows.size() && done < wanted; ++k, index = (index + 25) % rows.size()) {
    const std::size_t before = out.comparisons.size();
    for (const bool reflection : {true, false}) {
      const TableNumber n = table_number(id, rows[index], int(k % 4), reflection);
      if (n.expected > 10 * table_se && n.measurement.collisions_for(aim(table_se, profile)) < 5e6) add(n);
    }
    done += out.comparisons.size() > before;
  }
  out.left_out = int(8 * rows.size() - out.comparisons.size());
  out.left_out_because = "the paper profile compares all rows";
  return out;
}

std::vector<std::pair<double, double>> by_cosine(const Value& v) {
  std::vector<std::pair<double, double>> list;
  for (const std::string& name : v.fields()) {
    double mu = 0;
    const Value field = v[name];
    const auto [end, code] = std::from_chars(name.data(), name.data() + name.size(), mu);
    if (code != std::errc() || end != name.data() + name.size()) field.complain("a cosine as its name");
    if (!(mu > 0 && mu <= 1)) field.complain("a cosine in (0, 1] as its name");
    list.push_back({mu, field.number()});
  }
  return list;
}

std::string at(const char* what, double mu) { return std::string(what) + " mu " + std::to_string(mu).substr(0, 4); }

}  // namespace

Check read_slab_table(const Value& v) {
  static const std::vector<std::string> columns = {"phase",   "g",       "albedo",    "tau",
                                                   "R_mu1",   "T_mu1",   "R_mu0.5",   "T_mu0.5",
                                                   "R_mu0.1", "T_mu0.1", "R_diffuse", "T_diffuse"};
  const Value named = v["input"]["columns"], list = v["expected"]["rows"];
  for (std::size_t i = 0; i < std::max(columns.size(), named.size()); ++i)
    if (i >= columns.size() || named[i].text() != columns[i]) named.complain("the twelve columns of a slab table");
  std::vector<TableRow> rows;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Value r = list[i];
    if (r.size() != columns.size()) r.complain("twelve columns");
    TableRow row{
        {phase_from(r[0], r[1].number()), r[2].number_in(0, 1), r[3].number_in(0, most_depth)}, r[0].text(), {}};
    if (r[0].text() == "hg") row.phase += std::to_string(r[1].number()).substr(0, 4);
    for (int c = 0; c < 8; ++c) row.value[c] = r[4 + c].number();
    rows.push_back(row);
  }
  const std::string id = v["id"].text();
  const double accuracy = v["accuracy"]["abs"].number();
  return {"", [=](VerifyProfile profile) { return compare_table(id, rows, accuracy, profile); }};
}

Check read_slab_point(const Value& v) {
  const Value in = v["input"], e = v["expected"];
  const Layer layer{phase_from(in["phase"], number_or(in, "g", 0)), in["albedo"].number_in(0, 1),
                    in["tau"].number_in(0, most_depth)};
  const double r = e["R"].number(), t = e["T_total"].number();
  const double rd = e["R_diffuse"].number(), td = e["T_diffuse_total"].number();
  const double published_r = e["published_R"].number(), published_t = e["published_T"].number();
  const double accuracy = v["accuracy"]["abs"].number();
  const std::string id = v["id"].text();
  return {"", [=](VerifyProfile profile) {
            Outcome out;
            const auto add = [&](const std::string& what, bool reflection, double mu0, double expected) {
              const auto got = share(id + what, layer, reflection, mu0).run(aim(table_se, profile)).total;
              out.add(statistical(what, expected, 0, got.mean[0], got.error[0], accept_se, accuracy));
            };
            add("R", true, 1, r);
            add("T", false, 1, t);
            add("R diffuse", true, 0, rd);
            add("T diffuse", false, 0, td);
            // The published pair has five decimals.
            for (const auto& [what, published] : {std::pair{0, published_r}, std::pair{1, published_t}}) {
              Comparison c = out.comparisons[what];
              c.what += " as published";
              c.expected = published;
              c.tolerance += 5e-6;
              out.add(c);
            }
            return out;
          }};
}

Check read_slab_exit_radiance(const Value& v) {
  const Value in = v["input"], e = v["expected"];
  const Layer layer{phase_from(in["phase"], number_or(in, "g", 0)), in["albedo"].number_in(0, 1),
                    in["tau"].number_in(0, most_depth)};
  const auto reflected = by_cosine(e["L_reflected"]), transmitted = by_cosine(e["L_transmitted"]);
  const double accuracy = v["accuracy"]["abs"].number();
  const std::string id = v["id"].text();
  return {"", [=](VerifyProfile profile) {
            const scene::Scene scene = sunlit(layer, 1);
            Outcome out;
            const auto add = [&](const std::string& what, double expected, const Ray& ray) {
              const double part = profile == VerifyProfile::quick ? 0.01 : 0.002;
              const auto got = Measurement(scene, ray, 1, id + what).run(aim(part * expected, profile)).total;
              out.add(statistical(what, expected, 0, got.mean[0], got.error[0], accept_se, accuracy));
            };
            for (const auto& [mu, value] : reflected) add(at("reflected", mu), value, {front, slanted(mu)});
            for (const auto& [mu, value] : transmitted)
              add(at("transmitted", mu), value, {Point3(0, 0, layer.tau + margin), slanted(-mu)});
            return out;
          }};
}

Check read_slab_orders(const Value& v) {
  const Layer layer{scene::Isotropic{}, v["input"]["albedo"].number_in(0, 1),
                    v["input"]["tau"].number_in(0, most_depth)};
  const std::vector<double> r = v["expected"]["R_order"].numbers(), t = v["expected"]["T_order"].numbers();
  const int orders = int(std::max(r.size(), t.size()));
  if (orders < 1 || orders > path_tracer::most_orders) v["expected"].complain("1 to 12 orders");
  const double accuracy = v["accuracy"]["abs"].number();
  const std::string id = v["id"].text();
  return {
      "", [=](VerifyProfile profile) {
        const scene::Scene scene = sunlit(layer, 1);
        // Flux out per flux in: pi times the mean radiance, irradiance 1 at normal incidence.
        const std::uint64_t samples = std::uint64_t(1) << (profile == VerifyProfile::quick ? 18 : 22);
        Outcome out;
        const auto add = [&](const char* name, const std::vector<double>& expected, const Detector& detector) {
          const auto got = Measurement(scene, detector, orders, id + name).run(fixed(samples, profile));
          for (std::size_t m = 0; m < expected.size(); ++m)
            out.add(statistical(std::string(name) + " order " + std::to_string(m + 1), expected[m], 0,
                                pi * got.orders[m + 1].mean[0], pi * got.orders[m + 1].error[0], accept_se, accuracy));
        };
        add("R", r, cosine_detector(front, Vec3::UnitZ()));
        add("T", t, cosine_detector(Point3(0, 0, layer.tau + margin), -Vec3::UnitZ()));
        return out;
      }};
}

Check read_half_space(const Value& v) {
  const Value e = v["expected"];
  struct Number {
    std::string what;
    double albedo, mu, expected;
    bool h;  // H(mu) instead of the plane albedo 1 - H(mu) sqrt(1 - albedo)
  };
  std::vector<Number> numbers;
  for (const auto& [albedo, unused] : by_cosine(e["albedo_mu1"]))
    numbers.push_back({at("albedo", 1) + " w " + std::to_string(albedo).substr(0, 5), albedo, 1, unused, false});
  for (const auto& [albedo, value] : by_cosine(e["albedo_mu0.5"]))
    numbers.push_back({at("albedo", 0.5) + " w " + std::to_string(albedo).substr(0, 5), albedo, 0.5, value, false});
  const Value h = e["H"];
  for (const std::string& name : h.fields())
    for (const auto& [mu, value] : by_cosine(h[name])) {
      const nlohmann::json text = name;
      const double albedo = Value(text, h[name].where()).number_in(0, 1);
      numbers.push_back({at("H", mu) + " w " + name, albedo, mu, value, true});
    }
  const double accuracy = v["accuracy"]["abs"].number();
  const std::string id = v["id"].text();
  return {"", [=](VerifyProfile profile) {
            Outcome out;
            // H and the plane albedo of one cosine are one measurement, and the longest ones of all.
            std::map<std::pair<double, double>, path_tracer::Estimate> measured;
            for (const Number& n : numbers) {
              // A million mean free paths: nothing comes back from the far end. Without absorption all light comes
              // back, and H is what passes a thick slab, up to exp(-tau) (case 3 of the references' stress list): T(mu)
              // = H(mu) / (sqrt(3) (tau + 1.42089)).
              const bool absorbs = n.albedo < 1;
              const Layer layer{scene::Isotropic{}, n.albedo, absorbs ? 1e6 : 20};
              const auto [entry, is_new] = measured.try_emplace({n.albedo, n.mu});
              path_tracer::Estimate& got = entry->second;
              if (is_new) got = share(id + n.what, layer, absorbs, n.mu).run(aim(table_se, profile)).total;
              double value = got.mean[0], scale = 1;
              if (!absorbs) {
                scale = std::sqrt(3.0) * (layer.tau + 1.42089);
                value *= scale;
              } else if (n.h) {
                scale = 1 / std::sqrt(1 - n.albedo);
                value = (1 - value) * scale;
              }
              out.add(statistical(n.what, n.expected, 0, value, scale * got.error[0], accept_se, scale * accuracy));
            }
            return out;
          }};
}

}  // namespace airlight::experiments::verification
