// A line on standard error. All that the program says there goes through here, but for the progress on a terminal.
#pragma once
#include <string>

namespace airlight::experiments {

// "airlight: LINE", as one line whatever the text holds: file names, values and messages of libraries are quoted in it.
// A text of more than 1000 bytes is shortened in the middle. If standard error cannot be written, the
// line is lost and nothing is thrown.
void say(const std::string& line);

}  // namespace airlight::experiments
