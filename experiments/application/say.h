// A line on standard error. All that the program says there goes through here, but for the progress on a terminal.
#pragma once
#include <string>

namespace airlight::experiments {

// "airlight: LINE", as one line whatever the text holds: file names, values and messages of libraries are quoted in it.
// Of more than 1000 bytes the middle is left out. Where standard error cannot be written, the line is lost; nothing is
// thrown.
void say(const std::string& line);

}  // namespace airlight::experiments
