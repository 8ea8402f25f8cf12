#include "experiments/serve/server.h"

#include <fmt/format.h>
#include <httplib.h>

#include <random>
#include <thread>

#include "experiments/serve/answers.h"
#include "experiments/serve/page.h"
#include "scene/base/error.h"
#include "scene/base/printable.h"

namespace airlight::experiments::serve {
namespace {

using httplib::Request;
using httplib::Response;

constexpr std::size_t most_body = 1 << 16;
constexpr int most_connections = 160;  // of 64 clients, one each all the time
constexpr auto heartbeat = std::chrono::milliseconds(200);
constexpr auto longest_wait = std::chrono::milliseconds(500);  // for smoke

// "127.0.0.1:7007", "[::1]:7007", "localhost": the part that names the machine.
std::string machine_of(const std::string& host) {
  if (host.starts_with("[")) return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.find(':'));
}

std::string content_type(const std::string& name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  return "text/javascript; charset=utf-8";
}

void say_no(Response& response, int status, const std::string& line) {
  response.status = status;
  response.set_content(scene::printable(line, 1000) + "\n", "text/plain; charset=utf-8");
}

// Equal, in a time that says nothing about where they differ.
bool is_same_secret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  int differences = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differences |= a[i] ^ b[i];
  return differences == 0;
}

// The library lets five connections wait for a thread, and the system loses those that come beside them.
struct Listener : httplib::Server {
  void let_more_wait() { ::listen(svr_sock_, 2 * most_connections); }
};

}  // namespace

bool is_loopback(const std::string& host) { return host == "127.0.0.1" || host == "::1" || host == "localhost"; }

std::string random_token() {
  std::random_device system;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", std::uint32_t(system()));
  return token;
}

struct Server::Hidden {
  Hidden(Studio& s, const ServerOptions& o) : studio(s), options(o) {}

  // Why a request is refused; empty: it is not.
  std::string objection(const Request& request) const {
    const std::string host = request.get_header_value("Host"), machine = machine_of(host);
    const bool ours = is_loopback(machine) || machine == "[::1]" || machine == options.host ||
                      machine == "[" + options.host + "]" || options.host == "0.0.0.0" || options.host == "::";
    if (!ours) return fmt::format("Host '{}': expected this server", scene::printable(host, 100));
    const std::string origin = request.get_header_value("Origin");
    if (request.has_header("Origin") && origin != "http://" + host)
      return fmt::format("Origin '{}': expected this server", scene::printable(origin, 100));
    return "";
  }

  // A question of the page: JSON in, something out.
  template <class Answer>
  void question(const std::string& path, const char* type, const Answer& answer) {
    request_to(path, [type, answer](const std::string& body, Response& response) {
      response.set_content(answer(body), type);
    });
  }

  // An answer without end, of a space every 200 ms, by which both sides see that the other one is there. Writing fails where a browser was
  // killed; then nothing runs for it any more.
  void add_watch() {
    request_to("/api/watch", [this](const std::string& body, Response& response) {
      const std::string client = read_client(body);
      studio.enter(client);
      response.set_chunked_content_provider(
          "text/plain",
          [this](std::size_t, httplib::DataSink& sink) {
            if (studio.stopped() || !sink.is_writable() || !sink.write(" ", 1)) return false;
            std::this_thread::sleep_for(heartbeat);
            return true;
          },
          [this, client](bool) { studio.exit(client); });
    });
  }

  // Calls act(body, response) for good requests, and answers the others in one line.
  template <class Act>
  void request_to(const std::string& path, const Act& act) {
    http.Post(path, [this, act](const Request& request, Response& response) {
      if (const std::string line = objection(request); !line.empty()) return say_no(response, 403, line);
      if (!options.token.empty() && !is_same_secret(request.get_header_value("X-Airlight-Token"), options.token))
        return say_no(response, 403, "the token is missing or wrong: open the address that `airlight serve` printed");
      if (request.get_header_value("Content-Type") != "application/json")
        return say_no(response, 400, "expected a body of type application/json");
      try {
        act(request.body, response);
      } catch (const Error& error) {
        say_no(response, 400, error.what());
      } catch (const std::bad_alloc&) {
        say_no(response, 503, "out of memory");
      } catch (const std::exception& error) {
        say_no(response, 500, fmt::format("unexpected failure: {}", error.what()));
      }
    });
  }

  void add_page() {
    for (const auto& [name, text] : embedded_page()) {
      const std::string file = name.substr(name.rfind('/') + 1);
      const auto send = [this, &text = text, type = content_type(name)](const Request& request, Response& response) {
        if (const std::string line = objection(request); !line.empty()) return say_no(response, 403, line);
        response.set_content(text, type);
      };
      std::string path = "/" + file;
      for (std::size_t dot = path.find('.'); dot != path.npos; dot = path.find('.', dot + 2)) path.insert(dot, "\\");
      http.Get(path, send);
      if (file == "index.html") http.Get("/", send);
    }
  }

  void add_questions() {
    const char* json = "application/json";
    const char* bytes = "application/octet-stream";
    question("/api/scenes", json, [this](const std::string& body) {
      read_client(body);
      return list_of_scenes(studio);
    });
    question("/api/scene", json, [this](const std::string& body) {
      const SceneRequest request = read_scene_request(body, studio.scenes());
      return scene_answer(studio.source(request.scene), *studio.scene(request), studio.has_flow());
    });
    question("/api/text", "text/plain; charset=utf-8", [this](const std::string& body) {
      const SceneRequest request = read_scene_request(body, studio.scenes());
      return studio.source(request.scene).text(request.values);
    });
    question("/api/frame", bytes, [this](const std::string& body) {
      const FrameRequest request = read_frame_request(body, studio.scenes());
      return frame_answer(studio.frame(request), request);
    });
    question("/api/reference", bytes, [this](const std::string& body) {
      return reference_answer(studio.reference(read_reference_request(body, studio.scenes())));
    });
    question("/api/leave", json, [this](const std::string& body) {
      studio.leave(read_client(body));
      return std::string("{}");
    });
    question("/api/flow", json, [this](const std::string& body) {
      const FlowRequest request = read_flow_request(body);
      LiveFlow& flow = studio.flow();
      if (request.pace) flow.set_pace(*request.pace);
      if (request.order) flow.order(*request.order);
      return flow_answer(flow.state(request.known, longest_wait));
    });
    question("/api/stir", json, [this](const std::string& body) {
      studio.flow().stir(read_stroke(body));
      return std::string("{}");
    });
    question("/api/script", "text/plain; charset=utf-8", [this](const std::string& body) {
      return studio.flow().script(studio.files()[std::size_t(read_scene_request(body, studio.scenes()).scene)]);
    });
  }

  Studio& studio;
  ServerOptions options;
  Listener http;
  int port = 0;
  std::thread thread;
};

Server::Server(Studio& studio, const ServerOptions& options) : hidden_(std::make_unique<Hidden>(studio, options)) {
  Listener& http = hidden_->http;
  http.new_task_queue = [] { return new httplib::ThreadPool(most_connections); };
  http.set_payload_max_length(most_body);
  http.set_keep_alive_max_count(1000);
  http.set_keep_alive_timeout(2);
  http.set_tcp_nodelay(true);
  // The library's default would let a second server share the port.
  http.set_socket_options([](int socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  // Nothing of the page comes from elsewhere, and no other page may show it or read it.
  http.set_default_headers({{"Content-Security-Policy",
                             "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
                             "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
                            {"X-Content-Type-Options", "nosniff"},
                            {"Referrer-Policy", "no-referrer"},
                            {"Cross-Origin-Resource-Policy", "same-origin"},
                            {"Cache-Control", "no-store"}});
  http.set_error_handler([](const Request&, Response& response) {
    if (response.body.empty()) say_no(response, response.status, fmt::format("error {}", response.status));
  });
  hidden_->add_page();
  hidden_->add_questions();
  hidden_->add_watch();
  if (options.port == 0)
    hidden_->port = http.bind_to_any_port(options.host);
  else if (http.bind_to_port(options.host, options.port))
    hidden_->port = options.port;
  if (hidden_->port <= 0)
    throw Error(fmt::format("{}:{}: cannot listen there: choose another --port, 0 for any that is free", options.host,
                            options.port));
  http.let_more_wait();
}

Server::~Server() { stop(); }

int Server::port() const { return hidden_->port; }

void Server::start() {
  hidden_->thread = std::thread([this] { hidden_->http.listen_after_bind(); });
  while (!hidden_->http.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void Server::stop() {
  if (!hidden_->thread.joinable()) return;
  hidden_->studio.stop();  // questions that wait for a picture end
  hidden_->http.stop();
  hidden_->thread.join();
}

}  // namespace airlight::experiments::serve
