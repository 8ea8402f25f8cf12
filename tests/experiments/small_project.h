// A small project to run the program or the driver in: one scene that takes no time, experiments around it.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace airlight::test {

// A box of homogeneous fog beside a point light; `in_camera` are further lines of the camera.
inline std::string box_of_fog(int width, int height, const std::string& in_camera = "") {
  return "[film]\nwidth = " + std::to_string(width) + "\nheight = " + std::to_string(height) +
         "\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n" + in_camera + R"([[light]]
type = "point"
position = [1.5, 2, 1]
intensity = 5
[[medium]]
type = "homogeneous"
sigma_t = 0.5
region = { type = "box", lo = [-1, -1, -1], hi = [1, 1, 1] }
)";
}

struct Method {
  std::string name, renderer, at_most;
  std::string settings = {};  // what stands between the braces
};

// An experiment on that scene against quadrature, with a gate on each method's rel_l2. `at_top` are lines before all.
inline std::string against_quadrature(const std::vector<Method>& methods, const std::string& at_top = "") {
  std::string text = "title = \"Steps\"\n" + at_top + R"(layer = "airlight"
metrics = ["rel_l2"]
[[scene]]
file = "scenes/one.toml"
[reference]
renderer = "deterministic"
)",
              gates;
  for (const Method& m : methods) {
    text +=
        "[[method]]\nname = \"" + m.name + "\"\nrenderer = \"" + m.renderer + "\"\nsettings = { " + m.settings + " }\n";
    gates += "[[gate]]\nmethod = \"" + m.name + "\"\nmetric = \"rel_l2\"\nat_most = " + m.at_most + "\n";
  }
  return text + "[profile.quick]\nbudget = 0\n" + gates;
}

// The marcher on the processor and on the device.
inline std::string both_backends(const std::string& at_most_cpu, const std::string& at_top = "") {
  return against_quadrature({{"CPU", "ray_marcher", at_most_cpu}, {"GPU", "ray_marcher_gpu", "0.5"}}, at_top);
}

struct SmallProject : TemporaryFolder {
  explicit SmallProject(const std::string& scene, const std::string& experiment = "") {
    write("experiments/README.md", "");
    write("experiments/scenes/one.toml", scene);
    if (!experiment.empty()) write("experiments/g/e.toml", experiment);
  }
  bool has(const std::string& file) const { return std::filesystem::exists(path() / file); }
};

}  // namespace airlight::test
