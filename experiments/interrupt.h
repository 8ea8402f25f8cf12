// Ctrl-C, SIGTERM and SIGHUP as a flag: work in progress stops at its next check and keeps what is done. A second signal ends
// the program at once.
#pragma once
#include "scene/renderer.h"

namespace airlight::experiments {

void catch_interrupts();
bool interrupted();

// Throws scene::Interrupted if a signal came.
void check_interrupted();

// Settings for a render that only watches for signals.
scene::Execution quiet_execution(int threads);

}  // namespace airlight::experiments
