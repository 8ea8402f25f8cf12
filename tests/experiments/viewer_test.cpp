// `airlight render --display`: what a viewer that speaks tev's protocol receives, and what happens when it goes away.
#include "experiments/cli/viewer.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <thread>

#include "scene/film/film.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"

namespace viewer_test {

using namespace airlight;
using namespace airlight::test;
using Catch::Contains;

// Listens on a free port of this machine, takes one connection, and reads until its end, or so many bytes.
class Listener {
 public:
  explicit Listener(std::size_t most = std::size_t(-1)) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    REQUIRE(bind(socket_, reinterpret_cast<sockaddr*>(&address), size) == 0);
    REQUIRE(listen(socket_, 1) == 0);
    REQUIRE(getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, most] {
      const int from = accept(socket_, nullptr, nullptr);
      char block[4096];
      while (text_.size() < most) {
        const ssize_t n = read(from, block, sizeof block);
        if (n <= 0) break;
        text_.append(block, std::size_t(n));
      }
      close(from);
    });
  }
  ~Listener() {
    shutdown(socket_, SHUT_RDWR);
    if (thread_.joinable()) thread_.join();
    close(socket_);
  }
  std::string where() const { return "127.0.0.1:" + std::to_string(port_); }
  std::string all() {
    thread_.join();
    return text_;
  }

 private:
  int socket_, port_ = 0;
  std::string text_;
  std::thread thread_;
};

// Takes a message apart from its front; throws where it is shorter than it says.
class Reader {
 public:
  explicit Reader(std::string text) : text_(std::move(text)) {}
  bool end() const { return at_ == text_.size(); }
  template <class T>
  T number() {
    T value;
    std::memcpy(&value, text_.substr(at_).c_str(), sizeof value);
    at_ += sizeof value;
    REQUIRE(at_ <= text_.size());
    return value;
  }
  std::string word() {
    const std::string result = text_.c_str() + at_;
    at_ += result.size() + 1;
    REQUIRE(at_ <= text_.size());
    return result;
  }

 private:
  std::string text_;
  std::size_t at_ = 0;
};

struct Shown {
  std::string title;
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::map<std::string, std::vector<std::vector<float>>> pictures;  // by channel, in order of time
};

Shown read_messages(const std::string& text) {
  Shown shown;
  Reader in(text);
  while (!in.end()) {
    in.number<std::uint32_t>();
    const char kind = in.number<char>(), front = in.number<char>();
    const std::string title = in.word();
    if (kind == 4) {
      CHECK(front == 1);
      shown.title = title;
      shown.width = in.number<std::int32_t>();
      shown.height = in.number<std::int32_t>();
      shown.channels.resize(std::size_t(in.number<std::int32_t>()));
      for (std::string& name : shown.channels) name = in.word();
    } else {
      REQUIRE(int(kind) == 3);
      CHECK(front == 0);
      CHECK(title == shown.title);
      const std::string channel = in.word();
      CHECK(in.number<std::int32_t>() == 0);
      CHECK(in.number<std::int32_t>() == 0);
      const int w = in.number<std::int32_t>(), h = in.number<std::int32_t>();
      std::vector<float> values(std::size_t(w) * h);
      for (float& v : values) v = in.number<float>();
      shown.pictures[channel].push_back(values);
    }
  }
  return shown;
}

std::vector<float> plane(const scene::Film& film, const std::string& layer, int c) {
  std::vector<float> result(film.pixels());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = film.layer(layer)[3 * i + c];
  return result;
}

TEST_CASE("a viewer shows a picture with all its layers", "[cli]") {
  const TemporaryFolder folder;
  folder.write("fog.toml", box_of_fog(8, 6));
  Listener listener;
  const Result done =
      run("render fog.toml -m ray_marcher --set steps=16 -o fog.exr --display " + listener.where(), folder);
  CAPTURE(done.err);
  REQUIRE(done.code == 0);
  const scene::Film film = scene::read_exr(folder.file("fog.exr"));
  const Shown shown = read_messages(listener.all());
  CHECK(shown.title == "fog.exr");
  CHECK(shown.width == 8);
  CHECK(shown.height == 6);
  CHECK(shown.channels.size() == 3 * film.layers.size());
  for (const auto& [layer, values] : film.layers)
    for (int c = 0; c < 3; ++c) {
      const std::string name = (layer == "mean" ? "" : layer + ".") + "RGB"[c];
      CAPTURE(name);
      REQUIRE(shown.pictures.count(name) == 1);
      CHECK(shown.pictures.at(name).size() == 1);
      CHECK(shown.pictures.at(name).back() == plane(film, layer, c));
    }
}

TEST_CASE("a viewer sees samples come, and changes no bit of the picture", "[cli]") {
  const TemporaryFolder folder;
  folder.write("fog.toml", box_of_fog(8, 6));
  const std::string tracer = "render fog.toml -m path_tracer --samples 300 --threads 2 ";
  REQUIRE(run(tracer + "-o alone.exr", folder).code == 0);
  const scene::Film alone = scene::read_exr(folder.file("alone.exr"));
  Listener listener;
  REQUIRE(run(tracer + "-o shown.exr --display " + listener.where(), folder).code == 0);
  scene::Film film = scene::read_exr(folder.file("shown.exr"));
  CHECK(film.layers == alone.layers);
  scene::Film same = alone;
  for (const char* time : {"seconds"}) film.metadata[time] = same.metadata[time] = "";
  CHECK(film.metadata == same.metadata);
  const auto pictures = read_messages(listener.all()).pictures.at("G");
  REQUIRE(pictures.size() == 4);  // 64, 128, 256 and 300 samples
  CHECK(pictures.back() == plane(film, "mean", 1));
  const scene::Film half = [&] {
    REQUIRE(run("render fog.toml -m path_tracer --samples 128 -o half.exr", folder).code == 0);
    return scene::read_exr(folder.file("half.exr"));
  }();
  CHECK(pictures[1] == plane(half, "mean", 1));
}

TEST_CASE("a viewer that goes away costs a warning, no viewer costs nothing but a line", "[cli]") {
  const TemporaryFolder folder;
  folder.write("fog.toml", box_of_fog(64, 48));
  {
    Listener listener(1);
    const Result done =
        run("render fog.toml -m path_tracer --samples 1024 -o fog.exr --display " + listener.where(), folder);
    CHECK(done.code == 0);
    CHECK_THAT(done.err, Contains("warning: the viewer at " + listener.where() + " went away"));
    CHECK(scene::read_exr(folder.file("fog.exr")).width == 64);
  }
  const auto refused = [&](const std::string& where, int code, const std::string& words) {
    const Result result = run("render fog.toml -m ray_marcher -o none.exr --display " + where, folder);
    CAPTURE(where, result.err);
    CHECK(result.code == code);
    CHECK(result.error_lines() == 1);
    CHECK_THAT(result.err, Contains(words));
    CHECK_FALSE(std::filesystem::exists(folder.file("none.exr")));
  };
  refused("127.0.0.1:1", 3, "--display 127.0.0.1:1: no viewer answers: Connection refused");
  for (const char* where : {"tev", "127.0.0.1", ":14158", "127.0.0.1:", "127.0.0.1:port", "127.0.0.1:123456"})
    refused(where, 2, "expected HOST:PORT, e.g. 127.0.0.1:14158");
}

}  // namespace viewer_test
