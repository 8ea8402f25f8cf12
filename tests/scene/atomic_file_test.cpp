#include "scene/base/atomic_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <thread>

#include "scene/base/content_store.h"
#include "tests/temporary_folder.h"

namespace atomic_file_test {

using namespace airlight;
using namespace airlight::scene;
using Catch::Contains;
namespace fs = std::filesystem;

TEST_CASE("what a link leads to stays as it was", "[atomic_file]") {
  const TemporaryFolder folder;
  folder.write("victim", "mine");
  folder.write("other/inside", "mine");
  const std::string link = folder.file("link");
  for (const std::string target : {"victim", "missing", "other", "/dev/null", "link"}) {
    CAPTURE(target);
    fs::remove(link);
    fs::create_symlink(target, link);
    write_file_atomically(link, "new");
    CHECK(fs::is_regular_file(fs::symlink_status(link)));
    CHECK(read_bytes(link) == "new");
    CHECK(read_bytes(folder.file("victim")) == "mine");
    CHECK_FALSE(fs::exists(folder.path() / "missing"));
    CHECK(read_bytes(folder.file("other/inside")) == "mine");
  }
  CHECK(folder.entries() == 3);
}

TEST_CASE("a folder that is reached by a link is written into", "[atomic_file]") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "there");
  fs::create_symlink("there", folder.path() / "link");
  write_file_atomically(folder.file("link/a"), "new");
  CHECK(read_bytes(folder.file("there/a")) == "new");
}

// The system's own links are how /dev/stdout is written.
TEST_CASE("a pipe is written through the link that the system made for it", "[atomic_file]") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  for (const std::string in : {"/proc/self/fd/", "/dev/fd/"}) {
    write_file_atomically(in + std::to_string(ends[1]), "new");
    char bytes[3];
    REQUIRE(read(ends[0], bytes, 3) == 3);
    CHECK(std::string(bytes, 3) == "new");
  }
  close(ends[0]);
  close(ends[1]);
  CHECK_NOTHROW(write_file_atomically("/dev/null", "new"));
}

TEST_CASE("a pipe that nobody reads from is no place to wait", "[atomic_file]") {
  const TemporaryFolder folder;
  REQUIRE(mkfifo(folder.file("pipe").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(write_file_atomically(folder.file("pipe"), "new"),
                    Contains("pipe: cannot write: found a pipe that nobody reads from"));
  // Its reader may come late, and be slow.
  const std::string bytes(200'000, 'x');
  std::string read;
  std::thread reader([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    std::ifstream in(folder.file("pipe"), std::ios::binary);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    read.assign(std::istreambuf_iterator<char>(in), {});
  });
  write_file_atomically(folder.file("pipe"), bytes);
  reader.join();
  CHECK(read == bytes);
}

TEST_CASE("what is kept is for the user alone", "[atomic_file][content_store]") {
  const TemporaryFolder folder;
  const mode_t before = umask(0);
  const ContentStore store(folder.path() / "above" / "store");
  store.keep("kind/deeper/entry", [](const fs::path& file) { write_file_atomically(file.string(), "content"); });
  umask(before);
  const auto permissions = [&](const std::string& name) { return int(fs::status(folder.path() / name).permissions()); };
  CHECK(permissions("above") == 0777);  // as any folder
  for (const std::string name : {"above/store", "above/store/kind", "above/store/kind/deeper"}) {
    CAPTURE(name);
    CHECK(permissions(name) == 0700);
  }
  // A folder that was there keeps what the user gave it.
  fs::permissions(folder.path() / "above/store", fs::perms(0755));
  make_private_folder(folder.path() / "above/store");
  CHECK(permissions("above/store") == 0755);
  folder.write("file", "");
  CHECK_THROWS_WITH(make_private_folder(folder.path() / "file"), Contains("file: cannot make this folder"));
  CHECK_THROWS_WITH(make_private_folder(folder.path() / "file", "below"),
                    Contains("file/below: cannot make this folder"));
}

// Somebody else who may write into the store puts a link where an entry or its checksum will be.
TEST_CASE("a store does not write through links", "[atomic_file][content_store]") {
  const TemporaryFolder folder;
  folder.write("victim", "mine");
  fs::create_directory(folder.path() / "store");
  const ContentStore store(folder.path() / "store");
  for (const std::string& name :
       std::vector<std::string>{"entry.exr", "entry.exr.xxh128", "entry." + std::to_string(getpid()) + ".part.exr"})
    fs::create_symlink("../victim", folder.path() / "store" / name);
  store.keep("entry.exr", [](const fs::path& file) { write_file_atomically(file.string(), "content"); });
  CHECK(read_bytes(folder.file("victim")) == "mine");
  REQUIRE(store.find("entry.exr"));
  CHECK(read_bytes(store.find("entry.exr")->string()) == "content");
}

TEST_CASE("an entry of a store stands for no other", "[atomic_file][content_store]") {
  const TemporaryFolder folder;
  std::vector<std::string> said;
  const ContentStore store(folder.path(), [&](const std::string& line) { said.push_back(line); });
  for (const std::string name : {"a/one", "a/two"})
    store.keep(name, [&](const fs::path& file) { write_file_atomically(file.string(), name); });
  CHECK(store.find("a/one"));
  CHECK(store.find("a/two"));
  CHECK(said.empty());
  for (const std::string end : {"", ".xxh128"})
    fs::rename(folder.path() / ("a/two" + end), folder.path() / ("a/one" + end));
  CHECK_FALSE(store.find("a/one"));
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Contains(folder.file("a/one") + ": its checksum names another entry, computing it anew"));
}

// In place of an entry or its checksum: a folder, a pipe that nobody writes to, a device without an end.
TEST_CASE("an entry of a store that is no file is made anew", "[atomic_file][content_store]") {
  const TemporaryFolder folder;
  std::vector<std::string> said;
  const ContentStore store(folder.path(), [&](const std::string& line) { said.push_back(line); });
  const auto keep = [&] {
    store.keep("entry", [](const fs::path& file) { write_file_atomically(file.string(), "content"); });
  };
  for (const std::string name : {"entry", "entry.xxh128"})
    for (const std::string kind : {"folder", "pipe", "device", "empty"}) {
      CAPTURE(name, kind);
      said.clear();
      keep();
      REQUIRE(store.find("entry"));
      fs::remove(folder.path() / name);
      if (kind == "folder") fs::create_directory(folder.path() / name);
      if (kind == "pipe") REQUIRE(mkfifo(folder.file(name).c_str(), 0600) == 0);
      if (kind == "device") fs::create_symlink("/dev/zero", folder.path() / name);
      if (kind == "empty") folder.write(name, "");
      CHECK_FALSE(store.find("entry"));
      REQUIRE(said.size() == 1);
      CHECK_THAT(said[0], Contains(folder.file(name)) && Contains("computing it anew"));
      if (kind == "folder") {
        CHECK_THROWS_AS(keep(), CannotWrite);
        fs::remove(folder.path() / name);
      } else if (kind == "pipe" && name != "entry") {
        fs::remove(folder.path() / name);  // a user's own pipe is written into
      }
    }
}

}  // namespace atomic_file_test
