#include "experiments/cli/samples.h"

#include <fmt/format.h>

#include <charconv>
#include <sstream>

#include "experiments/application/build_info.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/cli/output.h"
#include "reference/path_tracer/accumulation.h"
#include "reference/path_tracer/stopping.h"
#include "scene/base/error.h"

namespace airlight::experiments::cli {

std::optional<SampleRange> sample_range(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t dots = text.find("..");
  const auto number = [&](const std::string& part) {
    std::uint64_t value = 0;
    const auto [end, code] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (code != std::errc() || end != part.data() + part.size())
      throw Error(fmt::format("--samples '{}': expected N or A..B, whole numbers >= 0", text));
    return value;
  };
  SampleRange range;
  range.explicit_range = dots != std::string::npos;
  if (range.explicit_range) range.begin = number(text.substr(0, dots));
  range.end = number(range.explicit_range ? text.substr(dots + 2) : text);
  if (range.end <= range.begin) throw Error(fmt::format("--samples '{}': expected a range that is not empty", text));
  if (range.begin % 64 != 0)
    throw Error(fmt::format("--samples '{}': found the first sample {}, expected a multiple of 64", text, range.begin));
  return range;
}

scene::Film render_samples(const std::shared_ptr<const scene::Scene>& scene, const scene::Settings& settings,
                           const SampleRange& range, const scene::Execution& execution,
                           const std::string& samples_file) {
  const path_tracer::World world(scene, path_tracer::parse_options(settings));
  const scene::View view = scene::view_of(*scene);
  path_tracer::Accumulation samples = path_tracer::empty_accumulation(world, view);
  const bool whole = path_tracer::render_range(world, view, range.begin, range.end, execution, samples);
  if (!whole && samples.least_samples() == 0) throw scene::Interrupted("interrupted before every pixel had a sample");
  path_tracer::write_range_file(samples_file, samples);
  scene::Film film = path_tracer::to_film(world, view, samples);
  film.metadata["complete"] = whole ? "true" : "false";
  return film;
}

namespace {

bool passes(const path_tracer::World& world, const scene::View& view, const scene::Execution& execution,
            path_tracer::Accumulation& samples, const std::function<void(const scene::Film&)>& show) {
  const std::uint64_t wanted = world.options().samples;
  for (std::uint64_t before = 0, n = std::min(path_tracer::leaf_samples, wanted);;
       before = n, n = std::min(2 * n, wanted)) {
    scene::Execution pass = execution;
    pass.progress = [&](double share) {
      const double done = (double(before) + share * double(n - before)) / double(wanted);
      return !execution.progress || execution.progress(done);
    };
    if (!path_tracer::render_range(world, view, 0, n, pass, samples)) return false;
    if (n == wanted) return true;
    show(path_tracer::to_film(world, view, samples));
  }
}

}  // namespace

scene::Film render_in_passes(const std::shared_ptr<const scene::Scene>& scene, const scene::Settings& settings,
                             const scene::Execution& execution, const std::function<void(const scene::Film&)>& show) {
  const path_tracer::World world(scene, path_tracer::parse_options(settings));
  const scene::View view = scene::view_of(*scene);
  path_tracer::Accumulation samples = path_tracer::empty_accumulation(world, view);
  // Tiles that stop by their error stop where they would without a viewer.
  const bool whole = world.options().target_error > 0 ? path_tracer::render_to_target(world, view, execution, samples)
                                                      : passes(world, view, execution, samples, show);
  if (samples.least_samples() == 0) throw scene::Interrupted("interrupted before every pixel had a sample");
  scene::Film film = path_tracer::to_film(world, view, samples);
  film.metadata["complete"] = whole ? "true" : "false";
  return film;
}

namespace {

struct MergeOptions {
  std::string scene, out;
  std::vector<std::string> parts;
  Pairs overrides;
};

int merge(const MergeOptions& options) {
  require_output(options.out, ".exr");
  const path_tracer::Accumulation samples = path_tracer::merge_range_files(options.parts);
  // The parts say with which settings they were made: "name=value name=value ...".
  Pairs given{{"seed", std::to_string(samples.identity.seed)}, {"stream", std::to_string(samples.identity.stream)}};
  std::istringstream words(samples.identity.settings);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    given[word.substr(0, equals)] = equals == std::string::npos ? "" : word.substr(equals + 1);
  }
  const std::uint64_t least = samples.least_samples();
  if (least > 0) given["samples"] = std::to_string(least);
  const scene::Settings settings(path_tracer::setting_specs(), given, options.parts.front());
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(options.scene, options.overrides));
  const path_tracer::World world(scene, path_tracer::parse_options(settings));
  const scene::View view = scene::view_of(*scene);
  const std::string differs = path_tracer::difference(
      samples.identity, path_tracer::identity_of(*scene, view, path_tracer::parse_options(settings)));
  if (samples.width != view.width || samples.height != view.height)
    throw Error(fmt::format("{}: found a film of {} x {}, expected {} x {}", options.parts.front(), samples.width,
                            samples.height, view.width, view.height));
  if (!differs.empty())
    throw Error(fmt::format("{} and {} do not belong together: {}", options.parts.front(), options.scene, differs));
  scene::Film film = path_tracer::to_film(world, view, samples);
  // As `render` writes them.
  film.metadata["commit"] = commit();
  film.metadata["settings"] = settings.canonical();
  film.metadata["complete"] = film.metadata.at("samples") == std::to_string(least) ? "true" : "false";
  scene::write_exr(options.out, film);
  path_tracer::write_range_file(options.out + ".samples", samples);
  return 0;
}

}  // namespace

void add_merge(Commands& commands) {
  const auto options = std::make_shared<MergeOptions>();
  CLI::App* c = add_command(commands.app, "merge", "join ranges of samples into one picture");
  c->add_option("SCENE", options->scene, "scene file that the parts were rendered from (required)");
  c->add_option("PART", options->parts, "files OUT.samples that `render --samples A..B` wrote (required)");
  c->add_option("--out,-o", options->out, "OpenEXR file to write (required)");
  add_pairs(c, "--override", options->overrides, "the same changes of the scene file as in the render of the parts");
  commands.add_limit(c);
  commands.add_data(c);
  commands.on(c, [options] {
    require(options->scene, "SCENE");
    require(options->out, "--out");
    if (options->parts.empty()) throw Error("PART is missing; see --help");
    return merge(*options);
  });
}

}  // namespace airlight::experiments::cli
