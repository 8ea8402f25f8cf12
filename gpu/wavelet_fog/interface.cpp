#include "gpu/wavelet_fog/interface.h"

#include <fmt/format.h>

#include <cstddef>

#include "methods/wavelet_fog/leveled_fog.h"
#include "scene/base/error.h"

namespace airlight::gpu::wavelet_fog {
namespace {

Definitions shared_definitions() {
  Definitions definitions{{"UPRIGHT", fmt::format("{:e}LF", airlight::wavelet_fog::upright)}};
  const auto number = [&](const char* name, auto kind) { definitions[name] = std::to_string(int(kind)); };
  number("REGION_UNBOUNDED", RegionKind::unbounded);
  number("REGION_BOX", RegionKind::box);
  number("REGION_SPHERE", RegionKind::sphere);
  number("REGION_SLAB", RegionKind::slab);
  number("PROFILE_NONE", Profile::none);
  number("PROFILE_LAYERS", Profile::layers);
  number("PROFILE_EXPONENTIAL", Profile::exponential);
  // By their place in the variant.
  number("PHASE_RAYLEIGH", scene::PhaseFunction(scene::Rayleigh()).index());
  number("PHASE_HENYEY_GREENSTEIN", scene::PhaseFunction(scene::HenyeyGreenstein()).index());
  number("PHASE_HAZY", scene::PhaseFunction(scene::Hazy()).index());
  number("PHASE_MURKY", scene::PhaseFunction(scene::Murky()).index());
  using Variant = airlight::wavelet_fog::Options::Variant;
  number("VARIANT_PAPER", Variant::paper);
  number("VARIANT_PRE", Variant::pre);
  number("VARIANT_TELE", Variant::tele);
  number("VARIANT_BOUND", Variant::bound);
  number("VARIANT_POLAR", Variant::polar);
  const std::pair<const char*, int> bindings[] = {{"FOG", at::fog},
                                                  {"GRIDS", at::grids},
                                                  {"VALUES", at::values},
                                                  {"EMPTINESS", at::emptiness},
                                                  {"TABLE", at::table},
                                                  {"DISTANCES", at::distances},
                                                  {"DEPTHS", at::depths},
                                                  {"COUNTERS", at::counters},
                                                  {"LIT", at::lit},
                                                  {"AIRLIGHT", at::airlight},
                                                  {"SUN_RAYS", at::sun_rays},
                                                  {"PACKED_VALUES", at::packed_values},
                                                  {"PACKED_EMPTINESS", at::packed_emptiness},
                                                  {"AIRLIGHT_LAYER", at::airlight_layer},
                                                  {"PRIMITIVES", at::primitives},
                                                  {"MATERIALS", at::materials},
                                                  {"TABLES", at::tables},
                                                  {"TRANSMITTANCE_LAYER", at::transmittance_layer},
                                                  {"AMBIENT_LAYER", at::ambient_layer},
                                                  {"SURFACE_LAYER", at::surface_layer},
                                                  {"MEAN_LAYER", at::mean_layer},
                                                  {"SEEN", at::seen}};
  for (const auto& [name, number] : bindings) definitions[std::string("AT_") + name] = std::to_string(number);
  return definitions;
}

void check_layouts(const Program& program, const std::string& file, std::size_t media) {
  const struct {
    const char* variable;
    std::size_t offset, stride;
  } expected[] = {{"fogs[0].region_hi[0]", offsetof(FogData, region_hi), sizeof(FogData)},
                  {"fogs[0].highest", offsetof(FogData, highest), sizeof(FogData)},
                  {"fogs[0].enough", offsetof(FogData, enough), sizeof(FogData)},
                  {"fogs[0].region", offsetof(FogData, region), sizeof(FogData)},
                  {"fogs[0].first_word", offsetof(FogData, first_word), sizeof(FogData)},
                  {"knot[0]", media * sizeof(FogData), 0},
                  {"grids[0].stride", offsetof(GridData, stride), sizeof(GridData)},
                  {"lit[0].t", offsetof(LitData, t), sizeof(LitData)},
                  {"sun_rays[0].state.way", offsetof(SunState, way), 0},
                  {"sun_rays[0].state.read", offsetof(SunState, read), 0},
                  {"sun_rays[0].edge[0]", sizeof(SunState), 0}};
  for (const auto& [variable, offset, stride] : expected) {
    const auto found = program.place_of(variable);
    if (!found || found->offset == 0) continue;  // so Mesa says of what is not used
    if (std::size_t(found->offset) == offset && (stride == 0 || std::size_t(found->stride) == stride)) continue;
    throw Error(fmt::format("gpu/wavelet_fog/{}.comp: {} at byte {}, {} apart; expected {} and {}", file, variable,
                            found->offset, found->stride, offset, stride));
  }
}

}  // namespace

std::string listed(const std::vector<double>& values) {
  std::string list;
  for (const double value : values) list += fmt::format("{}{:.9e}", list.empty() ? "" : ", ", value);
  return list;
}

Program& program(Context& context, const std::string& file, int x, int y, Definitions definitions) {
  definitions.merge(shared_definitions());
  const auto media = definitions.find("MEDIA");
  definitions["LOCAL_SIZE_X"] = std::to_string(x);
  definitions["LOCAL_SIZE_Y"] = std::to_string(y);
  Program& made = context.program("wavelet_fog/" + file + ".comp", definitions);
  check_layouts(made, file, media == definitions.end() ? 1 : std::stoul(media->second));
  return made;
}

}  // namespace airlight::gpu::wavelet_fog
