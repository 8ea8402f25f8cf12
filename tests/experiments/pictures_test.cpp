// Pictures that the driver makes of a film.
#include "experiments/driver/pictures.h"

#include <catch2/catch.hpp>
#include <cmath>

namespace pictures_test {

using namespace airlight::experiments;
using airlight::scene::Film;

// For the luminances 0 to 100 the 99 % quantile is 99: shown as 0.8.
TEST_CASE("a picture's exposure shows its 99 % quantile as 0.8", "[driver]") {
  Film film(101, 1);
  auto& mean = film.add("mean");
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = float(i / 3);
  CHECK(exposure_of(film, "mean") == Approx(std::log2(0.8 / 99)));
  Film dark(4, 1);
  dark.add("mean");
  CHECK(exposure_of(dark, "mean") == 0);
}

}  // namespace pictures_test
