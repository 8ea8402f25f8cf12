// Running simulations in `airlight serve`: the same flow as without a browser, and nothing that runs unwatched.
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "experiments/application/machine.h"
#include "experiments/application/solvers.h"
#include "experiments/serve/answers.h"
#include "tests/experiments/run_program.h"
#include "tests/experiments/served.h"
#include "tests/experiments/serving.h"

namespace serve_flow_test {

using namespace airlight;
using namespace airlight::test;
using namespace airlight::experiments;
using namespace airlight::experiments::serve;
using namespace std::chrono_literals;
using Catch::Contains;

namespace {

const std::string flow_text = R"(name = "puff"
[flow]
duration = 1
frame_rate = 10
box = { lo = [-1, -1, -1], hi = [1, 1, 1] }
[fluid]
viscosity = 0.01
[start]
blob = [ { center = [0.1, -0.3, 0], width = 0.4, density = 1 } ]
[[force]]
region = { type = "sphere", center = [0, -0.4, 0], radius = 0.4 }
to = 0.25
acceleration = [0, 2, 0]
)";

struct FlowFolder : TemporaryFolder {
  FlowFolder() { write("puff.toml", flow_text); }
  FlowChoice choice(const std::string& method) const {
    return {file("puff.toml"), {}, method, {{"n", method == "stable_fluids" ? "12" : "5"}, {"dt", "0.05"}}};
  }
};

const Stroke stroke{{-0.3, -0.5, 0.1}, {0.1, 0.05, 0}, 0.4, 3};

// The state after this many steps.
FlowState after(const LiveFlow& flow, long long steps) {
  for (int i = 0; i < 600; ++i)
    if (const FlowState now = flow.state(-1, 0ms); now.steps == steps || !now.message.empty())
      return now;
    else
      std::this_thread::sleep_for(10ms);
  FAIL("the flow does not come to " << steps << " steps");
  return {};
}

// Steps one by one.
void take(LiveFlow& flow, int steps) {
  for (int i = 0; i < steps; ++i) {
    const long long before = flow.state(-1, 0ms).steps;
    flow.order(FlowOrder::step);
    REQUIRE(after(flow, before + 1).message.empty());
  }
}

std::vector<float> values_of(const scene::DensityField& density) {
  std::vector<float> values;
  for (double x = -0.95; x < 1; x += 0.1)
    for (double y = -0.95; y < 1; y += 0.1) values.push_back(float(scene::density(density, Point3(x, y, 0.03))));
  return values;
}

std::string client_body(const std::string& name) { return json{{"client", name}}.dump(); }

json flow_of(Served& served, const json& more = json::object()) {
  json body{{"client", "c"}, {"known", -1}};
  body.update(more);
  const auto answer = served.post("/api/flow", body.dump());
  REQUIRE(answer);
  REQUIRE(answer->status == 200);
  return parse_json(answer->body, "answer");
}

// A client that watches until its socket is closed, as that of a browser that is killed.
struct Watcher {
  Watcher(int port, const std::string& name) : socket(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(std::uint16_t(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(connect(socket, reinterpret_cast<sockaddr*>(&to), sizeof to) == 0);
    const std::string body = client_body(name);
    const std::string request =
        "POST /api/watch HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
        std::to_string(body.size()) + "\r\n\r\n" + body;
    REQUIRE(send(socket, request.data(), request.size(), 0) == ssize_t(request.size()));
    char first = 0;
    REQUIRE(recv(socket, &first, 1, 0) == 1);
  }
  ~Watcher() { close(socket); }
  int socket;
};

}  // namespace

TEST_CASE("Serve: a stirred flow is that of its script, bit for bit", "[experiments][serve]") {
  const FlowFolder folder;
  const FlowChoice choice = folder.choice(GENERATE("stable_fluids", "legendre_fluids"));
  CAPTURE(choice.method);
  LiveFlow live(choice, 0);
  live.order(FlowOrder::pause);
  take(live, 4);
  live.stir(stroke);
  take(live, 3);
  live.stir({stroke.to, stroke.from, 0.3, 1});
  take(live, 3);
  CHECK(live.state(-1, 0ms).strokes == 2);
  const auto seen = values_of(live.smoke()->density);

  folder.write("stirred.toml", live.script("scene.toml"));
  const auto problem = std::make_shared<const scene::FlowProblem>(scene::load_flow(folder.file("stirred.toml")));
  CHECK(problem->pushes.size() == 3);
  const scene::Solver& solver = find_solver(choice.method, "test");
  const auto run = [&](const std::shared_ptr<const scene::FlowProblem>& of) {
    auto flow = solver.start(of, scene::Settings(solver.settings(), choice.settings, "test"), {});
    for (int i = 0; i < 10; ++i) flow->step(live.dt());
    return flow;
  };
  const auto again = run(problem);
  CHECK(again->time() == live.smoke()->time);
  CHECK(values_of(again->medium()) == seen);
  CHECK(values_of(run(std::make_shared<const scene::FlowProblem>(scene::load_flow(choice.file)))->medium()) != seen);
  // Played again from the start, with the strokes at their times.
  live.order(FlowOrder::replay);
  after(live, 0);
  take(live, 10);
  CHECK(values_of(live.smoke()->density) == seen);
  live.order(FlowOrder::reset);
  after(live, 0);
  CHECK(live.state(-1, 0ms).strokes == 0);
  CHECK(values_of(live.smoke()->density) != seen);
}

TEST_CASE("Serve: simulate runs the script of a stirred flow", "[experiments][serve]") {
  const FlowFolder folder;
  LiveFlow live(folder.choice("stable_fluids"), 0);
  live.order(FlowOrder::pause);
  live.stir(stroke);
  take(live, 4);
  const std::string script = live.script("my scene.toml");
  folder.write("stirred.toml", script);
  CHECK_THAT(script, Contains("--scene 'my scene.toml'"));
  const std::string begin = "#   airlight simulate ";
  const std::size_t at = script.find(begin) + begin.size();
  const Result result = run("simulate " + script.substr(at, script.find('\n', at) - at), folder);
  CAPTURE(result.err);
  CHECK(result.code == 0);
  CHECK_THAT(result.out, Contains("3 frames"));  // two steps each, and the start
}

TEST_CASE("Serve: a flow plays while somebody watches", "[experiments][serve]") {
  const FlowFolder folder;
  LiveFlow live(folder.choice("stable_fluids"), 0);
  live.set_pace(0);
  const auto steps_in = [&](auto time) {
    const long long before = live.state(-1, 0ms).steps;
    std::this_thread::sleep_for(time);
    return live.state(-1, 0ms).steps - before;
  };
  CHECK(steps_in(200ms) == 0);
  live.watched(true);
  CHECK(live.state(live.smoke()->number, 5000ms).steps > 0);
  CHECK(steps_in(500ms) > 0);
  live.order(FlowOrder::pause);
  std::this_thread::sleep_for(200ms);
  CHECK(steps_in(300ms) == 0);
  live.order(FlowOrder::play);
  live.set_pace(1);  // 20 steps a second
  CHECK(steps_in(1000ms) <= 22);
  live.watched(false);
  std::this_thread::sleep_for(200ms);
  CHECK(steps_in(300ms) == 0);
}

TEST_CASE("Serve: bad flows and strokes are refused in one line", "[experiments][serve]") {
  const FlowFolder folder;
  const auto started = [&](const std::string& method, const std::map<std::string, std::string>& settings) {
    return message_of([&] { LiveFlow({folder.file("puff.toml"), {}, method, settings}, 0); });
  };
  CHECK_THAT(started("legendre_fluids_gpu", {}), Contains("stable_fluids or legendre_fluids"));
  CHECK_THAT(started("stable_fluids", {{"n", "0"}}), Contains("n"));
  LiveFlow live(folder.choice("stable_fluids"), 0);
  const auto stirred = [&](Stroke s) { return message_of([&] { live.stir(s); }); };
  CHECK_THAT(stirred({stroke.from, stroke.to, 0.001, 1}), Contains("radius 0.001 m"));
  CHECK_THAT(stirred({stroke.from, stroke.to, 0.3, 0}), Contains("0 m/s"));
  CHECK_THAT(stirred({stroke.from, {9, 0, 0}, 0.3, 1}), Contains("far from the box"));
  for (int i = 0; i < 1000; ++i) live.stir(stroke);
  CHECK_THAT(stirred(stroke), Contains("reset it"));

  const json good{{"client", "c"}, {"from", {0, 0, 0}}, {"to", {0, 1, 0}}, {"radius", 0.2}, {"speed", 1}};
  const auto message = [&](const char* key, const json& value) {
    json changed = good;
    changed[key] = value;
    return message_of([&] { read_stroke(changed.dump()); });
  };
  CHECK(message_of([&] { read_stroke(good.dump()); }).empty());
  CHECK_THAT(message("from", {0, 1}), Contains("three numbers"));
  CHECK_THAT(message("to", "x"), Contains("three numbers"));
  CHECK_THAT(message("radius", -1), Contains("0 to 1e+09"));
  CHECK_THAT(message("speed", true), Contains("a number"));
  CHECK_THAT(message("spede", 1), Contains("nearest: speed"));
  const auto flow_message = [&](const json& body) { return message_of([&] { read_flow_request(body.dump()); }); };
  CHECK(flow_message({{"client", "c"}, {"known", 3}, {"order", "play"}, {"pace", 0.25}}).empty());
  CHECK_THAT(flow_message({{"client", "c"}, {"known", 3}, {"order", "stop"}}), Contains("play, pause, step"));
  CHECK_THAT(flow_message({{"client", "c"}, {"known", 3}, {"pace", -1}}), Contains("0 to 1e+06"));
  CHECK_THAT(flow_message({{"client", "c"}}), Contains("known"));
}

TEST_CASE("Serve: scenes show the smoke of the flow", "[experiments][serve]") {
  const FlowFolder folder;
  Served served({"127.0.0.1", 0, ""}, folder.choice("stable_fluids"));
  CHECK(flow_of(served, {{"order", "pause"}})["playing"] == false);
  json body = body_of(request_of("ray_marcher"));
  const auto picture = [&] {
    const auto answer = served.post("/api/frame", body.dump());
    REQUIRE(answer);
    REQUIRE(answer->status == 200);
    return unpacked(answer->body);
  };
  const Answer before = picture();
  CHECK(before.head["smoke_time"] == 0);
  CHECK(picture().values == before.values);
  served.post(
      "/api/stir",
      json{{"client", "c"}, {"from", {-0.3, -0.3, 0}}, {"to", {0.3, -0.3, 0}}, {"radius", 0.4}, {"speed", 5}}.dump());
  for (int i = 0; i < 5; ++i) {
    const long long number = flow_of(served)["number"];
    flow_of(served, {{"order", "step"}});
    for (int tries = 0; tries < 500 && flow_of(served)["number"] == number; ++tries) std::this_thread::sleep_for(5ms);
  }
  const Answer after = picture();
  CHECK(after.head["smoke_time"].get<double>() == Approx(0.25));
  CHECK(difference(after.values, before.values) > 0.05);
  // A method that needs another density says so.
  body["method"] = "fogshop";
  CHECK(picture().head.contains("refused"));
  const auto script =
      served.post("/api/script", json{{"client", "c"}, {"scene", 0}, {"values", json::object()}}.dump());
  CHECK_THAT(script->body, Contains("1 strokes") && Contains("[[force]]"));

  Served still;
  CHECK(still.status("/api/flow", R"({"client": "c", "known": -1})") == 400);
  CHECK(still.status("/api/script", R"({"client": "c", "scene": 0, "values": {}})") == 400);
}

TEST_CASE("Serve: two clients see one flow, which runs until both have gone", "[experiments][serve]") {
  const FlowFolder folder;
  Served served({"127.0.0.1", 0, ""}, folder.choice("stable_fluids"));
  const auto runs = [&] {
    const auto before = served.studio.flow().state(-1, 0ms).steps;
    std::this_thread::sleep_for(500ms);
    return served.studio.flow().state(-1, 0ms).steps > before;
  };
  CHECK(!runs());
  {
    const Watcher first(served.server.port(), "first");
    CHECK(runs());
    {
      const Watcher second(served.server.port(), "second"), twice(served.server.port(), "second");
      flow_of(served, {{"client", "second"}, {"pace", 2}});
      CHECK(flow_of(served, {{"client", "first"}})["pace"] == 2);
      CHECK(runs());
    }
    std::this_thread::sleep_for(1s);
    CHECK(runs());
  }
  std::this_thread::sleep_for(1s);
  CHECK(!runs());
}

TEST_CASE("Serve: a browser that is killed leaves nothing running", "[experiments][serve]") {
  const FlowFolder folder;
  Served served({"127.0.0.1", 0, ""}, folder.choice("stable_fluids"));
  flow_of(served, {{"pace", 0}});
  FrameRequest slow = request_of("path_tracer", 160, 120);
  slow.settings = {{"samples", "1000000"}};
  std::atomic<bool> ended = false;
  std::thread frame;
  {
    const Watcher watcher(served.server.port(), "c");
    frame = std::thread([&] {
      served.studio.frame(slow);
      ended = true;
    });
    std::this_thread::sleep_for(500ms);
    CHECK(!ended);
    const double before = processor_time().run;
    std::this_thread::sleep_for(500ms);
    CHECK(processor_time().run - before > 0.2);
  }
  std::this_thread::sleep_for(1s);
  CHECK(ended);
  const double before = processor_time().run;
  std::this_thread::sleep_for(500ms);
  CHECK(processor_time().run - before < 0.1);
  frame.join();
  // A request that was on its way.
  CHECK(!served.studio.frame(slow));
  const Watcher again(served.server.port(), "c");
  CHECK(served.studio.frame(request_of("ray_marcher")));
}

TEST_CASE("Serve: a flow needs a scene, and its options a flow", "[experiments][serve]") {
  const FlowFolder folder;
  folder.write("one.toml", box_of_fog(8, 6));
  folder.write("clear.toml", "[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n");
  const auto refused = [&](const std::string& words) {
    const Result result = run("serve --port 0 " + words, folder);
    CHECK(result.code == 2);
    return result.err;
  };
  CHECK_THAT(refused("--flow puff.toml"), Contains("needs a scene"));
  CHECK_THAT(refused("--set n=4 one.toml"), Contains("--flow"));
  CHECK_THAT(refused("--flow puff.toml clear.toml"), Contains("no medium that extinguishes"));
  CHECK_THAT(refused("--flow one.toml one.toml"), Contains("one.toml"));
}

}  // namespace serve_flow_test
