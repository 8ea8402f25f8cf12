// Requests to `airlight serve`: bad ones, from elsewhere, from many clients.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <random>
#include <thread>

#include "experiments/application/machine.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/served.h"
#include "tests/experiments/serving.h"

namespace serve_server_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::experiments;
using namespace airlight::experiments::serve;
using Catch::Contains;

TEST_CASE("Serve: requests from elsewhere are refused", "[experiments][serve]") {
  Served served({"127.0.0.1", 0, "secret"});
  const std::string body = body_of(request_of("ray_marcher", 8, 8)).dump();
  const httplib::Headers token{{"X-Airlight-Token", "secret"}};
  const auto with = [&](const std::string& name, const std::string& value) {
    httplib::Headers all = token;
    all.emplace(name, value);
    return all;
  };
  const std::string port = std::to_string(served.server.port());
  CHECK(served.status("/api/frame", body, token) == 200);
  CHECK(served.status("/api/frame", body) == 403);
  CHECK(served.status("/api/frame", body, {{"X-Airlight-Token", "secreu"}}) == 403);
  CHECK(served.status("/api/frame", body, with("Host", "evil.example")) == 403);
  CHECK(served.status("/api/frame", body, with("Host", "localhost:8000")) == 200);  // ssh -L
  CHECK(served.status("/api/frame", body, with("Origin", "http://evil.example")) == 403);
  CHECK(served.status("/api/frame", body, with("Origin", "null")) == 403);
  CHECK(served.status("/api/frame", body, with("Origin", "http://127.0.0.1:" + port)) == 200);
  CHECK(served.client.Post("/api/frame", token, body, "text/plain")->status == 400);
  CHECK(served.status("/api/frame", std::string(70000, ' '), token) == 413);
  CHECK(served.client.Get("/api/frame")->status == 404);
  for (const char* path :
       {"/../README.md", "/page/../../README.md", "/%2e%2e/README.md", "/etc/passwd", "/stage.jsx", "/stageXjs"})
    CHECK(served.client.Get(path)->status == 404);
  for (const char* path : {"/", "/page.js", "/style.css", "/pixels.js"}) {
    const auto page = served.client.Get(path);
    CHECK(page->status == 200);
    CHECK_THAT(page->get_header_value("Content-Security-Policy"), Contains("default-src 'none'"));
    CHECK(page->body.find("//cdn") == std::string::npos);
  }
  CHECK(served.client.Get("/", {{"Host", "evil.example"}})->status == 403);
}

TEST_CASE("Serve: requests are checked strictly", "[experiments][serve]") {
  const json good = body_of(request_of("ray_marcher"));
  const auto message = [&](const char* key, const json& value) {
    json changed = good;
    changed[key] = value;
    return message_of([&] { read_frame_request(changed.dump(), 1); });
  };
  CHECK(message_of([&] { read_frame_request(good.dump(), 1); }).empty());
  CHECK_THAT(message("widht", 8), Contains("unknown key 'widht' (nearest: width)"));
  CHECK_THAT(message("width", 7), Contains("8 to 2048"));
  CHECK_THAT(message("width", 8.5), Contains("integer"));
  CHECK_THAT(message("width", 18446744073709551615u), Contains("integer"));
  CHECK_THAT(message("scene", 1), Contains("0 to 0"));
  CHECK_THAT(message("scene", -1), Contains("0 to 0"));
  CHECK_THAT(message("client", "../x"), Contains("letters or digits"));
  CHECK_THAT(message("pane", "middle"), Contains("left, right"));
  CHECK_THAT(message("layer", "se"), Contains("one of"));
  CHECK_THAT(message("settings", 1), Contains("an object"));
  CHECK_THAT(message("settings", {{"steps", json::array()}}), Contains("numbers"));
  CHECK_THAT(message("values", {{"medium.0.file", "x"}}), Contains("cannot be changed"));
  CHECK_THAT(message("values", {{"light.0.position", "x"}}), Contains("numbers"));
  CHECK_THAT(message("values", {{"light.0.position", {1, 2}}}), Contains("three numbers"));
  CHECK_THAT(message("values", {{"medium.0.phase", {{"type", "x\""}}}}), Contains("hg"));
  CHECK_THAT(message("values", {{"medium.0.phase", {{"file", 1}}}}), Contains("expected type"));
  CHECK_THAT(message_of([&] { read_frame_request("{\"client\": \"a\", \"client\": \"b\"}", 1); }), Contains("twice"));
  CHECK_THAT(message_of([&] { read_frame_request(std::string(1000, '['), 1); }), Contains("levels"));
  CHECK_THAT(message_of([&] { read_frame_request("[]", 1); }), Contains("an object"));
}

TEST_CASE("Serve: ten thousand mutated requests get an answer of one line or a picture", "[experiments][serve][slow]") {
  Served served;
  FrameRequest request = request_of("ray_marcher", 8, 8);
  request.settings = {{"steps", "4"}};
  json frame = body_of(request);
  frame["values"] = {{"light.0.position", {1, 2, 1}}, {"medium.0.phase", {{"type", "hg"}, {"g", 0.5}}}};
  json scene{{"client", "c"}, {"scene", 0}, {"values", {{"camera.position", {0, 0, 5}}}}};
  json reference = scene;
  reference.update({{"width", 8}, {"height", 8}, {"orders", "all"}, {"known", -1}});
  const std::vector<std::pair<std::string, std::string>> seeds{
      {"/api/frame", frame.dump()},
      {"/api/scene", scene.dump()},
      {"/api/text", scene.dump()},
      {"/api/reference", reference.dump()},
      {"/api/leave", "{\"client\":\"d\"}"},  // what "c" asks for after it left would be dropped
      {"/api/scenes", "{\"client\":\"c\"}"},
      {"/api/flow", R"({"client":"c","known":3,"order":"play","pace":0.5})"},
      {"/api/stir", R"({"client":"c","from":[0,0,0],"to":[0,1,0.5],"radius":0.2,"speed":1})"}};
  const std::string pieces = "{}[]\",:0123456789eE+-.\\ntruefalsu\x01\xff ";
  std::mt19937 random(7);
  std::map<int, int> statuses;
  for (int i = 0; i < 10000; ++i) {
    auto [path, body] = seeds[random() % seeds.size()];
    for (unsigned n = 1 + random() % 3; n > 0 && !body.empty(); --n) {
      const std::size_t at = random() % body.size();
      switch (random() % 4) {
        case 0:
          body[at] = pieces[random() % pieces.size()];
          break;
        case 1:
          body.erase(at, 1 + random() % 8);
          break;
        case 2:
          body.insert(at, 1 + random() % 3, pieces[random() % pieces.size()]);
          break;
        default:
          body.insert(at, body.substr(random() % body.size(), random() % 12));
      }
    }
    INFO(path << " " << body);
    ++statuses[served.status(path, body)];
  }
  CHECK(statuses[200] + statuses[400] == 10000);
  CHECK(statuses[400] > 5000);
  CHECK(statuses[200] > 100);
  CHECK(served.status("/api/frame", frame.dump()) == 200);
}

TEST_CASE("Serve: fifty clients share the queue", "[experiments][serve]") {
  Served served;
  std::atomic<int> pictures{0};
  std::vector<std::thread> clients;
  for (int i = 0; i < 50; ++i)
    clients.emplace_back([&, i] {
      httplib::Client client("127.0.0.1", served.server.port());
      client.set_read_timeout(60);
      FrameRequest request = request_of("ray_marcher", 16, 12);
      request.client = fmt::format("client-{}", i);
      for (const char* pane : {"left", "right"}) {
        request.pane = pane;
        const auto result = client.Post("/api/frame", body_of(request).dump(), "application/json");
        // Assertions belong to the main thread.
        if (result && result->status == 200 && result->body.size() > 6 * 16 * 12) ++pictures;
      }
    });
  for (std::thread& client : clients) client.join();
  CHECK(pictures == 100);
}

TEST_CASE("Serve: memory stays flat over two thousand frames", "[experiments][serve][slow]") {
  Served served;
  json body = body_of(request_of("ray_marcher", 32, 24));
  const auto frames = [&](int count) {
    for (int i = 0; i < count; ++i) {
      body["values"] = {{"light.0.position", {1.5 + 1e-3 * i, 2, 1}}};
      REQUIRE(served.status("/api/frame", body.dump()) == 200);
    }
  };
  frames(200);
  const double before = resident_gib();
  frames(2000);
  CHECK(resident_gib() - before < 0.02);
}

TEST_CASE("Serve: Ctrl-C ends the program, a port that is taken is told", "[experiments][serve]") {
  SmallProject project(box_of_fog(24, 18));
  const std::string scene = "'" + project.file("experiments/scenes/one.toml") + "'";
  const Result ended = run_command(
      "{ '" + program + "' serve " + scene + " --port 0 & p=$!; sleep 2; kill -INT $p; wait $p; echo code $?; }",
      project);
  CHECK_THAT(ended.out, Contains("http://127.0.0.1:") && Contains("code 0"));
  CHECK(ended.err.empty());
  CHECK_THAT(run("serve nowhere.toml", project).err, Contains("nowhere.toml"));
  Served served;
  const Result taken = run(fmt::format("serve {} --port {}", scene, served.server.port()), project);
  CHECK(taken.code == 2);
  CHECK_THAT(taken.err, Contains("cannot listen there"));
}

}  // namespace serve_server_test
