// The scene of a script as files that `airlight render` reads.
#pragma once
#include <string>
#include <vector>

#include "experiments/authoring/script.h"

namespace airlight::experiments::authoring {

struct SceneFiles {
  std::string toml;
  struct Table {
    std::string name;  // of the file, beside the scene
    std::string csv;
    std::size_t gaussians = 0;
  };
  std::vector<Table> tables;  // one per distinct colour, in the order of their first Gaussian
};

// The text of the base scene as it stands (names of files that lie in its folder are changed if `out` is in another
// one), and one medium per distinct colour: media add, and a colour is an albedo. Without a base scene: the view of the
// script. Throws Error if there is neither, or if `out` is the base scene.
SceneFiles scene_files(const Authored&, const std::string& script, const std::string& out);

// The tables first and the scene last, each whole or not at all. Throws Error where the scene could not be read back.
void write(const SceneFiles&, const std::string& out);

// Writes a scene whose other files are there. One that cannot be read is not written: Error, and the files `beside` it are removed.
void write_checked(const std::string& toml, const std::string& out, const std::vector<std::string>& beside);

}  // namespace airlight::experiments::authoring
