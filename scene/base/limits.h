// Limits on the time and memory that a command may use. Work that can be large is estimated before it begins. Where the
// estimate is above the limit, a message of one line appears, instead of a machine that swaps or a user who waits.
#pragma once
#include <functional>
#include <string>

namespace airlight::scene {

// "2GiB", "500MiB": memory; "90s", "10min", "2h": of the clock, from now on. By default: the memory of the machine (or of the
// control group), and no end. Throws Error.
void set_limit(const std::string& text);
void reset_limits();
double seconds_allowed();  // infinity without a limit

// Where work without a limit will take more than a minute, it is told here.
void on_long_work(std::function<void(const std::string& line)>);

// Throws Error where these bytes, beside what the process holds now, are more than it may: "WHAT: would take this program to about 6.4 GiB, ...".
void require_memory(double bytes, const std::string& what);
// Throws Error where that is more than is left of the time allowed.
void require_time(double seconds, const std::string& what);
// Whether the time allowed is over; from any thread. And the line that says so.
bool time_is_over();
std::string over_time_text();

}  // namespace airlight::scene
