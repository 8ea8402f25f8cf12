// Formulas of experiments/judging/statistics.h and experiments/judging/front.h.
#include <algorithm>
#include <cmath>

#include "experiments/judging/front.h"
#include "experiments/judging/statistics.h"
#include "experiments/verify/readers.h"

namespace airlight::experiments::verification {
namespace {

Outcome squared_errors(const std::vector<double>& a, const std::vector<double>& r, const std::vector<double>& s2,
                       const std::vector<double>& n, const std::vector<std::pair<std::string, double>>& expected,
                       double accuracy) {
  const SquaredError e = squared_error(a, r, s2, n);
  const auto value = [&](const std::string& name) {
    if (name == "mse_raw") return e.raw;
    if (name == "mse_unbiased") return e.unbiased;
    if (name == "var_mse") return e.variance;
    if (name == "ci95 low") return e.low;
    if (name == "ci95 high") return e.high;
    if (name == "rmse") return std::sqrt(e.unbiased);
    if (name == "rel_l2") return std::sqrt(relative_squared_error(a, r, s2));
    if (name == "floor") return e.floor;
    if (name == "relmse_eps001") return denominator_squared_error(a, r, s2, 0.01);
    return peak_signal_to_noise(e.unbiased, 2);
  };
  Outcome out;
  for (const auto& [name, number] : expected) out.add(relative(name, number, value(name), accuracy));
  return out;
}

Check read_mse(const Value& v, double accuracy) {
  const Value in = v["input"], e = v["expected"];
  const auto a = in["A"].numbers(), r = in["R"].numbers(), s2 = in["s2"].numbers(), n = in["n"].numbers();
  if (a.empty() || r.size() != a.size() || s2.size() != a.size() || n.size() != a.size())
    in.complain("A, R, s2 and n of one length");
  std::vector<std::pair<std::string, double>> expected;
  for (const char* name :
       {"mse_raw", "mse_unbiased", "var_mse", "rmse", "rel_l2", "floor", "relmse_eps001", "psnr_peak2"})
    expected.push_back({name, e[name].number()});
  expected.push_back({"ci95 low", e["ci95"][0].number()});
  expected.push_back({"ci95 high", e["ci95"][1].number()});
  return {"", [=](VerifyProfile) { return squared_errors(a, r, s2, n, expected, accuracy); }};
}

Check read_z(const Value& v, double accuracy) {
  const std::vector<double> z = v["input"]["z"].numbers();
  if (z.empty()) v["input"]["z"].complain("a value at least");
  for (std::size_t i = 0; i < z.size(); ++i) v["input"]["z"][i].number_in(-1e9, 1e9);
  const Value e = v["expected"];
  const double chi2 = e["chi2"].number(), p = e["p_chi2"].number(), sidak = e["sidak_1e3"].number();
  const double bonferroni = e["bonf_1e3"].number(), largest_p = e["p_max_sidak"].number();
  return {"", [=](VerifyProfile) {
            double sum = 0, largest = 0;
            for (const double x : z) sum += x * x, largest = std::max(largest, std::abs(x));
            return Outcome{{relative("chi2", chi2, sum, accuracy),
                            relative("p_chi2", p, chi_square_above(sum, double(z.size())), accuracy),
                            relative("sidak_1e3", sidak, sidak_threshold(z.size(), 1e-3), accuracy),
                            relative("bonf_1e3", bonferroni, bonferroni_threshold(z.size(), 1e-3), accuracy),
                            relative("p_max_sidak", largest_p, sidak_probability(z.size(), largest), accuracy)}};
          }};
}

Check read_sidak(const Value& v, double accuracy) {
  std::vector<std::vector<double>> rows;
  const Value list = v["expected"]["rows"];
  for (std::size_t i = 0; i < list.size(); ++i) {
    rows.push_back(list[i].numbers());
    if (rows.back().size() != 3) list[i].complain("[m, alpha, threshold]");
    list[i][0].integer_in(1, 1000000000);
    list[i][1].number_in(1e-300, 0.999);
  }
  return {
      "", [=](VerifyProfile) {
        Outcome out;
        for (const auto& r : rows)
          out.add(relative("m " + std::to_string(int(r[0])), r[2], sidak_threshold(std::size_t(r[0]), r[1]), accuracy));
        return out;
      }};
}

Check read_median(const Value& v, double accuracy) {
  const std::vector<double> x = v["input"]["x"].numbers();
  const Value e = v["expected"];
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < e["rows"].size(); ++i) {
    rows.push_back(e["rows"][i].numbers());
    if (rows.back().size() != 3) e["rows"][i].complain("[n, lower, upper]");
    e["rows"][i][0].integer_in(1, 1000000);
  }
  const double middle = e["median"].number(), mad = e["mad"].number(), sigma = e["sigma"].number();
  return {"", [=](VerifyProfile) {
            Outcome out;
            for (const auto& r : rows) {
              const RankInterval ranks = median_ranks(int(r[0]));
              const std::string n = "n " + std::to_string(int(r[0]));
              out.add(absolute(n + " lower", r[1], ranks.lower, 0));
              out.add(absolute(n + " upper", r[2], ranks.upper, 0));
            }
            const double deviation = median_absolute_deviation(x);
            out.add(absolute("median", middle, median(x), accuracy));
            out.add(absolute("mad", mad, deviation, accuracy));
            out.add(absolute("sigma", sigma, sigma_per_mad * deviation, accuracy));
            return out;
          }};
}

Check read_hypervolume(const Value& v, double accuracy) {
  const Value in = v["input"], e = v["expected"];
  const auto points = [](const Value& list) {
    std::vector<Point> result;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const double t = list[i][0].number(), error = list[i][1].number();
      result.push_back({{t, t, t}, {error, error, error}});
    }
    return result;
  };
  const std::vector<Point> all = points(in["points"]), best = points(e["front"]);
  const double time = in["ref"][0].number(), error = in["ref"][1].number(), area = e["hv"].number();
  return {"", [=](VerifyProfile) {
            Outcome out;
            const std::vector<std::size_t> found = experiments::front(all);
            out.add(absolute("points on the front", double(best.size()), double(found.size()), 0));
            for (std::size_t i = 0; i < std::min(best.size(), found.size()); ++i) {
              const std::string name = "front " + std::to_string(i);
              out.add(absolute(name + " time", best[i].time.value, all[found[i]].time.value, 0));
              out.add(absolute(name + " error", best[i].error.value, all[found[i]].error.value, 0));
            }
            out.add(absolute("area", area, hypervolume(all, time, error), accuracy));
            return out;
          }};
}

}  // namespace

Check read_statistics(const Value& v) {
  const Value in = v["input"], accuracy = v["accuracy"];
  const double tolerance = accuracy.has("rel") ? accuracy["rel"].number() : accuracy["abs"].number();
  if (in.has("A")) return read_mse(v, tolerance);
  if (in.has("z")) return read_z(v, tolerance);
  if (in.has("points")) return read_hypervolume(v, tolerance);
  if (in.has("x")) return read_median(v, tolerance);
  if (in.has("rows")) return read_sidak(v, tolerance);
  in.complain("A, z, points, x or rows");
}

}  // namespace airlight::experiments::verification
