// Ctrl-C, SIGTERM and SIGHUP as a flag: work in progress stops at its next check and keeps what is done. A second signal ends
// the program at once.
#pragma once
#include <string>

#include "scene/renderer.h"

namespace airlight::experiments {

void catch_interrupts();
bool interrupted();  // by a signal, by stop_with, or because the time that --limit allows is over

// Ends work in progress like a signal, for a reason that is then told instead (exit code 2). From any thread; the first reason counts.
void stop_with(const std::string& reason);
std::string stopped_by();  // empty: by a signal, or not at all

// Throws scene::Interrupted if a signal came or the time that --limit allows is over, Error if stop_with was called.
void check_interrupted();

// Asks for an orderly end by SIGUSR1, as batch systems send it before the time of a task is over: rows_end() is true from then on.
void catch_end_of_rows();
bool rows_end();

// Settings for a render that only watches for signals.
scene::Execution quiet_execution(int threads);

}  // namespace airlight::experiments
