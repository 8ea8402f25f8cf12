// `airlight serve`: changed scenes are those of --override, pictures those of `render`; bad requests, many clients, clients that leave.
#include <fmt/format.h>
#include <httplib.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstring>
#include <random>
#include <thread>

#include "experiments/application/json.h"
#include "experiments/application/json_value.h"
#include "experiments/application/machine.h"
#include "experiments/application/renderers.h"
#include "experiments/serve/answers.h"
#include "experiments/serve/server.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/small_project.h"
#include "tests/texts.h"

namespace serve_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::experiments;
using namespace airlight::experiments::serve;
using Catch::Contains;
using nlohmann::json;

namespace {

struct Answer {
  json head;
  int width = 0, height = 0;
  std::vector<float> values;
};

float from_half(std::uint16_t h) {
  const int exponent = (h >> 10) & 31, fraction = h & 1023;
  const float size =
      exponent == 0 ? std::ldexp(float(fraction), -24) : std::ldexp(1 + fraction / 1024.0f, exponent - 15);
  return h & 0x8000 ? -size : size;
}

Answer unpacked(const std::string& bytes) {
  std::uint32_t length = 0;
  REQUIRE(bytes.size() >= 4);
  std::memcpy(&length, bytes.data(), 4);
  REQUIRE(length % 2 == 0);
  Answer answer;
  answer.head = parse_json(bytes.substr(4, length), "answer");
  if (!answer.head.contains("width")) return answer;
  answer.width = answer.head["width"];
  answer.height = answer.head["height"];
  for (std::size_t at = 4 + length; at < bytes.size(); at += 2) {
    std::uint16_t half = 0;
    std::memcpy(&half, &bytes[at], 2);
    answer.values.push_back(from_half(half) * answer.head["scale"].get<float>());
  }
  REQUIRE(answer.values.size() == 3u * unsigned(answer.width * answer.height));
  return answer;
}

FrameRequest request_of(const std::string& method, int width = 24, int height = 18) {
  FrameRequest request;
  request.client = "c";
  request.pane = "left";
  request.method = method;
  request.width = width;
  request.height = height;
  return request;
}

json body_of(const FrameRequest& r) {
  return {{"client", r.client}, {"scene", r.scene},   {"values", json::object()},
          {"pane", r.pane},     {"method", r.method}, {"settings", r.settings},
          {"width", r.width},   {"height", r.height}, {"layer", r.layer}};
}

scene::Film rendered(const std::string& file, const FrameRequest& r, const scene::Overrides& more = {}) {
  scene::Overrides all = r.values;
  all.insert(more.begin(), more.end());
  all["film.width"] = std::to_string(r.width);
  all["film.height"] = std::to_string(r.height);
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(file, all));
  const scene::Renderer& renderer = find_renderer(r.method, "test");
  return renderer.prepare(scene, scene::Settings(renderer.settings(), r.settings, "test"), {})
      ->render(scene::view_of(*scene), {})
      .film;
}

// Greatest difference, relative to the greatest value.
double difference(const std::vector<float>& a, const std::vector<float>& b) {
  REQUIRE(a.size() == b.size());
  double most = 0, scale = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(double(a[i]) - b[i]));
    scale = std::max(scale, std::abs(double(b[i])));
  }
  return most / scale;
}

// A fog of one box, served on a port of its own.
struct Served : SmallProject {
  explicit Served(const ServerOptions& options = {"127.0.0.1", 0, ""})
      : SmallProject(box_of_fog(24, 18)),
        studio({file("experiments/scenes/one.toml")}, 0),
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
  Studio studio;
  Server server;
  httplib::Client client;
};

}  // namespace

TEST_CASE("Serve: changed scenes are those of --override", "[experiments][serve]") {
  const std::string common = scenes + "common/";
  struct Case {
    std::string file, path, value;
  };
  for (const auto& [file, path, value] : {Case{"lamp_in_patches.toml", "camera.position", "[0, 5, 4]"},
                                          {"lamp_in_patches.toml", "light.0.position", "[0.5, 1.1, 0.3]"},
                                          {"lamp_in_patches.toml", "medium.0.sigma_t", "[0.5, 1, 2]"},
                                          {"lamp_in_patches.toml", "medium.0.phase", "{ type = \"hg\", g = 0.5 }"},
                                          {"cloud.toml", "light.0.to_light", "[1, 1, 1]"},
                                          {"cloud.toml", "light.0.irradiance", "[1, 2, 3]"},
                                          {"cloud.toml", "medium.0.albedo", "[0.9, 0.5, 0.1]"},
                                          {"hills.toml", "camera.vertical_fov", "0.5"},
                                          {"hills.toml", "medium.0.sigma_t", "0.2"}}) {
    INFO(file << " " << path);
    const SceneSource source(common + file);
    const auto changed = source.with({{path, value}});
    const scene::Scene read = scene::load_scene(common + file, {{path, value}});
    CHECK(changed->hash == read.hash);
    CHECK(changed->light_hash == read.light_hash);
    CHECK(changed->matter_hash == read.matter_hash);
    CHECK(changed->hash != source.with({})->hash);
    CHECK(changed->geometry == source.with({})->geometry);
  }
}

TEST_CASE("Serve: an environment is turned and scaled as by --override", "[experiments][serve]") {
  TemporaryFolder folder;
  folder.write("sky.toml", R"([camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
[[light]]
type = "environment"
sh = [[1, 1, 1], [0.1, 0.2, 0.3], [0.2, 0.1, 0], [0, 0.1, 0.2]]
rotation = { axis = [0, 1, 0], angle = 0.25 }
[[medium]]
type = "homogeneous"
region = { type = "sphere", center = [0, 0, 0], radius = 1 }
)");
  const std::string file = folder.file("sky.toml");
  const SceneSource source(file);
  for (const scene::Overrides& values : {scene::Overrides{{"light.0.rotation", "{ axis = [0, 1, 0], angle = 1.5 }"}},
                                         scene::Overrides{{"light.0.scale", "[2, 1, 1]"}}})
    CHECK(source.with(values)->hash == scene::load_scene(file, values).hash);
  const json described = parse_json(scene_answer(source, *source.with({})), "answer");
  CHECK(described["lights"][0]["turn"].get<double>() == Approx(0.25));
}

TEST_CASE("Serve: frames of a sequence are read as by --override", "[experiments][serve]") {
  TemporaryFolder folder;
  for (const char* name : {"smoke_0001.vdb", "smoke_0012.vdb"})
    std::filesystem::copy_file(root + "/experiments/data/plume_0024.vdb", folder.file(name));
  folder.write("smoke_none.vdb", "");
  folder.write("sequence.toml", R"([camera]
position = [0, 1, 5]
look_at = [0, 1, 0]
[[light]]
type = "directional"
to_light = [2, 2, 1]
irradiance = 12
[[medium]]
type = "grid"
file = "smoke_####.vdb"
frame = 1
sigma_t = 10
)");
  const std::string file = folder.file("sequence.toml");
  const SceneSource source(file);
  CHECK(source.frames(0) == std::pair(1LL, 12LL));
  CHECK(source.frame(0) == 1);
  const scene::Overrides values{{"medium.0.frame", "12"}, {"medium.0.sigma_t", "5"}, {"light.0.irradiance", "3"}};
  CHECK(source.with(values)->hash == scene::load_scene(file, values).hash);
  CHECK_THAT(message_of([&] { source.with({{"medium.0.frame", "7"}}); }), Contains("smoke_0007.vdb"));
  CHECK(!SceneSource(scenes + "common/cloud.toml").frames(0));
}

TEST_CASE("Serve: values that a scene may not have are refused in one line", "[experiments][serve]") {
  const SceneSource source(scenes + "common/lamp_in_patches.toml");
  for (const scene::Overrides& values : {scene::Overrides{{"medium.0.file", "\"/etc/passwd\""}},
                                         {{"light.0.file", "1"}},
                                         {{"light.9.position", "[0, 0, 0]"}},
                                         {{"medium.0.albedo", "2"}},
                                         {{"camera.vertical_fov", "-1"}},
                                         {{"camera.look_at", "[0, 4.5, 4]"}},
                                         {{"surface.0.type", "1"}},
                                         {{"light.*.position", "[0, 0, 0]"}},
                                         {{"camera.position", "[0, 0]"}}})
    CHECK(!message_of([&] { source.with(values); }).empty());
}

TEST_CASE("Serve: the text of a scene reads as the scene that is seen", "[experiments][serve]") {
  TemporaryFolder folder;
  const std::string file = scenes + "common/cloud.toml";
  const SceneSource source(file);
  const scene::Overrides values{{"camera.position", "[1, 1, 5.5]"}, {"medium.0.sigma_t", "[10, 11.5, 12]"}};
  folder.write("copy.toml", source.text(values));
  CHECK(scene::load_scene(folder.file("copy.toml")).hash == source.with(values)->hash);
}

TEST_CASE("Serve: a pane shows what render gives, whatever moved before", "[experiments][serve]") {
  const std::string file = scenes + "common/lamp_in_patches.toml";
  Studio studio({file}, 0);
  for (const char* method : {"fogshop", "froxel_fog", "ray_marcher"}) {
    FrameRequest request = request_of(method);
    for (const scene::Overrides& values : {scene::Overrides{},
                                           {{"light.0.position", "[0.1, 1.3, 0.2]"}},
                                           {{"camera.position", "[1, 4, 4]"}},
                                           {{"medium.0.sigma_t", "0.7"}, {"camera.position", "[1, 4, 4]"}}}) {
      request.values = values;
      INFO(method << " " << (values.empty() ? "" : values.begin()->first));
      const auto frame = studio.frame(request);
      REQUIRE(frame);
      REQUIRE(frame->refused.empty());
      const Answer answer = unpacked(frame_answer(frame, request));
      CHECK(difference(answer.values, rendered(file, request).layer("mean")) < 1e-3);
      CHECK(!frame->stages.empty());
      CHECK(frame->median > 0);
    }
  }
}

TEST_CASE("Serve: what is prepared is kept, moved on, or made anew", "[experiments][serve]") {
  Studio studio({scenes + "common/lamp_in_patches.toml"}, 0);
  FrameRequest request = request_of("fogshop");
  const auto prepared = [&] { return studio.frame(request).value().prepared; };
  CHECK(prepared() == "anew");
  CHECK(prepared() == "kept");
  request.values = {{"light.0.position", "[0.1, 1.3, 0.2]"}};
  CHECK(prepared() == "moved on");
  request.settings = {{"variant", "paper"}};
  CHECK(prepared() == "anew");
  for (int i = 0; i < 40; ++i) CHECK(prepared() == "kept");
  CHECK(studio.frame(request)->median_frames == 30);
}

TEST_CASE("Serve: refusals and bad settings are told", "[experiments][serve]") {
  Studio studio({scenes + "common/lamp_in_patches.toml"}, 0);
  CHECK_THAT(studio.frame(request_of("legendre_fluids"))->refused, Contains("gaussians"));
  CHECK(unpacked(frame_answer(studio.frame(request_of("legendre_fluids")), request_of("legendre_fluids")))
            .head.contains("refused"));
  FrameRequest request = request_of("fogshop");
  request.settings = {{"variant", "none"}};
  CHECK_THAT(message_of([&] { studio.frame(request); }), Contains("variant"));
  CHECK_THAT(message_of([&] { studio.frame(request_of("fogshopp")); }), Contains("nearest: fogshop"));
  request = request_of("fogshop");
  request.layer = "ambient";
  CHECK_THAT(studio.frame(request)->refused, Contains("ambient"));
}

TEST_CASE("Serve: the reference and its errors are those of the experiments", "[experiments][serve]") {
  const std::string file = scenes + "common/lamp_in_patches.toml";
  Studio studio({file}, 0);
  ReferenceRequest wanted;
  wanted.client = "c";
  wanted.width = 24;
  wanted.height = 18;
  const FrameRequest request = request_of("ray_marcher");
  studio.frame(request);
  ReferenceState state;
  for (int i = 0; i < 600 && state.samples < 64; ++i) {
    state = studio.reference(wanted);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  REQUIRE(state.film);
  REQUIRE(state.errors.count("left"));
  const scene::Film marched = rendered(file, request);
  CHECK(state.errors["left"].missing.empty());
  const Measure& live = state.errors["left"].measure;
  const auto scene = scene::load_scene(file, {{"film.width", "24"}, {"film.height", "18"}});
  const Measure ours =
      measure({"rel_l2"}, marched, *state.film, "mean", {scene::ball_mask(scene, scene::view_of(scene)), {}}).front();
  CHECK(live.value == ours.value);
  CHECK(live.low == ours.low);
  CHECK(live.high == ours.high);
  FrameRequest traced = request_of("path_tracer");
  traced.settings = {{"stream", "255"}, {"samples", std::to_string(state.samples)}};
  CHECK(state.film->layer("mean") == rendered(file, traced).layer("mean"));
  // It goes on while nothing else is asked for, and begins anew where the camera moved.
  const auto before = state.samples;
  for (int i = 0; i < 600 && state.samples <= before; ++i) {
    state = studio.reference(wanted);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  CHECK(state.samples > before);
  wanted.values = {{"camera.position", "[1, 4, 4]"}};
  CHECK(studio.reference(wanted).samples == 0);
}

TEST_CASE("Serve: a newer request takes the place of an older one", "[experiments][serve]") {
  Studio studio({scenes + "common/lamp_in_patches.toml"}, 0);
  FrameRequest slow = request_of("path_tracer", 160, 120);
  slow.settings = {{"samples", "1000000"}};
  std::optional<Frame> first = Frame();
  std::thread waiting([&] { first = studio.frame(slow); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto start = std::chrono::steady_clock::now();
  CHECK(studio.frame(request_of("fogshop")).has_value());
  waiting.join();
  CHECK(!first);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
}

TEST_CASE("Serve: a client that leaves has nothing running", "[experiments][serve]") {
  Studio studio({scenes + "common/lamp_in_patches.toml"}, 0);
  FrameRequest slow = request_of("path_tracer", 160, 120);
  slow.settings = {{"samples", "1000000"}};
  std::optional<Frame> frame = Frame();
  std::thread waiting([&] { frame = studio.frame(slow); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  studio.leave("c");
  waiting.join();
  CHECK(!frame);
  const double before = processor_time().run;
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  CHECK(processor_time().run - before < 0.35);
}

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
      {"/api/frame", frame.dump()},         {"/api/scene", scene.dump()},
      {"/api/text", scene.dump()},          {"/api/reference", reference.dump()},
      {"/api/leave", "{\"client\":\"c\"}"}, {"/api/scenes", "{\"client\":\"c\"}"}};
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

}  // namespace serve_test
