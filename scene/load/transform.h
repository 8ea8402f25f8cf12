// Rotations, similarity transforms and boxes of a scene file.
#pragma once
#include "scene/load/table_reader.h"
#include "scene/math/types.h"

namespace airlight::scene::load {

// x -> rotation * (scale * x) + translation.
struct Similarity {
  Mat3 rotation = Mat3::Identity();
  double scale = 1;  // > 0
  Vec3 translation = Vec3::Zero();
  Point3 operator()(const Point3& x) const { return rotation * (scale * x) + translation; }
};

// The table under `key`: { axis, angle } (counter-clockwise seen against the axis), or { euler = [x, y, z] } (about the
// fixed x axis first, then y, then z); all in radians. The identity if there is no such key.
Mat3 read_rotation(const TableReader&, const std::string& key);

// The table under `key`: { rotation, scale, translation }, the translation applied last. The
// identity if there is no such key.
Similarity read_transform(const TableReader&, const std::string& key);

// The box between the corners `lo` and `hi`, lo below hi on every axis.
Box read_corners(const TableReader&);

}  // namespace airlight::scene::load
