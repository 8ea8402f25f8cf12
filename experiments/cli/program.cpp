#include "experiments/cli/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "experiments/application/build_info.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/renderers.h"
#include "experiments/application/say.h"
#include "experiments/application/studies.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/judging/metrics.h"
#include "experiments/verify/verify.h"
#include "gpu/context.h"
#include "gpu/device_choice.h"
#include "scene/base/data_folder.h"
#include "scene/base/error.h"
#include "scene/base/limits.h"
#include "scene/convert/gaussian_fit.h"

namespace airlight::experiments::cli {
namespace {

void require(const std::string& value, const std::string& what) {
  if (value.empty()) throw Error(fmt::format("{} is missing; see --help", what));
}

void check_exposure(double exposure) {
  if (!(std::abs(exposure) <= 100))
    throw Error(fmt::format("--exposure {}: expected a number in [-100, 100]", exposure));
}

const std::string lost_output = "standard output could not be written";

// A standard stream that is closed would be the next file that is opened, and messages would be written into that.
void reserve_standard_streams() {
  for (const int stream : {0, 1, 2})
    if (::fcntl(stream, F_GETFD) < 0) ::open("/dev/null", O_RDONLY);  // read only: writing still fails
}

int dispatch(int argc, char** argv) {
  CLI::App app{"airlight: fog and smoke in real time, judged against references", "airlight"};
  app.set_version_flag("--version", fmt::format("airlight {} ({})", version(), commit()));
  app.option_defaults()->always_capture_default(false);
  std::string data;
  std::optional<std::string> gpu;
  std::vector<std::string> limits;
  std::function<int()> action;
  const auto command = [&](CLI::App& parent, const std::string& name, const std::string& doc) {
    CLI::App* c = parent.add_subcommand(name, doc);
    c->allow_extras();
    c->fallthrough(false);
    return c;
  };
  const auto data_option = [&](CLI::App* c) {
    c->add_option("--data", data, "folder of large inputs (default: the variable AIRLIGHT_DATA)");
  };
  const auto gpu_option = [&](CLI::App* c) {
    c->add_option("--gpu", gpu,
                  "device: its number, a part of its or its vendor's name, surfaceless, none, or auto, the first that "
                  "works (default: the variable AIRLIGHT_GPU; airlight doctor lists them)")
        ->type_name("WHICH");
  };
  const auto limit_option = [&](CLI::App* c) {
    c->add_option(
         "--limit", limits,
         "memory (2GiB) or time (10min, 90s) that the command may take; more is refused before the work where it can be "
         "estimated (default: the memory of the machine)")
        ->type_name("AMOUNT");
  };
  app.footer("Commands that may use a GPU (render, experiment run, gates, explain, doctor) take --gpu WHICH.");
  app.allow_extras();

  RenderOptions render_options;
  CLI::App* c = command(app, "render", "render a scene with a method or a reference");
  c->add_option("SCENE", render_options.scene, "scene file (scene/README.md)");
  c->add_option("--method,-m", render_options.method, fmt::format("one of {}", fmt::join(renderer_names(), ", ")));
  c->add_option("--out,-o", render_options.out, "OpenEXR file to write");
  c->add_option("--png", render_options.png, "also write an 8-bit preview");
  c->add_option("--exposure", render_options.exposure, "of the preview, in powers of two");
  c->add_flag(
      "--distance", render_options.distance,
      "also write where the rays of pixel centres end, in metres along them, 0 where they do not: layer distance");
  c->add_option("--threads", render_options.threads, "0: all")->check(CLI::Range(0, 4096));
  c->add_option("--samples", render_options.samples, "N, or A..B: a range to be merged (path_tracer)");
  c->add_option("--cache", render_options.cache,
                "folder where samples are kept: goes on where an earlier render stopped (path_tracer)");
  add_pairs(c, "--set", render_options.settings, "a setting of the method (airlight explain lists them)");
  add_pairs(c, "--override", render_options.overrides, "a value of the scene file, e.g. film.width=64");
  limit_option(c);
  data_option(c);
  gpu_option(c);
  c->final_callback([&] {
    action = [&] {
      require(render_options.scene, "SCENE");
      require(render_options.method, "--method");
      require(render_options.out, "--out");
      check_exposure(render_options.exposure);
      return render(render_options);
    };
  });

  MergeOptions merge_options;
  c = command(app, "merge", "join ranges of samples to one picture");
  c->add_option("SCENE", merge_options.scene, "scene file that the parts were rendered from");
  c->add_option("PART", merge_options.parts, "files written by render --samples A..B: OUT.samples");
  c->add_option("--out,-o", merge_options.out, "OpenEXR file to write");
  add_pairs(c, "--override", merge_options.overrides, "a value of the scene file, as for the parts");
  limit_option(c);
  data_option(c);
  c->final_callback([&] {
    action = [&] {
      require(merge_options.scene, "SCENE");
      require(merge_options.out, "--out");
      if (merge_options.parts.empty()) throw Error("PART is missing; see --help");
      return merge(merge_options);
    };
  });

  CompareOptions compare_options;
  c = command(app, "compare", "errors of an image against a reference");
  c->add_option("IMAGE", compare_options.image, "OpenEXR file");
  c->add_option("REFERENCE", compare_options.reference, "OpenEXR file; its batches, if any, say how noisy it is");
  c->add_option("--layer", compare_options.layer, "default mean");
  c->add_option("--metric", compare_options.metrics,
                fmt::format("any of {} (default: all)", fmt::join(metric_names(), ", ")));
  c->add_option("--scene", compare_options.scene, "scene file: leave out pixels that touch a light's ball");
  add_pairs(c, "--override", compare_options.overrides, "a value of the scene file, as for the render");
  add_pairs(c, "--max", compare_options.most, "metric=bound: exit 1 if the error is certainly larger");
  c->add_option("--equal", compare_options.alpha,
                "test for equality but for noise at this rate of false alarms, e.g. 1e-4")
      ->type_name("RATE");
  CLI::App* const comparison = c;
  c->final_callback([&, comparison] {
    action = [&, comparison] {
      if (comparison->count("--equal") && !(compare_options.alpha > 0 && compare_options.alpha < 1))
        throw Error(fmt::format("--equal {}: expected a rate above 0 and below 1", compare_options.alpha));
      require(compare_options.image, "IMAGE");
      require(compare_options.reference, "REFERENCE");
      return compare(compare_options);
    };
  });

  ConvertOptions convert_options;
  c = command(app, "convert", "a layer of OpenEXR files as PNG or PFM, a medium as a fogmap or a Legendre box");
  c->add_option(
      "FILES", convert_options.files,
      "IN OUT: OpenEXR file, and .png (8-bit sRGB) or .pfm (linear floats); or OpenVDB file, and .exr: the map of its "
      "columns, whose [[medium]] and errors are printed; or OpenVDB file or scene, and .csv: a medium as a Legendre box, likewise; "
      "more pairs may follow");
  c->add_option("--layer", convert_options.layer, "default mean");
  c->add_option("--exposure", convert_options.exposure, "of a PNG, in powers of two");
  c->add_option("--depth-scale", convert_options.depth_scale,
                "METRES: the PNG is grey, 16 bits, and so many are white: the depth of a [backdrop] (layer distance)");
  c->add_option("--grid", convert_options.grid, "of an OpenVDB file (density)");
  c->add_option("--pixels", convert_options.pixels, "of a map, along its longer side (64)")->check(CLI::Range(1, 8192));
  c->add_option("--samples", convert_options.samples, "squared: upright rays a pixel (2)")->check(CLI::Range(1, 64));
  c->add_option("--degree", convert_options.degree, "of a map's splines (1)")->check(CLI::Range(0, 3));
  c->add_option("--medium", convert_options.medium, "of a scene: name or number (0)");
  c->add_option("--coefficients", convert_options.coefficients, "of a Legendre box: N, or NX,NY,NZ (12)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, 32));
  c->add_option("--cells", convert_options.cells, "along an axis, that its projection integrates over (24)")
      ->check(CLI::Range(1, 48));
  c->add_flag("--no-lanczos", convert_options.no_lanczos, "do not damp the waves that a jump leaves");
  c->add_flag("--no-limiter", convert_options.no_limiter, "do not draw it towards its mean until it is positive");
  limit_option(c);
  c->final_callback([&] {
    action = [&] {
      require(convert_options.files.empty() ? "" : convert_options.files.front(), "IN");
      require(convert_options.files.size() % 2 == 0 ? convert_options.files.back() : "", "OUT");
      check_exposure(convert_options.exposure);
      return convert(convert_options);
    };
  });

  FitCommand fit_options;
  c = command(app, "fit", "smoke as sums of Gaussians and small residuals: a frame, or a sequence of them");
  c->add_option(
      "FILES", fit_options.files,
      "OpenVDB files in the order of time, or scenes with a medium that is a grid; the results of FILE are called after it");
  c->add_option("--out,-o", fit_options.out, "folder; what an earlier run left there is gone on with");
  c->add_option("--gaussians,-n", fit_options.gaussians, "of the first frame (1000)");
  c->add_option("--grid", fit_options.grid, "of an OpenVDB file (density)");
  c->add_option("--medium", fit_options.medium, "of a scene: name or number (0)");
  c->add_option(
      "--unit", fit_options.unit,
      "METRES: of widths, which are 0.015 to 0.09 of it (default: the cube root of the volume of the box that all frames fill)");
  c->add_option("--delete", fit_options.deleted, "so many of the least significant before each later frame (3)");
  c->add_option("--insert", fit_options.inserted, "at most so many into each later frame that needs them (8)");
  c->add_option("--allowed", fit_options.allowed,
                "a later frame needs more where its squared error is this many times that of the first (1.1)");
  c->add_flag("--keep", fit_options.keep,
              "send none to another place in later frames, as the publication: fewer new ones, greater errors");
  c->add_option("--threshold", fit_options.threshold, "residual: levels of this size or less are dropped (0)")
      ->check(CLI::Range(0, 126));
  c->add_option("--method,-m", fit_options.method,
                fmt::format("one of {}", fmt::join(scene::fit_method_names(), ", ")));
  c->add_option("--threads", fit_options.threads, "0: all")->check(CLI::Range(0, 4096));
  limit_option(c);
  data_option(c);
  c->final_callback([&] {
    action = [&] {
      require(fit_options.files.empty() ? "" : fit_options.files.front(), "FILES");
      require(fit_options.out, "--out");
      return fit(fit_options);
    };
  });

  SimulateOptions simulate_options;
  c = command(app, "simulate", "solve a flow problem: frames as OpenVDB files, and their history");
  c->add_option("PROBLEM", simulate_options.problem, "file with a [flow]");
  c->add_option("--method,-m", simulate_options.method, "stable_fluids (default)");
  c->add_option("--out,-o", simulate_options.out, "folder; what an earlier run left there is gone on with");
  add_pairs(c, "--set", simulate_options.settings, "a setting of the method");
  add_pairs(c, "--override", simulate_options.overrides, "a value of the problem file");
  c->add_option(
      "--sequence", simulate_options.sequence,
      "instead of PROBLEM and --out: one of experiments/sequences.toml, where it is not there; prints its files");
  c->add_option(
      "--scene", simulate_options.scene,
      "draws each frame: a scene whose first medium that extinguishes becomes the flow's; NAME.0000.png, ...");
  c->add_option(
      "--renderer", simulate_options.renderer,
      "renderer of --scene (default: legendre_fluids for both methods of that name, else ray_marcher); legendre_fluids_gpu draws "
      "flows of that name where they lie, what is below 0 towards the mean");
  add_pairs(c, "--renderer-set", simulate_options.renderer_settings, "a setting of the renderer");
  c->add_option("--exposure", simulate_options.exposure, "of the pictures, in powers of two");
  c->add_option("--profile", simulate_options.profile, "of that sequence: quick (default) or paper");
  c->add_option("--threads", simulate_options.threads, "0: all")->check(CLI::Range(0, 4096));
  limit_option(c);
  data_option(c);
  c->final_callback([&] {
    action = [&] {
      if (simulate_options.sequence.empty()) {
        require(simulate_options.problem, "PROBLEM");
        require(simulate_options.out, "--out");
      } else if (!simulate_options.problem.empty() || !simulate_options.out.empty()) {
        throw Error("--sequence has its own problem and folder: expected neither PROBLEM nor --out");
      }
      check_exposure(simulate_options.exposure);
      if (!simulate_options.sequence.empty() && !simulate_options.scene.empty())
        throw Error("--sequence has no pictures: expected no --scene");
      return simulate(simulate_options);
    };
  });

  ExperimentOptions experiment_options;
  const auto experiment_flags = [&](CLI::App* e) {
    e->add_option("NAME", experiment_options.names, "experiments: group/name, or a whole group (default: all)");
    e->add_option("--root", experiment_options.root,
                  "folder of the project (default: found above the current folder, else above the program)");
    e->add_option("--profile", experiment_options.profile,
                  "quick: small films, a few runs of each row (default); paper: films and runs for publication");
  };
  const auto results_option = [&](CLI::App* e) {
    e->add_option("--results", experiment_options.results,
                  "folder of tables, plots, records and pictures (default: results/ of the project)")
        ->type_name("FOLDER");
  };
  const auto run_flags = [&](CLI::App* e) {
    experiment_flags(e);
    results_option(e);
    e->add_option(
         "--cache", experiment_options.cache,
         "folder of references and simulated smoke, which all runs share (default: results/cache/ of the project)")
        ->type_name("FOLDER");
    e->add_option("--threads", experiment_options.threads, "number of threads (default 0: all)")
        ->check(CLI::Range(0, 4096));
    limit_option(e);
    data_option(e);
    gpu_option(e);
  };
  CLI::App* experiment = command(app, "experiment", "run the experiments behind the tables and plots");
  CLI::App* e = command(*experiment, "list", "list the experiments with their titles");
  experiment_flags(e);
  e->final_callback([&] { action = [&] { return list_experiments(experiment_options); }; });
  e = command(*experiment, "run", "run experiments and write their tables, plots and pictures; exit 1 if a gate fails");
  run_flags(e);
  e->add_flag("--resume", experiment_options.resume,
              "continue an interrupted run: keep the rows that this program finished in this results folder");
  e->add_flag("--fresh-references", experiment_options.fresh_references,
              "first compute the committed references of these experiments anew and replace their films in "
              "experiments/data/references");
  e->final_callback([&] { action = [&] { return run_experiments(experiment_options); }; });
  e = command(*experiment, "plot", "draw the plots of finished experiments again from their data");
  experiment_flags(e);
  results_option(e);
  e->final_callback([&] { action = [&] { return plot_experiments(experiment_options); }; });

  c = command(app, "gates", "check the accuracy bounds (gates) of the experiments; exit 1 if one fails");
  run_flags(c);
  c->add_option("--junit", experiment_options.junit, "also write a JUnit report to this file")->type_name("FILE");
  c->add_flag("--margins", experiment_options.margins,
              "list how many times worse each figure could be before its gate fails, the loosest first");
  c->add_option("--margins-csv", experiment_options.margins_csv, "write those margins to this CSV file")
      ->type_name("FILE");
  c->add_flag(
      "--in-tests", experiment_options.in_tests,
      "only experiments that say in_tests = true, as scripts/test does; without timed runs unless a gate judges a "
      "time, and without tables");
  c->final_callback([&] {
    experiment_options.gates_only = true;
    action = [&] { return gates(experiment_options); };
  });

  ExplainOptions explain_options;
  c = command(app, "explain", "what each renderer would compute or leave out in a scene, and why");
  c->add_option("SCENE", explain_options.scene, "scene file");
  c->add_option("--method,-m", explain_options.method, "only this one");
  add_pairs(c, "--set", explain_options.settings, "a setting of the method");
  add_pairs(c, "--override", explain_options.overrides, "a value of the scene file");
  limit_option(c);
  data_option(c);
  gpu_option(c);
  c->final_callback([&] {
    action = [&] {
      require(explain_options.scene, "SCENE");
      return explain(explain_options);
    };
  });

  AuthorOptions author_options;
  c = command(
      app, "author",
      "make fog by a script: Gaussians (paint, erase, copy, emit, airbrush), or a map of wavelet fog (noise, stroke, "
      "blur, ...)");
  c->add_option("SCRIPT", author_options.script,
                "operations, one JSON object a line (methods/fogshop/README.md; maps: methods/wavelet_fog/README.md)");
  c->add_option("--out,-o", author_options.out,
                "scene file to write; its Gaussians go into CSV beside it, its map into PNG or EXR");
  limit_option(c);
  data_option(c);
  c->final_callback([&] {
    action = [&] {
      require(author_options.script, "SCRIPT");
      require(author_options.out, "--out");
      return author(author_options);
    };
  });

  std::vector<std::string> vector_files;
  std::string kind, verify_profile = "quick";
  c = command(app, "verify", "recompute oracle vectors");
  c->add_option("FILE", vector_files, "JSON files");
  c->add_option("--kind", kind, "only vectors of this kind");
  c->add_option("--profile", verify_profile, "quick (default) or paper");
  c->final_callback([&] {
    action = [&] {
      if (vector_files.empty()) throw Error("FILE is missing; see --help");
      if (verify_profile != "quick" && verify_profile != "paper")
        throw Error(fmt::format("--profile '{}': expected quick or paper", verify_profile));
      return verify(vector_files, kind, verify_profile == "quick" ? VerifyProfile::quick : VerifyProfile::paper,
                    std::cout);
    };
  });

  c = command(app, "doctor", "versions, processor, graphics devices");
  gpu_option(c);
  CLI::App* const examination = c;
  c->final_callback([&] { action = [] { return doctor(); }; });

  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const CLI::CallForVersion& wanted) {
    return app.exit(wanted);
  } catch (const CLI::ParseError& error) {
    throw Error(error.what());
  }
  refuse_extras(app);
  if (!action) throw Error(fmt::format("expected a command: {}", fmt::join(command_names(app), ", ")));
  if (!data.empty()) scene::set_data_folder(data);
  scene::reset_limits();
  for (const std::string& limit : limits) scene::set_limit(limit);
  scene::on_long_work(say);
  if (gpu) {
    gpu::Context::choose_device(*gpu);
    // A device that is not there is told at once, whatever the command would make of it; doctor tells it in its table.
    if (gpu::small_letters(*gpu) != "none" && !examination->parsed()) gpu::Context::get();
  }
  catch_interrupts();
  return action();
}

int dispatch_or_go_on(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const NeedsStudies&) {
    go_on_with_studies(argv);
  }
}

}  // namespace

int run(int argc, char** argv) {
  reserve_standard_streams();
  try {
    check_commit_of_studies();
    const int code = dispatch_or_go_on(argc, argv);
    std::cout.flush();
    if (std::fflush(stdout) != 0 || std::ferror(stdout) || !std::cout) throw Error(lost_output);
    return code;
  } catch (const Error& error) {
    say(error.what());
    return error.exit_code();
  } catch (const scene::Interrupted&) {
    if (const std::string line = stopped_by(); !line.empty()) {
      say(line);
      return 2;
    }
    say("interrupted");
    return 130;
  } catch (const std::filesystem::filesystem_error& error) {
    say(fmt::format("{}: {}", error.path1().string(), error.code().message()));
    return 2;
  } catch (const std::bad_alloc&) {
    say("out of memory");
    return 2;
  } catch (const std::exception& error) {
    // What prints to a stream that fails throws an exception of the system's.
    say(std::ferror(stdout) ? lost_output : fmt::format("unexpected failure: {}", error.what()));
    return 2;
  }
}

}  // namespace airlight::experiments::cli
