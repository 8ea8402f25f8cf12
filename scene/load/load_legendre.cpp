// A Legendre box: coefficients in the scene file, or in a CSV file beside it.
#include <fmt/format.h>

#include <cmath>

#include "scene/load/assets.h"
#include "scene/load/csv_table.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/load/transform.h"
#include "scene/math/legendre.h"
#include "scene/media/legendre_box.h"

namespace airlight::scene::load {
namespace {

constexpr std::string_view legendre_header = "i,j,k,coefficient";

constexpr Range coefficient = either_sign(density_range);

}  // namespace

// Rows in any order; coefficients that are not named are 0.
Eigen::VectorXd read_legendre_csv(const std::string& path, const TensorShape& shape) {
  CsvTable table(path, legendre_header);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(tensor_size(shape));
  std::vector<bool> given(std::size_t(values.size()));
  while (table.next()) {
    const auto row = table.values({{0, shape[0] - 1.0}, {0, shape[1] - 1.0}, {0, shape[2] - 1.0}, coefficient});
    std::size_t at = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (row[axis] != std::floor(row[axis]))
        table.fail(axis, fmt::format("{} = {}, expected an integer", "ijk"[axis], row[axis]));
      at = at * std::size_t(shape[axis]) + std::size_t(row[axis]);
    }
    if (given[at]) table.fail(0, "found the same indices a second time, expected each once");
    given[at] = true;
    values[Eigen::Index(at)] = row[3];
  }
  return values;
}

LegendrePointer read_legendre(TableReader& reader, const std::string& folder) {
  reader.allow(medium_keys_and({"lo", "hi", "size", "coefficients", "file", "frame"}));
  const Box box = read_corners(reader);
  const auto size = reader.integers("size", 3, 1, LegendreBox::most);
  const TensorShape shape = {int(size[0]), int(size[1]), int(size[2])};
  Eigen::VectorXd coefficients;
  if (reader.one_of({"coefficients", "file"}) == "file") {
    coefficients = read_legendre_csv(find_asset(reader, "file", name_of_frame(reader), folder), shape);
  } else {
    reader.allow(medium_keys_and({"lo", "hi", "size", "coefficients"}));
    const std::vector<double> values = reader.numbers("coefficients", coefficient);
    if (values.size() != std::size_t(tensor_size(shape)))
      reader.fail("coefficients", fmt::format("coefficients has {} numbers, expected {} = {} x {} x {}, z fastest",
                                              values.size(), tensor_size(shape), shape[0], shape[1], shape[2]));
    coefficients = Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
  }
  return std::make_shared<const LegendreBox>(box, shape, std::move(coefficients));
}

}  // namespace airlight::scene::load
