// The folder of shared data: files that a scene names and that do not lie beside the scene file are looked for there.
#pragma once
#include <string>

namespace airlight::scene {

// The folder last set, else the environment variable AIRLIGHT_DATA, else empty: none.
std::string data_folder();

// Throws Error if there is no such folder. Call before threads start.
void set_data_folder(const std::string& path);

}  // namespace airlight::scene
