#include "gpu/half_resolution_march/interface.h"

#include <cstddef>

#include "gpu/interface.h"
#include "gpu/ray_marcher/interface.h"

namespace airlight::gpu::half_resolution_march {
namespace {

const std::vector<Binding> bindings = {
    {"BLOCKS", at::blocks}, {"LOW", at::low}, {"LAST", at::last}, {"BLURRED", at::blurred}};

const std::vector<Layout> layouts = {
    {"history_used", offsetof(BlocksHead, history_used), 0},
    {"blocks[0].film[0]", sizeof(BlocksHead), sizeof(BlockData)},
    {"blocks[0].t_end", sizeof(BlocksHead) + offsetof(BlockData, t_end), sizeof(BlockData)},
    {"blocks[0].distance_", sizeof(BlocksHead) + offsetof(BlockData, distance), sizeof(BlockData)},
    {"low[0].depth", offsetof(LowPixelData, depth), sizeof(LowPixelData)}};

}  // namespace

Program& program(Context& context, const std::string& file, std::map<std::string, std::string> definitions) {
  define(bindings, definitions);
  Program& made = ray_marcher::program(context, "half_resolution_march/" + file, std::move(definitions));
  check_layouts(made, file, layouts);
  return made;
}

}  // namespace airlight::gpu::half_resolution_march
