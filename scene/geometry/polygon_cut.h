// Polygons as triangles.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "scene/math/types.h"

namespace airlight::scene {

// Cuts a polygon of n >= 3 corners into n - 2 triangles of its corners (numbers from 0 on), wound as the polygon is.
// The corners need not lie in one plane: the decisions are made in the coordinate plane that the polygon faces most, and
// exactly, so that corners on the diagonal of others, repeated ones and holes that an edge runs to and fro are right.
// Corners that have no area give triangles without area. Nothing for a polygon that crosses itself. A quadrilateral is
// always cut: where it is not flat, its projection may cross itself and its triangles do not.
//
// By ears (Meisters 1975), in about n^2 steps. No triangle is wound the other way: then their sum is the polygon.
std::optional<std::vector<std::array<int, 3>>> cut_polygon(const std::vector<Point3>& corners);

}  // namespace airlight::scene
