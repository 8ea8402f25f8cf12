#include "reference/stable_fluids/balance.h"

#include <limits>

namespace airlight::stable_fluids {
namespace {

// Whether a way leads through each part of the fluid once around a periodic axis and back to its first cell.
std::vector<bool> leads_around(const Lattice& l, const Obstacles& obstacles, const FluidParts& parts, int axis) {
  std::vector<bool> around(parts.open.size(), l.periodic(axis) && !obstacles.any());
  if (!l.periodic(axis) || !obstacles.any()) return around;
  constexpr int unknown = std::numeric_limits<int>::min();
  std::vector<int> turns(parts.part.size(), unknown);  // of the way that found a cell
  std::vector<std::array<int, 3>> waiting;
  const auto index = [&](const std::array<int, 3>& c) {
    return c[0] + std::size_t(l.n[0]) * (c[1] + std::size_t(l.n[1]) * c[2]);
  };
  std::array<int, 3> start;
  for (start[2] = 0; start[2] < l.n[2]; ++start[2])
    for (start[1] = 0; start[1] < l.n[1]; ++start[1])
      for (start[0] = 0; start[0] < l.n[0]; ++start[0]) {
        const std::size_t first = index(start);
        if (parts.part[first] == 0 || turns[first] != unknown) continue;
        turns[first] = 0;
        waiting.push_back(start);
        while (!waiting.empty()) {
          const std::array<int, 3> cell = waiting.back();
          waiting.pop_back();
          const std::size_t here = index(cell);
          for (int a = 0; a < l.dimensions; ++a)
            for (const int step : {-1, 1}) {
              std::array<int, 3> next = cell;
              next[a] += step;
              int turn = turns[here];
              if (next[a] < 0 || next[a] >= l.n[a]) {
                if (!l.periodic(a)) continue;
                next[a] = (next[a] + l.n[a]) % l.n[a];
                if (a == axis) turn += step;
              }
              const std::size_t there = index(next);
              if (parts.part[there] == 0) continue;
              if (turns[there] == unknown) {
                turns[there] = turn;
                waiting.push_back(next);
              } else if (turns[there] != turn) {
                around[parts.part[here]] = true;
              }
            }
        }
      }
  return around;
}

// The sides with open faces that a part of the fluid touches.
using OpenSides = std::array<std::array<bool, 2>, 3>;
std::vector<OpenSides> open_sides(const Lattice& l, const FluidParts& parts) {
  std::vector<OpenSides> open(parts.open.size(), OpenSides{});
  for (int a = 0; a < l.dimensions; ++a)
    for (int side = 0; side < 2; ++side) {
      if (l.sides[a][side].kind != scene::Side::Kind::open) continue;
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      std::array<int, 3> cell{};
      cell[a] = side == 0 ? 0 : l.n[a] - 1;
      for (cell[b] = 0; cell[b] < l.n[b]; ++cell[b])
        for (cell[c] = 0; cell[c] < l.n[c]; ++cell[c])
          open[parts.part[cell[0] + std::size_t(l.n[0]) * (cell[1] + std::size_t(l.n[1]) * cell[2])]][a][side] = true;
    }
  return open;
}

}  // namespace

template <class Real>
Balance<Real>::Balance(const Lattice& l, const Obstacles& obstacles, const FluidParts& parts)
    : l_(l), obstacles_(obstacles), parts_(parts) {
  const std::vector<OpenSides> open = open_sides(l, parts);
  for (int a = 0; a < l.dimensions; ++a) {
    const std::vector<bool> around = leads_around(l, obstacles, parts, a);
    fates_[a].assign(parts.open.size(), Fate::balanced);
    for (std::size_t part = 1; part < parts.open.size(); ++part) {
      // The pressure is 0 on open sides: that of the profile can be where they all lie at one end of its axis.
      bool elsewhere = open[part][a][0] && open[part][a][1];
      for (int b = 0; b < l.dimensions; ++b) elsewhere |= b != a && (open[part][b][0] || open[part][b][1]);
      fates_[a][part] = elsewhere ? Fate::deferred : around[part] ? Fate::around : Fate::balanced;
    }
  }
}

template <class Real>
template <class Body>
void Balance<Real>::each_face(const Field<Real>& component, int plane, const Body& body) const {
  const int a = component.axis;
  const bool on_low = plane == 0 && !l_.periodic(a), on_high = plane == l_.n[a];
  if ((on_low || on_high) && l_.sides[a][on_low ? 0 : 1].kind != scene::Side::Kind::open) return;
  const int inside = on_high ? plane - 1 : plane;  // a cell at the face
  const auto face = [&](int i, int j, int k) {
    if (obstacles_.any() && beside_solid(obstacles_, component, i, j, k)) return;
    const int x = a == 0 ? inside : i, y = a == 1 ? inside : j, z = a == 2 ? inside : k;
    body(parts_.part[x + std::size_t(l_.n[0]) * (y + std::size_t(l_.n[1]) * z)], i, j, k);
  };
  // The first axis is the inner one wherever it can be.
  const int inner = a == 0 ? 1 : 0, outer = a == 2 ? 1 : 2;
  std::array<int, 3> c{};
  c[a] = plane;
  for (c[outer] = 0; c[outer] < component.n[outer]; ++c[outer])
    for (c[inner] = 0; c[inner] < component.n[inner]; ++c[inner]) face(c[0], c[1], c[2]);
}

template <class Real>
void Balance<Real>::add(const Field<Real>& change, Field<Real>& component) {
  const int a = component.axis, planes = component.n[a];
  const std::size_t parts = parts_.open.size();
  std::vector<double> first(planes * parts, 0.0), sum(planes * parts, 0.0), count(planes * parts, 0.0);
  // Differences to the first face: where all are equal, the mean is this value to the bit, and nothing moves at all.
  for_each(planes, [&](int plane) {
    each_face(component, plane, [&](int part, int i, int j, int k) {
      const std::size_t to = at(plane, part);
      const double value = double(change.at(i, j, k));
      if (count[to]++ == 0) first[to] = value;
      sum[to] += value - first[to];
    });
  });
  std::vector<double>& profile = first;
  for (std::size_t to = 0; to < profile.size(); ++to)
    if (count[to] > 0) profile[to] += sum[to] / count[to];
  for_each(planes, [&](int plane) {
    each_face(component, plane, [&](int part, int i, int j, int k) {
      component.at(i, j, k) += Real(double(change.at(i, j, k)) - profile[at(plane, part)]);
    });
  });
  std::vector<double>& deferred = deferred_[a];
  deferred.clear();
  for (std::size_t part = 1; part < parts; ++part) {
    if (fates_[a][part] == Fate::balanced) continue;
    double mean = 0;
    for (int plane = 0; plane < planes; ++plane) mean += profile[at(plane, int(part))] / planes;
    deferred.resize(profile.size(), 0.0);
    for (int plane = 0; plane < planes; ++plane) {
      const std::size_t to = at(plane, int(part));
      deferred[to] = fates_[a][part] == Fate::around ? mean : profile[to];
    }
  }
}

template <class Real>
void Balance<Real>::add_deferred(Velocity<Real>& u) {
  for (int a = 0; a < l_.dimensions; ++a) {
    if (deferred_[a].empty()) continue;
    for_each(u[a].n[a], [&](int plane) {
      each_face(u[a], plane,
                [&](int part, int i, int j, int k) { u[a].at(i, j, k) += Real(deferred_[a][at(plane, part)]); });
    });
    deferred_[a].clear();
  }
}

template class Balance<float>;
template class Balance<double>;

}  // namespace airlight::stable_fluids
