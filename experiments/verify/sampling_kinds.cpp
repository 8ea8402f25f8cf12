// Sampling of cosines and distances, and the random number generator.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "experiments/verify/readers.h"
#include "reference/path_tracer/sampling.h"
#include "scene/math/linear_flight.h"
#include "scene/math/random.h"
#include "scene/phase.h"

namespace airlight::experiments::verification {
namespace {

using Row = std::vector<double>;

std::string joined(const Row& row, std::size_t count) {
  return fmt::format("{}", fmt::join(row.begin(), row.begin() + long(count), ","));
}

std::vector<Row> read_rows(const Value& list, std::size_t columns) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < list.size(); ++i) {
    rows.push_back(list[i].numbers());
    if (rows.back().size() != columns) list[i].complain(std::to_string(columns) + " numbers");
  }
  return rows;
}

Outcome equiangular(const std::vector<Row>& rows, double accuracy) {
  Outcome out;
  for (const Row& r : rows) {
    const path_tracer::Equiangular sampler({Point3::Zero(), Vec3::UnitZ()}, Point3(r[1], 0, r[0]), {r[2], r[3]});
    const std::string name = joined(r, 2);
    out.add(relative(name + " t", r[5], sampler.sample(r[4]), accuracy));
    out.add(relative(name + " pdf", r[6], sampler.pdf(sampler.sample(r[4])), accuracy));
  }
  return out;
}

std::uint32_t hexadecimal(const Value& v) {
  const std::string& text = v.text();
  std::uint32_t word = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), word, 16);
  if (text.size() != 8 || code != std::errc() || end != text.data() + text.size()) v.complain("8 hexadecimal digits");
  return word;
}

template <std::size_t n>
std::array<std::uint32_t, n> words(const Value& v) {
  if (v.size() != n) v.complain(std::to_string(n) + " words");
  std::array<std::uint32_t, n> result;
  for (std::size_t i = 0; i < n; ++i) result[i] = hexadecimal(v[i]);
  return result;
}

}  // namespace

Check read_sampling(const Value& v) {
  const std::string& columns = v["input"]["rows"].text();
  const Value list = v["expected"]["rows"];
  const bool is_relative = v["accuracy"].has("rel");
  const double accuracy = v["accuracy"][is_relative ? "rel" : "abs"].number();
  if (columns == "D,h,ta,tb,u,t,pdf") {
    const auto rows = read_rows(list, 7);
    return {"", [=](VerifyProfile) { return equiangular(rows, accuracy); }};
  }
  double (*sample)(const Row&);
  std::size_t inputs;
  if (columns == "g,u,cos") {
    inputs = 2;
    sample = [](const Row& r) { return scene::sample_phase_cosine(scene::HenyeyGreenstein{r[0]}, r[1]); };
  } else if (columns == "u,cos") {
    inputs = 1;
    sample = [](const Row& r) { return scene::sample_phase_cosine(scene::Rayleigh{}, r[0]); };
  } else if (columns == "a,b,l,t,s") {
    inputs = 4;
    sample = [](const Row& r) { return scene::linear_flight(r[0], r[1], r[2], r[3]); };
  } else {
    v["input"]["rows"].complain("g,u,cos or u,cos or a,b,l,t,s or D,h,ta,tb,u,t,pdf");
  }
  const auto rows = read_rows(list, inputs + 1);
  return {"", [=](VerifyProfile) {
            Outcome out;
            for (const Row& r : rows) {
              const double expected = r[inputs], got = sample(r);
              out.add(is_relative ? relative(joined(r, inputs), expected, got, accuracy)
                                  : absolute(joined(r, inputs), expected, got, accuracy));
            }
            return out;
          }};
}

Check read_random_numbers(const Value& v) {
  struct Answer {
    PhiloxCounter counter;
    PhiloxKey key;
    PhiloxCounter out;
  };
  std::vector<Answer> answers;
  const Value rows = v["expected"]["rows"];
  for (std::size_t i = 0; i < rows.size(); ++i)
    answers.push_back({words<4>(rows[i][0]), words<2>(rows[i][1]), words<4>(rows[i][2])});
  return {
      "", [=](VerifyProfile) {
        Outcome out;
        for (std::size_t i = 0; i < answers.size(); ++i) {
          const PhiloxCounter got = philox4x32_10(answers[i].counter, answers[i].key);
          for (int w = 0; w < 4; ++w)
            out.add(absolute("row " + std::to_string(i) + " word " + std::to_string(w), answers[i].out[w], got[w], 0));
        }
        return out;
      }};
}

}  // namespace airlight::experiments::verification
