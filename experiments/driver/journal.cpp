#include "experiments/driver/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "experiments/application/folders.h"
#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "scene/base/atomic_file.h"
#include "scene/base/content_key.h"
#include "scene/base/error.h"

namespace airlight::experiments {

Journal::Journal(const std::filesystem::path& file, bool resume) : file_(file) {
  std::error_code ignored;
  if (!resume || !std::filesystem::is_regular_file(file, ignored)) return;  // a pipe would be waited for
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::size_t space = line.find(' ');
    if (space != 32 || content_key(std::string_view(line).substr(33)) != line.substr(0, 32)) continue;
    try {
      const Row row = row_from_json(parse_json(line.substr(33), file.string()));
      rows_[row.key] = row;
    } catch (const nlohmann::json::exception&) {
      // A row of another version of the program, with other fields: its key would match nothing either.
    } catch (const Error&) {
      // No row.
    }
  }
}

void Journal::begin_anew() {
  std::error_code failure;
  std::filesystem::remove(file_, failure);
  if (failure) throw scene::CannotWrite(fmt::format("{}: {}", file_.string(), failure.message()));
  rows_.clear();
}

const Row* Journal::find(const std::string& key) const {
  const auto found = rows_.find(key);
  return found == rows_.end() ? nullptr : &found->second;
}

void Journal::add(const Row& row) {
  make_folder(file_.parent_path());
  rows_[row.key] = row;
  const std::string text = to_json(row).dump();
  // A torn line before this one must not swallow it: begin on a new line.
  const std::string line = fmt::format("\n{} {}\n", content_key(std::string_view(text)), text);
  const int handle = open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0644);
  const bool written =
      handle >= 0 && write(handle, line.data(), line.size()) == ssize_t(line.size()) && fsync(handle) == 0;
  const int reason = errno;
  if (handle >= 0) close(handle);
  if (!written) throw scene::CannotWrite(fmt::format("{}: {}", file_.string(), std::strerror(reason)));
}

}  // namespace airlight::experiments
