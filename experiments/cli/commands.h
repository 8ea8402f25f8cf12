// The commands of `airlight`. Each function adds one command: its options, and its action, which returns the exit code and throws Error (exit code 2 or 3) or scene::Interrupted (130).
#pragma once

namespace airlight::experiments::cli {

struct Commands;

// Writes the film with its record in the metadata; with --png a preview too. A range of samples A..B also leaves OUT.samples for merging.
// Interrupted, a path tracer keeps the samples it has: the film is written, and the exit code is 130 all the same.
void add_render(Commands&);
// Joins ranges of samples of one picture, whoever computed them, to the bits of a render in one go. Refuses overlaps, gaps, and parts of
// another scene, view, setting, seed or build. Leaves OUT.samples too.
void add_merge(Commands&);
// Exit code 1 if a metric is above its bound, beyond what noise explains, or the images differ.
void add_compare(Commands&);
// One layer of each file as PNG (8-bit sRGB) or PFM (linear floats); an OpenVDB file as a fogmap of its columns; such a file or a medium
// of a scene as a Legendre box.
void add_convert(Commands&);
// Smoke as Gaussians and residuals, frame by frame, into a folder (experiments/application/fit_sequence.h), or goes on with them.
void add_fit(Commands&);
// Writes the frames of a flow problem into a folder (experiments/application/simulation.h), or goes on with them; and pictures of them,
// NAME.0000.png, ..., of a scene.
void add_simulate(Commands&);
// experiment list, run, plot.
void add_experiment(Commands&);
void add_gates(Commands&);
// Figures of the records of finished experiments, for papers and notebooks (experiments/driver/export.h).
void add_results(Commands&);
// Which renderers can render a scene; with --method or --verbose their settings and stages.
void add_explain(Commands&);
// What a file holds: sizes, ranges and units.
void add_info(Commands&);
// Tries what can render a scene, and ranks it within a time or an error (experiments/choosing).
void add_choose(Commands&);
// Shows two methods and the reference in a browser, while they run (experiments/serve).
void add_serve(Commands&);
// Runs a script of authoring operations (methods/fogshop/README.md) and writes the scene and its tables of Gaussians.
void add_author(Commands&);
void add_verify(Commands&);
void add_doctor(Commands&);
// The program's own commands and options, as a script for a shell and as manual pages.
void add_completion(Commands&);
void add_man(Commands&);

}  // namespace airlight::experiments::cli
