#include "scene/load/transform.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "scene/load/ranges.h"

namespace airlight::scene::load {

Mat3 read_rotation(const TableReader& parent, const std::string& key) {
  auto reader = parent.table(key);
  if (!reader) return Mat3::Identity();
  reader->allow({"axis", "angle", "euler"});
  using Eigen::AngleAxisd;
  if (reader->one_of({"axis", "euler"}) == "axis")
    return AngleAxisd(reader->number("angle", coordinate), reader->direction("axis")).toRotationMatrix();
  if (reader->has("angle")) reader->fail("angle", "found 'angle' beside 'euler', expected it beside 'axis' only");
  const Vec3 euler = reader->vector("euler");
  return (AngleAxisd(euler[2], Vec3::UnitZ()) * AngleAxisd(euler[1], Vec3::UnitY()) *
          AngleAxisd(euler[0], Vec3::UnitX()))
      .toRotationMatrix();
}

Similarity read_transform(const TableReader& parent, const std::string& key) {
  auto reader = parent.table(key);
  if (!reader) return {};
  reader->allow({"rotation", "scale", "translation"});
  return {read_rotation(*reader, "rotation"), reader->number("scale", length, 1),
          reader->vector("translation", Vec3(Vec3::Zero()))};
}

Box read_corners(const TableReader& reader) {
  Box box{reader.vector("lo"), reader.vector("hi")};
  if (!((box.hi - box.lo).array() >= least_length).all())
    reader.expected("hi", fmt::format("a corner {} m or more above 'lo' on every axis", least_length));
  return box;
}

}  // namespace airlight::scene::load
