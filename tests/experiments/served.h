// A server of its own for a test.
#pragma once
// Eigen first: a header of the system that httplib includes defines _res.
// clang-format off
#include <Eigen/Dense>
#include <httplib.h>
// clang-format on

#include "experiments/serve/server.h"
#include "tests/experiments/small_project.h"
#include "tests/texts.h"

namespace airlight::test {

// A fog of one box, served on a port of its own.
struct Served : SmallProject {
  explicit Served(const experiments::serve::ServerOptions& options = {"127.0.0.1", 0, ""},
                  const std::optional<experiments::serve::FlowChoice>& flow = {})
      : SmallProject(box_of_fog(24, 18)),
        studio({file("experiments/scenes/one.toml")}, 0, flow),
        server(studio, options),
        client("127.0.0.1", server.port()) {
    server.start();
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
    client.set_read_timeout(60);
  }
  httplib::Result post(const std::string& path, const std::string& body, const httplib::Headers& headers = {}) {
    return client.Post(path, headers, body, "application/json");
  }
  int status(const std::string& path, const std::string& body, const httplib::Headers& headers = {}) {
    const auto result = post(path, body, headers);
    REQUIRE(result);
    if (result->status != 200) {
      CHECK(std::count(result->body.begin(), result->body.end(), '\n') == 1);
      CHECK(result->body.size() < 1200);
    }
    return result->status;
  }
  experiments::serve::Studio studio;
  experiments::serve::Server server;
  httplib::Client client;
};

}  // namespace airlight::test
