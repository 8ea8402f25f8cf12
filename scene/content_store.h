// Files that are dear to make, each kept under a name that is the content of all it was made from (content_key.h: inputs,
// settings, sources). A file that is damaged, by its checksum, counts as not there: one line says so, and it is made
// again.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace airlight::scene {

class ContentStore {
 public:
  // The folder is made when something is kept. `say` gets lines about what is damaged.
  explicit ContentStore(std::filesystem::path folder, std::function<void(const std::string&)> say = {})
      : folder_(std::move(folder)), say_(std::move(say)) {}

  const std::filesystem::path& folder() const { return folder_; }
  void say(const std::string& line) const {
    if (say_) say_(line);
  }

  // The file of that name, which may have folders in it; nothing if there is none that is whole.
  std::optional<std::filesystem::path> find(const std::string& name) const;
  // `write` makes a file at the path that it is given, in the same folder; it gets its name when it is whole. Throws
  // Error.
  void keep(const std::string& name, const std::function<void(const std::filesystem::path&)>& write) const;

 private:
  std::filesystem::path folder_;
  std::function<void(const std::string&)> say_;
};

}  // namespace airlight::scene
