#include "reference/light_map/encoding.h"

#include <algorithm>
#include <cmath>

#include "reference/light_map/nodes.h"
#include "scene/math/types.h"

namespace airlight::light_map {
namespace {

void encode_nodes(const Options& o, std::span<const double> steps, float* texel) {
  Nodes nodes(o.nodes);
  const double h = 1.0 / double(steps.size());
  double depth = 0, transmittance = 1;
  std::size_t end = 0;  // of the last step that is not empty
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i] == 0) continue;
    if (nodes.empty() || end < i) nodes.add({double(i) * h, transmittance});
    depth += steps[i];
    transmittance = std::exp(-depth);
    end = i + 1;
    nodes.add({double(end) * h, transmittance});
  }
  if (nodes.empty()) nodes.add({1, 1});
  for (int k = 0; k < o.nodes; ++k) {
    const Node& node = nodes[std::min(k, nodes.count() - 1)];
    texel[k] = float(node.depth);
    texel[o.nodes + k] = float(node.transmittance);
  }
}

void encode_beer(std::span<const double> steps, float* texel) {
  const double h = 1.0 / double(steps.size());
  double total = 0, greatest = 0;
  for (const double step : steps) greatest = std::max(greatest, std::abs(step));
  int count = 0;
  std::size_t front = steps.size();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    total += steps[i];
    if (!(std::abs(steps[i]) > empty_share * greatest)) continue;
    front = std::min(front, i);
    ++count;
  }
  texel[0] = float(double(front) * h);
  texel[1] = count == 0 ? 0.0f : float(total / (count * h));
  texel[2] = float(total);
}

double decode_slices(const Options& o, const float* texel, double d) {
  const double z = d * o.slices;
  const int k = std::min(int(z), o.slices - 1);
  return texel[k] + (z - k) * (double(texel[k + 1]) - texel[k]);
}

double decode_nodes(const Options& o, const float* texel, double d) {
  const float* t = texel + o.nodes;
  const int behind = int(std::upper_bound(texel, t, d) - texel);  // the first node that is deeper
  const auto depth = [](double transmittance) { return -std::log(std::max(transmittance, least_transmittance)); };
  if (behind == 0) return 0;
  if (behind == o.nodes) return depth(t[o.nodes - 1]);
  const double share = (d - texel[behind - 1]) / (double(texel[behind]) - texel[behind - 1]);
  return depth(t[behind - 1] + share * (double(t[behind]) - t[behind - 1]));
}

double decode_fourier(const Options& o, const float* texel, double d) {
  double sum = 0.5 * texel[0] * d;
  for (int k = 1; 2 * k < o.coefficients; ++k) {
    const double w = 2 * pi * k;
    sum += (texel[2 * k - 1] * std::sin(w * d) + texel[2 * k] * (1 - std::cos(w * d))) / w;
  }
  return sum;
}

double decode_beer(const float* texel, double d) {
  const double depth = texel[1] * std::max(0.0, d - texel[0]), total = texel[2];
  return std::abs(depth) < std::abs(total) ? depth : total;
}

}  // namespace

Encoder::Encoder(const Options& o) : options_(o) {
  if (o.encoding != Encoding::fourier) return;
  for (int i = 0; i < o.steps; ++i)
    for (int c = 0; c < o.coefficients; ++c) {
      const double turn = 2 * pi * ((c + 1) / 2) * (i + 0.5) / o.steps;
      waves_.push_back(2 * (c % 2 == 0 && c > 0 ? std::sin(turn) : std::cos(turn)));
    }
}

void Encoder::encode(std::span<const double> steps, float* texel) const {
  switch (options_.encoding) {
    case Encoding::slices:
      return encode_slices(steps, texel);
    case Encoding::avsm:
      return encode_nodes(options_, steps, texel);
    case Encoding::fourier:
      return encode_fourier(steps, texel);
    case Encoding::beer:
      return encode_beer(steps, texel);
  }
}

void Encoder::encode_slices(std::span<const double> steps, float* texel) const {
  const double per_slice = double(steps.size()) / options_.slices;
  double depth = 0;
  std::size_t i = 0;
  for (int k = 0; k <= options_.slices; ++k) {
    const double place = k * per_slice;
    for (; i < steps.size() && double(i + 1) <= place; ++i) depth += steps[i];
    texel[k] = float(i < steps.size() ? depth + (place - double(i)) * steps[i] : depth);
  }
}

void Encoder::encode_fourier(std::span<const double> steps, float* texel) const {
  const int n = options_.coefficients;
  double sums[most_coefficients] = {};
  const double* wave = waves_.data();
  for (std::size_t i = 0; i < steps.size(); ++i, wave += n) {
    if (steps[i] == 0) continue;
    for (int c = 0; c < n; ++c) sums[c] += steps[i] * wave[c];
  }
  std::copy(sums, sums + n, texel);
}

double decode(const Options& o, const float* texel, double d) {
  switch (o.encoding) {
    case Encoding::slices:
      return decode_slices(o, texel, d);
    case Encoding::avsm:
      return decode_nodes(o, texel, d);
    case Encoding::fourier:
      return decode_fourier(o, texel, d);
    case Encoding::beer:
      break;
  }
  return decode_beer(texel, d);
}

}  // namespace airlight::light_map
