#include "scene/math/special_functions.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "scene/math/exp_erfc.h"
#include "scene/math/types.h"

namespace special_functions_test {

using namespace airlight;

// Values in 30 digits from an arbitrary-precision program.
TEST_CASE("erfcx to 2e-15 everywhere", "[media]") {
  const std::pair<double, double> table[] = {{-26.5, 1.9245531624185688092e+305},
                                             {-20.0, 1.0442939379528287901e+174},
                                             {-9.3, 7.2972585737527943283e+37},
                                             {-5.0, 144009798674.66104041},
                                             {-3.0, 16205.988853999586625},
                                             {-1.7, 35.694955906025280896},
                                             {-1.0, 5.0089800807622834663},
                                             {-0.5, 1.9523604891825570933},
                                             {-0.001, 1.0011293799198485917},
                                             {-1e-09, 1.0000000011283791681},
                                             {0.0, 1.0},
                                             {1e-300, 1.0},
                                             {1e-12, 0.99999999999887162083},
                                             {1e-06, 0.99999887162183290374},
                                             {0.001, 0.9988726200811514086},
                                             {0.01, 0.98881546104634251033},
                                             {0.1, 0.89645697996912663666},
                                             {0.25, 0.77034654773099674392},
                                             {0.5, 0.61569034419292587487},
                                             {0.75, 0.50693765029314480579},
                                             {1.0, 0.42758357615580700441},
                                             {1.5, 0.32158541645431750235},
                                             {2.0, 0.25539567631050574387},
                                             {2.5, 0.21080636406114358065},
                                             {3.0, 0.17900115118138995042},
                                             {3.75, 0.14558972127503853905},
                                             {4.0, 0.13699945762506138989},
                                             {5.0, 0.11070463773306862637},
                                             {6.0, 0.092776567800538354389},
                                             {7.7, 0.072668477501867028446},
                                             {9.0, 0.062307724037774684147},
                                             {10.0, 0.056140992743822585858},
                                             {12.0, 0.04685422101489376262},
                                             {15.0, 0.037529606388505765746},
                                             {20.0, 0.028174348741051319319},
                                             {26.0, 0.021683584850562906616},
                                             {27.0, 0.020881607990420940674},
                                             {30.0, 0.018795888861416751497},
                                             {50.0, 0.0112815362653237725},
                                             {100.0, 0.0056416137829894329036},
                                             {1000.0, 0.0005641893014533876542},
                                             {100000.0, 5.6418958351954680777e-6},
                                             {100000000.0, 5.6418958354775625874e-9},
                                             {1000000000000.0, 5.6418958354775628695e-13},
                                             {1e+20, 5.6418958354775628695e-21},
                                             {1e+150, 5.6418958354775629776e-151},
                                             {1e+300, 5.6418958354775625733e-301}};
  for (const auto& [x, value] : table) {
    INFO(x);
    CHECK(std::abs(erfcx(x) / value - 1) <= 2e-15);
  }
  CHECK(erfcx(0) == Approx(1).margin(2e-15));
  CHECK(erfcx(infinity) == 0);
  CHECK(erfcx(-27) == infinity);
  CHECK(std::isnan(erfcx(NAN)));
}

// Inside the range where erfc of the standard library does not underflow the two must agree: exp(x^2) carries the
// rounding of x^2, hence the tolerance.
TEST_CASE("erfcx is exp(x^2) erfc(x)", "[media]") {
  for (int i = -500; i <= 2500; ++i) {
    const double x = 0.01 * i;
    INFO(x);
    CHECK(std::abs(erfcx(x) / (std::exp(x * x) * std::erfc(x)) - 1) <= 4e-15 + 2.3e-16 * x * x);
  }
}

TEST_CASE("means of exponentials do not cancel", "[media]") {
  // Taylor: 1 - x/2 + x^2/6; the next term is below 1e-18.
  CHECK(mean_exp_minus(1e-6) == Approx(1 - 0.5e-6 + 1e-12 / 6).epsilon(1e-15));
  CHECK(mean_exp_minus(0) == 1);
  CHECK(mean_exp_minus(infinity) == 0);
  CHECK(mean_transmittance(3, 3) == std::exp(-3.0));
  CHECK(mean_transmittance(3, 3 + 1e-9) == Approx(std::exp(-3.0) * (1 - 0.5e-9)).epsilon(2e-15));
  CHECK(mean_transmittance(1, 4) == Approx((std::exp(-1.0) - std::exp(-4.0)) / 3).epsilon(1e-15));
  CHECK(mean_transmittance(4, 1) == mean_transmittance(1, 4));
  CHECK(mean_transmittance(2, infinity) == 0);
  CHECK(mean_transmittance(infinity, infinity) == 0);
}

// Long double has 11 more bits: its exp is the truth here. 3e-16 is the stated error, 1.35 units in the last place.
TEST_CASE("exp(-u) for single numbers and packs", "[media]") {
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const double u = i < 100000 ? 708.0 * i / 100000 : std::ldexp(1.0 + i / 100000.0, -(i % 40));
    const double value = exp_minus(u);
    worst = std::max(worst, double(std::abs(value / std::exp(-(long double)u) - 1)));
    if (i % 97 != 0) continue;
    const Pack four = exp_minus(Pack{u, 0, 1, 800});
    CHECK(four[0] == value);
    CHECK(four[1] == 1);
    CHECK(four[2] == exp_minus(1.0));
    CHECK(four[3] == 0);
    CHECK(erfcx_positive(Pack{u, u, u, u})[i % 4] == erfcx_positive(u));
  }
  CHECK(worst <= 3e-16);
  CHECK(exp_minus(infinity) == 0);
  CHECK(exp_minus(708.0) == 0);
}

}  // namespace special_functions_test
