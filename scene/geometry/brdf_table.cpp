#include "scene/geometry/brdf_table.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scene/base/error.h"
#include "scene/base/read_file.h"
#include "scene/geometry/text_lines.h"

namespace airlight::scene {
namespace {

constexpr int greatest_size = 256;
constexpr double same = 1e-5;  // files hold decimals

// An angle among even entries over [0, span]: the entry before it, and how far it is to the next.
struct Place {
  int entry;
  double share;
};
Place place_of(double angle, double span, int entries) {
  const double x = std::clamp(angle / span, 0.0, 1.0) * (entries - 1);
  const int entry = std::min(entries - 2, int(x));
  return {entry, x - entry};
}

bool differ(const Rgb& a, const Rgb& b) { return ((a - b).abs() > same * a.max(b)).any(); }

std::string shown(const Rgb& c) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", c[0], c[1], c[2]); }

}  // namespace

BrdfTable::BrdfTable(int thetas, int phis, std::vector<Rgb> values)
    : thetas_(thetas), phis_(phis), values_(std::move(values)) {
  if (std::min(thetas, phis) < 2 || std::max(thetas, phis) > greatest_size)
    throw Error(fmt::format("a reflectance of {} polar and {} azimuthal angles, expected 2 to {} of each", thetas, phis,
                            greatest_size));
  if (values_.size() != std::size_t(thetas) * thetas * phis)
    throw Error(fmt::format("a reflectance of {} values, expected {} = {} x {} x {}", values_.size(),
                            std::size_t(thetas) * thetas * phis, thetas, thetas, phis));
  check_values();
  make_reciprocal();
  check_albedo();
}

std::string BrdfTable::angles(int i, int j, int k) const {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) degrees", 90.0 * i / (thetas_ - 1), 90.0 * j / (thetas_ - 1),
                     180.0 * k / (phis_ - 1));
}

void BrdfTable::check_values() const {
  for (int i = 0; i < thetas_; ++i)
    for (int j = 0; j < thetas_; ++j)
      for (int k = 0; k < phis_; ++k) {
        const Rgb& value = values_[place(i, j, k)];
        if (!(value >= 0).all() || !value.isFinite().all())
          throw Error(
              fmt::format("reflectance {} at (theta_in, theta_out, delta_phi) = {}, expected finite values >= 0",
                          shown(value), angles(i, j, k)));
        const Rgb& first = values_[place(i, j, 0)];
        if ((i == 0 || j == 0) && differ(value, first))
          throw Error(
              fmt::format("reflectance {} at {} and {} at {}: along the normal there is no azimuth, expected one value",
                          shown(first), angles(i, j, 0), shown(value), angles(i, j, k)));
      }
}

void BrdfTable::make_reciprocal() {
  for (int i = 0; i < thetas_; ++i)
    for (int j = 0; j < i; ++j)
      for (int k = 0; k < phis_; ++k) {
        Rgb &a = values_[place(i, j, k)], &b = values_[place(j, i, k)];
        if (differ(a, b))
          throw Error(fmt::format(
              "reflectance {} at {} and {} at {}: not reciprocal, expected the same with the directions exchanged",
              shown(a), angles(i, j, k), shown(b), angles(j, i, k)));
        a = b = 0.5 * (a + b);
      }
}

// Over theta the integrand is a hat function times sin(2 theta) / 2, over delta_phi the trapezoidal rule is exact.
void BrdfTable::check_albedo() {
  const double step = 0.5 * pi / (thetas_ - 1);
  const auto flat = [](double t) { return -0.25 * std::cos(2 * t); };
  const auto rising = [](double t) { return 0.125 * (std::sin(2 * t) - 2 * t * std::cos(2 * t)); };
  std::vector<double> weight(thetas_, 0.0);
  for (int j = 0; j + 1 < thetas_; ++j) {
    const double lo = j * step, hi = lo + step;
    const double all = flat(hi) - flat(lo), next = (rising(hi) - rising(lo) - lo * all) / step;
    weight[j + 1] += next;
    weight[j] += all - next;
  }
  const double around = 2 * pi / (phis_ - 1);
  for (int i = 0; i < thetas_; ++i) {
    Rgb sum = Rgb::Zero();
    for (int j = 0; j < thetas_; ++j)
      for (int k = 0; k < phis_; ++k)
        sum += values_[place(i, j, k)] * (weight[j] * around * (k == 0 || k == phis_ - 1 ? 0.5 : 1.0));
    if (!(sum <= 1 + 1e-9).all())
      throw Error(
          fmt::format("a reflectance that returns {} of the light from theta_in = {:.4g} degrees, expected at most 1: "
                      "it would create energy",
                      shown(sum), 90.0 * i / (thetas_ - 1)));
    albedo_.push_back(sum);
    greatest_albedo_ = greatest_albedo_.max(sum);
  }
}

Rgb BrdfTable::operator()(const Vec3& normal, const Vec3& in, const Vec3& out) const {
  const double c_in = normal.dot(in), c_out = normal.dot(out);
  if (!(c_in > 0) || !(c_out > 0)) return Rgb::Zero();
  // Polar angles by sine and cosine: an arc cosine loses half the digits along the normal.
  const double theta_in = std::atan2(normal.cross(in).norm(), c_in);
  const double theta_out = std::atan2(normal.cross(out).norm(), c_out);
  const double across = in.dot(out) - c_in * c_out, aside = std::abs(normal.dot(in.cross(out)));
  return at(theta_in, theta_out, std::atan2(aside, across));
}

Rgb BrdfTable::at(double theta_in, double theta_out, double delta_phi) const {
  const Place in = place_of(theta_in, 0.5 * pi, thetas_), out = place_of(theta_out, 0.5 * pi, thetas_);
  const Place turn = place_of(delta_phi, pi, phis_);
  Rgb sum = Rgb::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
    const double weight =
        (a ? in.share : 1 - in.share) * (b ? out.share : 1 - out.share) * (c ? turn.share : 1 - turn.share);
    sum += weight * values_[place(in.entry + a, out.entry + b, turn.entry + c)];
  }
  return sum;
}

Rgb BrdfTable::albedo(double theta_in) const {
  const Place in = place_of(theta_in, 0.5 * pi, thetas_);
  return (1 - in.share) * albedo_[in.entry] + in.share * albedo_[in.entry + 1];
}

BrdfTable read_brdf_table(const std::string& path) {
  const std::string content = read_whole_file(path);
  TextLines lines(path, content);
  const auto next = [&](const std::string& what) {
    if (!lines.next()) lines.fail(fmt::format("found the end of the file, expected {}", what));
  };
  const auto finish = [&] {
    if (!lines.at_end()) lines.fail(fmt::format("found '{}', expected the end of the line", lines.shown(lines.word())));
  };
  next("the numbers of polar and of azimuthal angles");
  const int thetas = int(lines.integer("the number of polar angles", 2, greatest_size));
  const int phis = int(lines.integer("the number of azimuthal angles", 2, greatest_size));
  finish();
  const std::size_t count = std::size_t(thetas) * thetas * phis;
  std::vector<Rgb> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    next(fmt::format("{} lines of r g b, {} of them found", count, i));
    for (int c = 0; c < 3; ++c) values[i][c] = lines.number("a reflectance");
    finish();
  }
  if (lines.next())
    lines.fail(
        fmt::format("found '{}', expected the end of the file after {} values", lines.shown(lines.word()), count));
  try {
    return BrdfTable(thetas, phis, std::move(values));
  } catch (const Error& e) {
    throw Error(fmt::format("{}: {}", path, e.what()));
  }
}

}  // namespace airlight::scene
