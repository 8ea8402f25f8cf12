#include <fmt/format.h>

#include <filesystem>

#include "experiments/application/interrupt.h"
#include "experiments/authoring/fogmap_script.h"
#include "experiments/authoring/write_scene.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "scene/base/error.h"
#include "scene/base/file_ending.h"

namespace airlight::experiments::cli {
namespace {

struct AuthorOptions {
  std::string script, out;
};

int author(const AuthorOptions& options) {
  if (scene::file_ending(options.out) != ".toml") throw Error(fmt::format("{}: expected a name in .toml", options.out));
  if (authoring::draws_fogmap(options.script)) {
    const authoring::DrawnFogmap drawn = authoring::run_fogmap_script(options.script, check_interrupted);
    const std::string map = authoring::write(drawn, options.script, options.out);
    for (const auto& done : drawn.done)
      fmt::print("line {:<4} {:<9} sum {:.6g}, greatest {:.6g}\n", done.line, done.operation, done.sum, done.greatest);
    fmt::print("{}: {} x {} pixels in {}\n", options.out, drawn.canvas.width(), drawn.canvas.height(), map);
    return 0;
  }
  const authoring::Authored authored = authoring::run_script(options.script, check_interrupted);
  const authoring::SceneFiles files = authoring::scene_files(authored, options.script, options.out);
  authoring::write(files, options.out);
  for (const auto& done : authored.done)
    fmt::print("line {:<4} {:<9} {} Gaussians\n", done.line, done.operation, done.touched.size());
  fmt::print("{}: {} Gaussians in {} colour{}\n", options.out, authored.list.all().size(), files.tables.size(),
             files.tables.size() == 1 ? "" : "s");
  return 0;
}

}  // namespace

void add_author(Commands& commands) {
  const auto options = std::make_shared<AuthorOptions>();
  CLI::App* c =
      add_command(commands.app, "author", "make fog by a script of strokes: Gaussians, or a map for wavelet fog");
  c->add_option(
      "SCRIPT", options->script,
      "script (required): one JSON object a line (methods/fogshop/README.md; for maps methods/wavelet_fog/README.md)");
  c->add_option("--out,-o", options->out,
                "scene file to write (required); its Gaussians go into a CSV beside it, its map into a PNG or EXR");
  commands.add_limit(c);
  commands.add_data(c);
  commands.on(c, [options] {
    require(options->script, "SCRIPT");
    require(options->out, "--out");
    return author(*options);
  });
}

}  // namespace airlight::experiments::cli
