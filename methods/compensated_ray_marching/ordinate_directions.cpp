#include "methods/compensated_ray_marching/ordinate_directions.h"

#include <cmath>

#include "scene/math/gauss_legendre.h"

namespace airlight::compensated_ray_marching {

std::vector<Ordinate> ordinate_directions(int levels, int azimuths, bool hemispheres) {
  const scene::GaussLegendre rule = scene::gauss_legendre(levels);
  std::vector<double> cosine, weight;
  for (const double side : hemispheres ? std::vector<double>{-1, 1} : std::vector<double>{0})
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      cosine.push_back(side == 0 ? rule.node[i] : 0.5 * (side + rule.node[i]));
      weight.push_back(side == 0 ? rule.weight[i] : 0.5 * rule.weight[i]);
    }
  std::vector<Ordinate> directions;
  for (std::size_t i = 0; i < cosine.size(); ++i)
    for (int k = 0; k < azimuths; ++k) {
      // Half a spacing from the axes: no direction lies in a plane of the grid.
      const double phi = 2 * pi * (k + 0.5) / azimuths, sine = std::sqrt(1 - cosine[i] * cosine[i]);
      directions.push_back({{sine * std::cos(phi), sine * std::sin(phi), cosine[i]}, weight[i] * 2 * pi / azimuths});
    }
  return directions;
}

}  // namespace airlight::compensated_ray_marching
