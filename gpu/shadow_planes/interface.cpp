#include "gpu/shadow_planes/interface.h"

#include <fmt/format.h>

#include "gpu/interface.h"
#include "methods/shadow_planes/edge_fan.h"
#include "methods/shadow_planes/phase_form.h"

namespace airlight::gpu::shadow_planes {

using airlight::shadow_planes::EdgeFan;

std::map<std::string, std::string> shared_definitions() {
  std::map<std::string, std::string> definitions = {{"EDGES_PER_GROUP", std::to_string(edges_per_group)},
                                                    {"SECTORS_PER_GROUP", std::to_string(sectors_per_group)},
                                                    {"MOST_HITS", std::to_string(most_hits)},
                                                    {"MOST_NODES", std::to_string(most_nodes)},
                                                    {"FAN_LEVELS", std::to_string(EdgeFan::levels)},
                                                    {"FAN_SECTORS", std::to_string(EdgeFan::total_sectors())},
                                                    {"FAN_MARGIN", fmt::format("{:e}LF", EdgeFan::margin)},
                                                    {"FAN_LEAST_ACROSS", fmt::format("{:e}LF", EdgeFan::least_across)}};
  const auto number = [&](const char* name, auto kind) { definitions[name] = std::to_string(int(kind)); };
  number("REGION_UNBOUNDED", RegionKind::unbounded);
  number("REGION_BOX", RegionKind::box);
  number("REGION_SPHERE", RegionKind::sphere);
  number("REGION_SLAB", RegionKind::slab);
  using Phase = airlight::shadow_planes::PhaseForm::Kind;
  number("PHASE_ISOTROPIC", Phase::isotropic);
  number("PHASE_RAYLEIGH", Phase::rayleigh);
  number("PHASE_HAZY", Phase::hazy);
  number("PHASE_HENYEY_GREENSTEIN", Phase::henyey_greenstein);
  define({{"EDGES", at::edges},
          {"PRIMITIVES", at::primitives},
          {"LISTS", at::lists},
          {"EVALUATOR", at::evaluator},
          {"PIXELS", at::pixels},
          {"STATES", at::states},
          {"MEDIA", at::media},
          {"TABLES", at::tables},
          {"LIGHT_STATE", at::light_state},
          {"VALUES", at::values},
          {"COUNTERS", at::counters},
          {"MESH_VERTICES", at::mesh_vertices},
          {"MESH_TRIANGLES", at::mesh_triangles},
          {"MESH_NUMBERS", at::mesh_numbers},
          {"MESH_EDGES", at::mesh_edges},
          {"MESH_SIDES", at::mesh_sides},
          {"SECTORS", at::sectors},
          {"DISTANCES", at::distances},
          {"AIRLIGHT_LAYER", at::airlight_layer},
          {"TRANSMITTANCE_LAYER", at::transmittance_layer},
          {"SURFACE_LAYER", at::surface_layer},
          {"AMBIENT_LAYER", at::ambient_layer},
          {"MEAN_LAYER", at::mean_layer},
          {"CASES", at::cases},
          {"INTEGRALS", at::integrals}},
         definitions);
  return definitions;
}

namespace {

const std::vector<Layout> layouts = {
    {"edges[0].near_b", offsetof(EdgeData, near_b), sizeof(EdgeData)},
    {"edges[0].b[0]", offsetof(EdgeData, b), sizeof(EdgeData)},
    {"edges[0].left_out", offsetof(EdgeData, left_out), sizeof(EdgeData)},
    {"states[0].from", offsetof(StateData, from), sizeof(StateData)},
    {"states[0].m_origin", offsetof(StateData, m_origin), sizeof(StateData)},
    {"lit_pixels[0].reflected", offsetof(LitPixelData, reflected), sizeof(LitPixelData)},
    {"media[1].hi", sizeof(MediumData) + offsetof(MediumData, hi), 0},
    {"media[1].albedo", sizeof(MediumData) + offsetof(MediumData, albedo), 0},
    {"media[1].phase.width", sizeof(MediumData) + offsetof(MediumData, width), 0},
    {"media[1].region", sizeof(MediumData) + offsetof(MediumData, region), 0},
    {"plane_groups[0]", offsetof(LightStateData, plane_groups), 0},
    {"count_at_camera", offsetof(LightStateData, count_at_camera), 0},
    {"loops_were_cut", offsetof(CountersData, loops_were_cut), 0},
    {"resume_groups[0]", offsetof(CountersData, unfinished), 0}};

}  // namespace

Program& program(Context& context, const std::string& file, int x, int y,
                 std::map<std::string, std::string> definitions) {
  definitions.merge(shared_definitions());
  definitions["LOCAL_SIZE_X"] = std::to_string(x);
  definitions["LOCAL_SIZE_Y"] = std::to_string(y);
  Program& made = context.program("shadow_planes/" + file + ".comp", definitions);
  check_layouts(made, "shadow_planes/" + file + ".comp", layouts);
  return made;
}

}  // namespace airlight::gpu::shadow_planes
