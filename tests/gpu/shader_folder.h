// A shader of a test, beside those of the house, which it may include.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/temporary_folder.h"

namespace airlight::gpu::test {

// While it lives, shaders are read from a folder that holds `text` as test.comp, and the folders of gpu/.
class ShaderFolder {
 public:
  explicit ShaderFolder(const std::string& text) {
    folder_.write("test.comp", text);
    for (const auto& entry : std::filesystem::directory_iterator(AIRLIGHT_SOURCE_DIR "/gpu"))
      if (entry.is_directory())
        std::filesystem::create_directory_symlink(std::filesystem::absolute(entry.path()),
                                                  folder_.path() / entry.path().filename());
    setenv("AIRLIGHT_SHADERS", folder_.path().c_str(), 1);
  }
  ~ShaderFolder() { unsetenv("AIRLIGHT_SHADERS"); }
  ShaderFolder(const ShaderFolder&) = delete;
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
};

}  // namespace airlight::gpu::test
