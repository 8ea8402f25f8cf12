#include "scene/base/error.h"
#include "scene/load/assets.h"
#include "scene/load/parts.h"
#include "scene/load/ranges.h"
#include "scene/load/transform.h"

namespace airlight::scene::load {

// With a map or coefficients it can be scaled and turned; a constant is what it says.
EnvironmentLight read_environment(TableReader reader, const std::string& folder) {
  reader.allow({"type", "file", "radiance", "sh", "scale", "rotation"});
  const std::string kind = reader.one_of({"file", "radiance", "sh"});
  if (kind == "radiance") {
    reader.allow({"type", "radiance"});
    return make_constant_environment(reader.color("radiance", amount));
  }
  reader.allow({"type", kind, "scale", "rotation"});
  const Rgb scale = reader.color("scale", amount, Rgb::Ones());
  // The rotation turns the map in the world; looking up turns the world's directions back.
  const Mat3 to_map = read_rotation(reader, "rotation").transpose();
  const std::string path = kind == "file" ? find_asset(reader, "file", folder) : "";
  const std::vector<Rgb> coefficients = kind == "sh" ? reader.colors("sh", signed_amount) : std::vector<Rgb>();
  EnvironmentLight light;
  try {
    light = kind == "file" ? make_map_environment(read_environment_map(path), to_map, scale, path)
                           : make_sh_environment(coefficients, to_map, scale);
  } catch (const Error& e) {
    reader.fail(kind, e.what());
  }
  require_radiance(reader, light);
  return light;
}

}  // namespace airlight::scene::load
