#include <fmt/format.h>
#include <spawn.h>

#include <chrono>
#include <thread>

#include "experiments/application/folders.h"
#include "experiments/application/interrupt.h"
#include "experiments/application/say.h"
#include "experiments/cli/command_line.h"
#include "experiments/cli/commands.h"
#include "experiments/serve/server.h"
#include "scene/base/error.h"

namespace airlight::experiments::cli {
namespace {

struct ServeOptions {
  std::vector<std::string> scenes;
  std::string root;
  serve::ServerOptions server;
  serve::FlowChoice flow;
  bool open = false;
  int threads = 0;
};

// The scenes of experiments/scenes/common.
std::vector<std::string> common_scenes(const std::string& root) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(project_root(root) / "experiments/scenes/common"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  // As one would type them, where they are below the current folder.
  for (std::string& file : files)
    if (const auto near = std::filesystem::proximate(file); *near.begin() != "..") file = near.string();
  return files;
}

void open_browser(const std::string& address) {
  std::string program = "xdg-open", argument = address;
  char* const words[] = {program.data(), argument.data(), nullptr};
  pid_t process = 0;
  if (posix_spawnp(&process, program.c_str(), nullptr, nullptr, words, environ) != 0)
    say("--open: there is no xdg-open; open the address in a browser yourself");
}

int serve_scenes(const ServeOptions& options) {
  const std::vector<std::string> files = options.scenes.empty() ? common_scenes(options.root) : options.scenes;
  serve::ServerOptions where = options.server;
  if (!serve::is_loopback(where.host) && where.token.empty()) where.token = serve::random_token();
  const bool flows = !options.flow.file.empty();
  const serve::FlowChoice usual;
  if (!flows &&
      (options.flow.method != usual.method || !options.flow.settings.empty() || !options.flow.overrides.empty()))
    throw Error("--method, --set and --override belong to a flow: name one with --flow");
  if (flows && options.scenes.empty())
    throw Error("--flow needs a scene that shows it: name a SCENE whose smoke is to be the flow's");
  serve::Studio studio(files, options.threads, flows ? std::optional(options.flow) : std::nullopt);
  if (!options.scenes.empty())
    for (int i = 0; i < studio.scenes();
         ++i) {  // throws for a file that is no scene, or that has no smoke for the flow
      serve::SceneRequest request;
      request.scene = i;
      studio.scene(request);
    }
  serve::Server server(studio, where);
  const std::string host = where.host.find(':') == std::string::npos ? where.host : "[" + where.host + "]";
  const std::string address =
      fmt::format("http://{}:{}/{}", host, server.port(), where.token.empty() ? "" : "#token=" + where.token);
  server.start();
  fmt::print("{}\nCtrl-C ends it.\n", address);
  std::fflush(stdout);
  if (options.open) open_browser(address);
  while (!interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  server.stop();
  if (!stopped_by().empty()) throw scene::Interrupted("");  // the time of --limit is over; Ctrl-C is how it ends
  return 0;
}

}  // namespace

void add_serve(Commands& commands) {
  const auto options = std::make_shared<ServeOptions>();
  CLI::App* c = add_command(commands.app, "serve", "compare two methods and the reference side by side in a browser");
  c->add_option("SCENE", options->scenes, "scene files (default: those of experiments/scenes/common)");
  c->add_option("--flow", options->flow.file,
                "simulate this flow file while you watch; the first medium of every SCENE shows its smoke");
  c->add_option("--method,-m", options->flow.method, "solver of --flow: stable_fluids (default) or legendre_fluids");
  add_pairs(c, "--set", options->flow.settings, "change a setting of the solver of --flow");
  add_pairs(c, "--override", options->flow.overrides, "change a value of the flow file");
  c->add_option("--port", options->server.port, "port to listen on, 0 for any that is free (default 7007)")
      ->check(CLI::Range(0, 65535));
  c->add_option("--host", options->server.host,
                "address to listen on (default 127.0.0.1, which only this machine reaches); any other needs a token");
  c->add_option("--token", options->server.token,
                "secret that every browser must bring (default: a random one with --host, none without)");
  c->add_flag("--open", options->open, "open the page in the default browser");
  c->add_option("--threads", options->threads, "number of threads (default 0: all)")->check(CLI::Range(0, 4096));
  c->add_option("--root", options->root, "project folder (default: above the current folder, or above the program)");
  commands.add_limit(c);
  commands.add_data(c);
  commands.add_gpu(c);
  commands.on(c, [options] { return serve_scenes(*options); });
}

}  // namespace airlight::experiments::cli
