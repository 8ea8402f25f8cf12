// A sum of Gaussians: written in the scene file, or as a table in a CSV file beside it.
#include <fmt/format.h>

#include "scene/load/assets.h"
#include "scene/load/csv_table.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"

namespace airlight::scene::load {
namespace {

constexpr std::size_t most_gaussians = std::size_t(1) << 20;  // every ray may have to look at each
constexpr std::string_view header = "center_x,center_y,center_z,width,amplitude";
// Header that `airlight fit` writes. Ids identify Gaussians from frame to frame, for programs that interpolate;
// renderers do not use them.
constexpr std::string_view header_with_ids = "id,center_x,center_y,center_z,width,amplitude";
constexpr Range id{0, 2147483647};

Gaussian read_gaussian(TableReader reader) {
  reader.allow({"center", "width", "amplitude"});
  return {reader.vector("center"), reader.number("width", length),
          reader.number("amplitude", either_sign(density_range))};
}

}  // namespace

std::vector<Gaussian> read_gaussians_csv(const std::string& path, std::vector<int>* ids) {
  CsvTable table(path, header, header_with_ids);
  std::vector<Range> ranges{coordinate, coordinate, coordinate, length, either_sign(density_range)};
  const std::size_t first = table.header() == header ? 0 : 1;
  if (first == 1) ranges.insert(ranges.begin(), id);
  std::vector<Gaussian> gaussians;
  if (ids) ids->clear();
  while (table.next()) {
    if (gaussians.size() == most_gaussians)
      table.fail(0, fmt::format("found more than {} Gaussians, expected fewer", most_gaussians));
    const std::vector<double> values = table.values(ranges);
    const double* const row = values.data() + first;
    if (ids && first == 1) ids->push_back(int(values[0]));
    gaussians.push_back({{row[0], row[1], row[2]}, row[3], row[4]});
  }
  return gaussians;
}

GaussianSum read_gaussian_sum(TableReader& reader, const std::string& folder) {
  reader.allow(medium_keys_and({"constant", "cutoff", "gaussians", "file", "frame"}));
  GaussianSum sum;
  sum.constant = reader.number("constant", density_range, 0);
  sum.cutoff = reader.number("cutoff", widths, infinity);
  if (reader.one_of({"gaussians", "file"}) == "file") {
    sum.gaussians = read_gaussians_csv(find_asset(reader, "file", name_of_frame(reader, "file"), folder));
  } else {
    reader.allow(medium_keys_and({"constant", "cutoff", "gaussians"}));
    for (const TableReader& gaussian : reader.tables("gaussians")) sum.gaussians.push_back(read_gaussian(gaussian));
  }
  return sum;
}

}  // namespace airlight::scene::load
