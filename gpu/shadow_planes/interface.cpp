#include "gpu/shadow_planes/interface.h"

#include <fmt/format.h>

#include "methods/shadow_planes/edge_fan.h"

namespace airlight::gpu::planes {

using shadow_planes::EdgeFan;

std::map<std::string, std::string> shared_definitions() {
  std::map<std::string, std::string> definitions = {{"EDGES_PER_GROUP", std::to_string(edges_per_group)},
                                                    {"SECTORS_PER_GROUP", std::to_string(sectors_per_group)},
                                                    {"MOST_HITS", std::to_string(most_hits)},
                                                    {"FAN_LEVELS", std::to_string(EdgeFan::levels)},
                                                    {"FAN_SECTORS", std::to_string(EdgeFan::total_sectors())},
                                                    {"FAN_MARGIN", fmt::format("{:e}LF", EdgeFan::margin)},
                                                    {"FAN_LEAST_ACROSS", fmt::format("{:e}LF", EdgeFan::least_across)}};
  const std::pair<const char*, int> bindings[] = {{"EDGES", at::edges},
                                                  {"PRIMITIVES", at::primitives},
                                                  {"STARTS", at::starts},
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
                                                  {"MEAN_LAYER", at::mean_layer},
                                                  {"CASES", at::cases},
                                                  {"INTEGRALS", at::integrals}};
  for (const auto& [name, number] : bindings) definitions[std::string("AT_") + name] = std::to_string(number);
  return definitions;
}

Program& program(Context& context, const std::string& file, int x, int y,
                 std::map<std::string, std::string> definitions) {
  definitions.merge(shared_definitions());
  definitions["LOCAL_SIZE_X"] = std::to_string(x);
  definitions["LOCAL_SIZE_Y"] = std::to_string(y);
  return context.program("shadow_planes/" + file + ".comp", definitions);
}

}  // namespace airlight::gpu::planes
