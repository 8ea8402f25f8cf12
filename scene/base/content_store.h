// Files that are dear to make, each kept under a name that is the content of all it was made from (content_key.h: inputs,
// settings, sources). NAME.xxh128 beside it has its checksum and its name. A file that is damaged, or another entry that
// was put there, counts as not there: one line says so, and it is made again.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "scene/base/atomic_file.h"

namespace airlight::scene {

class ContentStore {
 public:
  // The folder is made when something is kept. `say` gets lines about what is damaged. `not_kept` gets what could not be
  // written and is not needed to go on; without it, that is thrown.
  explicit ContentStore(std::filesystem::path folder, std::function<void(const std::string&)> say = {},
                        std::function<void(const CannotWrite&)> not_kept = {})
      : folder_(std::move(folder)), say_(std::move(say)), not_kept_(std::move(not_kept)) {}

  const std::filesystem::path& folder() const { return folder_; }
  void say(const std::string& line) const {
    if (say_) say_(line);
  }

  void lost(const CannotWrite& error) const {
    if (!not_kept_) throw CannotWrite(error);
    not_kept_(error);
  }

  // The file of that name, which may have folders in it; nothing if there is none that is whole.
  std::optional<std::filesystem::path> find(const std::string& name) const;
  // `write` makes a file at the path that it is given, in the same folder; it gets its name when it is whole. Throws
  // Error.
  void keep(const std::string& name, const std::function<void(const std::filesystem::path&)>& write) const;

 private:
  std::filesystem::path folder_;
  std::function<void(const std::string&)> say_;
  std::function<void(const CannotWrite&)> not_kept_;
};

}  // namespace airlight::scene
