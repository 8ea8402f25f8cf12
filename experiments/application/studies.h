// Measurements of what is no picture (probes), and verify. They are a third of what is compiled for experiments, and the headline run needs
// none of them. So the program `airlight` leaves them to `airlight_studies` beside it, the same program with them.
#pragma once

namespace airlight::experiments {

// Thrown by all_probes() and verify() in a program without them, before anything is written.
struct NeedsStudies {};

// In the program that was gone on with: throws Error (exit code 3) if it is of another commit than the one before.
void check_commit_of_studies();

// Goes on as `airlight_studies`, with the same arguments. Throws Error (exit code 3) if that program was not built.
[[noreturn]] void go_on_with_studies(char** argv);

}  // namespace airlight::experiments
