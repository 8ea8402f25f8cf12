#include "methods/fogshop/authoring/edit.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/base/error.h"

namespace airlight::fogshop::authoring {
namespace {

// Erases a share of each Gaussian by the places of the path; distance2(i, place) is the square of their distance,
// infinite if there is none.
template <class F>
std::vector<Id> erase_with(GaussianList& list, std::size_t places, const Eraser& eraser, F distance2) {
  std::vector<Id> ids;
  std::vector<std::size_t> gone;
  const double radius2 = eraser.radius * eraser.radius;
  for (std::size_t i = 0; i < list.all().size(); ++i) {
    Gaussian gaussian = list.all()[i];
    const double before = gaussian.c;
    for (std::size_t place = 0; place < places; ++place) {
      const double r2 = distance2(gaussian.b, place);
      if (r2 < radius2) gaussian.c -= eraser.strength * before * (1 - r2 / radius2);
    }
    if (gaussian.c == before) continue;
    ids.push_back(gaussian.id);
    if (gaussian.c > 0)
      list.change(i, gaussian);
    else
      gone.push_back(i);
  }
  if (!gone.empty()) list.remove(gone);
  return ids;
}

// Positions in the list, ascending.
std::vector<std::size_t> positions_of(const GaussianList& list, std::vector<Id> ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<std::size_t> positions;
  std::vector<Id> found;
  for (std::size_t i = 0; i < list.all().size(); ++i)
    if (std::binary_search(ids.begin(), ids.end(), list.all()[i].id)) {
      positions.push_back(i);
      found.push_back(list.all()[i].id);
    }
  std::sort(found.begin(), found.end());
  for (const Id id : ids)
    if (!std::binary_search(found.begin(), found.end(), id)) throw Error(fmt::format("no Gaussian has the id {}", id));
  return positions;
}

Gaussian placed(Gaussian gaussian, const Placement& placement) {
  gaussian.b = placement.rotation * (placement.scale * gaussian.b) + placement.translation;
  gaussian.a /= placement.scale;
  if (placement.keep == Placement::Keep::depth) gaussian.c /= placement.scale;
  gaussian.velocity = placement.rotation * gaussian.velocity;
  return gaussian;
}

}  // namespace

std::vector<Id> erase(GaussianList& list, const std::vector<Point3>& path, const Eraser& eraser) {
  return erase_with(list, path.size(), eraser,
                    [&](const Point3& b, std::size_t place) { return (b - path[place]).squaredNorm(); });
}

std::vector<Id> erase(GaussianList& list, const View& view, const std::vector<ScreenPoint>& path,
                      const Eraser& eraser) {
  return erase_with(list, path.size(), eraser, [&](const Point3& b, std::size_t place) {
    const auto p = project(view, b);
    return p ? (*p - path[place]).squaredNorm() : infinity;
  });
}

std::vector<Id> copy(GaussianList& list, const std::vector<Id>& ids, const Placement& placement) {
  std::vector<Id> clones;
  for (const std::size_t i : positions_of(list, ids)) clones.push_back(list.add(placed(list.all()[i], placement)));
  return clones;
}

std::vector<Id> move(GaussianList& list, const std::vector<Id>& ids, const Placement& placement) {
  std::vector<Id> moved;
  for (const std::size_t i : positions_of(list, ids)) {
    list.change(i, placed(list.all()[i], placement));
    moved.push_back(list.all()[i].id);
  }
  return moved;
}

}  // namespace airlight::fogshop::authoring
