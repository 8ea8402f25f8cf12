// The machine that a time was measured on.
#pragma once
#include <string>
#include <vector>

namespace airlight::experiments {

struct Machine {
  std::string cpu;          // model name
  int threads = 0;          // that this process may use
  double memory_gib = 0;    // installed
  std::string simd;         // widest of avx512, avx2, sse4.2 that the CPU offers
  std::string system;       // kernel and architecture
  double load_average = 0;  // of the last minute: other work disturbs times
};
Machine this_machine();

// The computer, as a cluster calls it; else its host name.
std::string this_node();

// Processor time that the living threads of this process have used since they began [s]; zeros if the
// system does not say.
struct ProcessorTime {
  double run = 0;
  double waited = 0;  // ready to run, with no processor free: other work, or more threads than processors
};
ProcessorTime processor_time();

double resident_gib();  // memory that this process occupies

std::string utc_now();  // 2026-01-31T12:00:00Z

}  // namespace airlight::experiments
