// Oracle vectors on the device, as `airlight verify --device` compares them.
#include <sstream>
#include <string>
#include <vector>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/verify/verify.h"
#include "scene/base/error.h"
#include "tests/gpu/device.h"
#include "tests/temporary_folder.h"

namespace vectors_test {

using namespace airlight;
using experiments::VerifyKind;

namespace {

const std::string vectors = AIRLIGHT_SOURCE_DIR "/tests/vectors/";

// The exit code, and what became of the kind; its lines are in `out`.
std::pair<int, VerifyKind> verified(const std::string& path, const std::string& kind, std::ostream& out) {
  std::vector<VerifyKind> kinds;
  const int code =
      experiments::verify({path}, kind, experiments::VerifyProfile::quick, out, &kinds, experiments::VerifyOn::device);
  return {code, kinds.at(0)};
}

// Nothing of these kinds is out, and so many numbers of each are compared: "KIND NUMBERS KIND NUMBERS ...".
void check(const std::string& file, const std::string& numbers) {
  std::istringstream list(numbers);
  std::string kind;
  for (int number; list >> kind >> number;) {
    std::ostringstream out;
    const auto [code, found] = verified(vectors + file + ".json", kind, out);
    CAPTURE(kind, out.str());
    CHECK(code == 0);
    CHECK(found.numbers == number);
  }
  CHECK(list.eof());
}

}  // namespace

DEVICE_TEST_CASE("oracle vectors on the device: airlight of shadow planes", "[gpu][verify][shadow_planes]") {
  check("shadow_planes", "airlight 38");
}

DEVICE_TEST_CASE("oracle vectors on the device: fogmaps", "[gpu][verify][wavelet_fog]") {
  check("wavelet_fog", "analysis2d 49 optical_depth 68 multires 22");
}

DEVICE_TEST_CASE("oracle vectors on the device: Legendre fluids and their light", "[gpu][verify][legendre_fluids]") {
  check("legendre_fluids",
        "project 12 coefficients 4 evaluate 48 advect 14 diffuse 2 rk4 6 step 3 density-advect 5 "
        "energy-identity 6 taylor-green 7 scatter 42 airlight 12 image 12 upwind-galerkin 18");
}

DEVICE_TEST_CASE("oracle vectors on the device: compensated ray marching", "[gpu][verify][compensated_ray_marching]") {
  check("compensated_ray_marching",
        "sh_basis 64 sh_triple_entry 9 sh_triple_counts 6 sh_triple_product 16 hg_zh 2 sh_convolution 1 "
        "zh_rotation 16 theta_of_d 3 gaussian_optical_depth 16 rbf_zh_optical_depth 21 sh_exponential 45 "
        "single_scattering_source 120 transmittance_environment 38 march_single_scattering 38 "
        "march_compensated 78 ray_march_homogeneous 10 collocation_matrix 16 trilinear_border 48 "
        "diffusion_uniform_source 2 diffusion_slab_marshak 9 "
        "psh_address 2 hash_round_trip 1731");
}

DEVICE_TEST_CASE("oracle vectors on the device: diffusion around a point",
                 "[gpu][verify][compensated_ray_marching][slow][thorough]") {
  check("compensated_ray_marching", "diffusion_point_source 3");
}

DEVICE_TEST_CASE("oracle vectors on the device: a ball of smoke with all orders",
                 "[gpu][verify][compensated_ray_marching][slow][thorough]") {
  check("compensated_ray_marching", "multiple_scattering_sphere 29");
}

DEVICE_TEST_CASE("vectors that others made are met on the device, too", "[gpu][verify]") {
  for (const char* name : {"shadow_planes", "wavelet_fog", "legendre_fluids", "compensated_ray_marching"}) {
    std::ostringstream out;
    const int code = experiments::verify({vectors + "other/" + name + ".json"}, "", experiments::VerifyProfile::quick,
                                         out, nullptr, experiments::VerifyOn::device);
    CAPTURE(out.str());
    CHECK(code == 0);
  }
}

DEVICE_TEST_CASE("a wrong number is found on the device, and a kind that no device code computes is listed",
                 "[gpu][verify]") {
  auto file = experiments::read_json(vectors + "shadow_planes.json");
  file["vectors"][0]["expect"]["log10_L"] = -1.96;  // off by 7e-4
  const TemporaryFolder folder;
  folder.write("wrong.json", file.dump());
  std::ostringstream out;
  const auto [code, found] = verified(folder.file("wrong.json"), "airlight", out);
  CHECK(code == 1);
  CHECK(found.out == 1);
  const auto [without, none] = verified(vectors + "shadow_planes.json", "bounded", out);
  CHECK(without == 1);
  CHECK(none.not_yet == 5);
  CHECK_THAT(out.str(), Catch::Contains("no device code computes this") &&
                            Catch::Contains("5 vectors that no device code computes"));
}

}  // namespace vectors_test
