#include "scene/film/tone_curve.h"

#include <algorithm>
#include <cmath>

namespace airlight::scene {
namespace {

double aces(double x) { return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14); }

constexpr double grey = 0.18, stops_below = 10, stops_above = 6.5, display_power = 2.4, slope = 2.4;

// A branch of the sigmoid through (x_pivot, y_pivot): it flattens towards distance `scale` from there.
double branch(double x, double x_pivot, double y_pivot, double reach_x, double reach_y, double power) {
  const double scale =
      std::pow(std::pow(slope * reach_x, -power) * (std::pow(slope * reach_x / reach_y, power) - 1), -1 / power);
  const double t = slope * std::abs(x - x_pivot) / scale;
  const double rise = scale * t / std::pow(1 + std::pow(t, power), 1 / power);
  return x < x_pivot ? y_pivot - rise : y_pivot + rise;
}

double agx(double linear) {
  const double x_pivot = stops_below / (stops_below + stops_above), y_pivot = std::pow(grey, 1 / display_power);
  const double stops = std::log2(std::max(linear, 1e-10) / grey);
  const double x = std::clamp((stops + stops_below) / (stops_below + stops_above), 0.0, 1.0);
  const double y = x < x_pivot ? branch(x, x_pivot, y_pivot, x_pivot, y_pivot, 3)
                               : branch(x, x_pivot, y_pivot, 1 - x_pivot, 1 - y_pivot, 3.25);
  return std::pow(std::max(y, 0.0), display_power);
}

}  // namespace

const Choices<Tone>& tones() {
  static const Choices<Tone> all{{"clamp", Tone::clamp}, {"aces", Tone::aces}, {"agx", Tone::agx}};
  return all;
}

Rgb toned(Tone tone, const Rgb& linear) {
  const Rgb light = linear.max(0.0);
  if (tone == Tone::clamp) return light.min(1.0);
  if (tone == Tone::aces) return light.unaryExpr(&aces).min(1.0);
  Mat3 mixed;  // of AgX's reference configuration; each row sums to 1 but for rounding
  mixed << 0.842479062253094, 0.0784335999999992, 0.0792237451477643,  //
      0.0423282422610123, 0.878468636469772, 0.0791661274605434,       //
      0.0423756549057051, 0.0784336, 0.879142973793104;
  return Rgb((mixed * light.matrix()).array()).unaryExpr(&agx).min(1.0);
}

}  // namespace airlight::scene
