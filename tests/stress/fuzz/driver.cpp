// airlight_fuzz: runs many command lines of the program from one process, for fuzz.py: starting the program takes ten
// times as long as refusing a file. Commands run in a child, so that a crash ends nothing else; a child serves many of
// them, since with sanitizers a fork takes as long as a command.
//
// Standard input: one command a line, a JSON list of its arguments. Standard output: one line for each,
//   {"code": N or null, "signal": N or null, "seconds": of the processor, "kib": most memory held,
//    "error": standard error}
// A command that begins with "seal" is run without that word, once the checksums of the files that a mutation left
// wrong are made right: of *.samples, *.residual and frames/state in the working folder, and of the rows of journals below project/results.
//
// usage: airlight_fuzz SECONDS [COMMANDS]
// SECONDS of the processor after which a command is killed; by SIGALRM after ten times that on the clock. COMMANDS that
// a child serves, by default 64.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <xxhash.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/application/json_value.h"
#include "experiments/cli/program.h"
#include "scene/base/content_key.h"

namespace {

using nlohmann::json;

double seconds_of(const rusage& usage) {
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

rusage used() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage;
}

json run_here(std::vector<std::string> arguments, unsigned seconds) {
  // The most memory held begins anew; where the kernel does not let it, it is that of all commands so far.
  if (const int file = open("/proc/self/clear_refs", O_WRONLY); file >= 0) {
    [[maybe_unused]] const ssize_t written = write(file, "5", 1);
    close(file);
  }
  const double before = seconds_of(used());
  // Limits processor time, which does not depend on other processes, and clock time, in case the command waits forever.
  const rlimit processor{rlim_t(before) + 1 + seconds, RLIM_INFINITY};
  setrlimit(RLIMIT_CPU, &processor);
  alarm(10 * seconds);
  arguments.insert(arguments.begin(), "airlight");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  json result;
  result["code"] = airlight::experiments::cli::run(int(arguments.size()), argv.data());
  std::fflush(stdout);
  std::fflush(stderr);
  alarm(0);
  const rusage after = used();
  result["seconds"] = seconds_of(after) - before;
  result["kib"] = after.ru_maxrss;
  return result;
}

// The first 64 KiB: a sanitizer's report fits, a flood does not.
std::string content(int file) {
  std::string text(1 << 16, '\0');
  const ssize_t size = pread(file, text.data(), text.size(), 0);
  text.resize(size > 0 ? std::size_t(size) : 0);
  return text;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void seal_samples(const std::filesystem::path& path) {
  std::string bytes = bytes_of(path);
  if (bytes.size() < 8) return;
  const std::uint64_t checksum = XXH3_64bits(bytes.data(), bytes.size() - 8);
  std::memcpy(bytes.data() + bytes.size() - 8, &checksum, 8);
  std::ofstream(path, std::ios::binary) << bytes;
}

void seal_journal(const std::filesystem::path& path) {
  std::istringstream in(bytes_of(path));
  std::string sealed;
  for (std::string line; std::getline(in, line);)
    sealed += line.size() < 33 ? line + "\n"
                               : airlight::content_key(std::string_view(line).substr(33)) + line.substr(32) + "\n";
  std::ofstream(path, std::ios::binary) << sealed;
}

// Files that end with the checksum of all before: what `simulate` goes on with, and residuals.
void seal_end(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return;
  std::string bytes = bytes_of(path);
  if (bytes.size() < 32) return;
  bytes.resize(bytes.size() - 32);
  std::ofstream(path, std::ios::binary) << bytes << airlight::content_key(bytes);
}

void seal() {
  namespace fs = std::filesystem;
  for (const auto& file : fs::directory_iterator("."))
    if (file.path().extension() == ".samples")
      seal_samples(file.path());
    else if (file.path().extension() == ".residual")
      seal_end(file.path());
  seal_end("frames/state");
  if (fs::exists("project/results"))
    for (const auto& file : fs::recursive_directory_iterator("project/results"))
      if (file.path().extension() == ".jsonl") seal_journal(file.path());
}

// A process that runs commands until it crashes, or has served its share.
class Child {
 public:
  explicit Child(unsigned seconds) : errors_(memfd_create("errors", MFD_CLOEXEC)) {
    int to[2], from[2];
    if (errors_ < 0 || pipe(to) != 0 || pipe(from) != 0) throw std::runtime_error("no child can be started");
    id_ = fork();
    if (id_ < 0) throw std::runtime_error("no child can be started");
    if (id_ == 0) {
      close(to[1]);
      close(from[0]);
      serve(to[0], from[1], seconds);
    }
    close(to[0]);
    close(from[1]);
    commands_ = fdopen(to[1], "w");
    results_ = fdopen(from[0], "r");
  }
  Child(const Child&) = delete;
  ~Child() {
    std::fclose(commands_);
    std::fclose(results_);
    if (!ended_) waitpid(id_, nullptr, 0);
    close(errors_);
  }

  bool ended() const { return ended_; }

  json run(const std::string& command) {
    if (ftruncate(errors_, 0) != 0) throw std::runtime_error("the file of errors cannot be emptied");
    std::fprintf(commands_, "%s\n", command.c_str());
    std::fflush(commands_);
    json result;
    std::string line;
    for (int c; (c = std::fgetc(results_)) != EOF && c != '\n';) line += char(c);
    if (!line.empty()) {
      result = json::parse(line);
      result["signal"] = nullptr;
    } else {
      int status = 0;
      rusage usage{};
      wait4(id_, &status, 0, &usage);
      ended_ = true;
      result["code"] = WIFEXITED(status) ? json(WEXITSTATUS(status)) : json();
      result["signal"] = WIFSIGNALED(status) ? json(WTERMSIG(status)) : json();
      result["seconds"] = seconds_of(usage);
      result["kib"] = usage.ru_maxrss;
    }
    result["error"] = content(errors_);
    return result;
  }

 private:
  [[noreturn]] void serve(int commands, int results, unsigned seconds) {
    const int nothing = open("/dev/null", O_RDWR);
    dup2(nothing, STDIN_FILENO);
    dup2(nothing, STDOUT_FILENO);
    FILE* in = fdopen(commands, "r");
    FILE* out = fdopen(results, "w");
    for (;;) {
      std::string line;
      int c;
      while ((c = std::fgetc(in)) != EOF && c != '\n') line += char(c);
      if (c == EOF) _exit(0);
      // The file's place is shared with those before: to the beginning.
      lseek(errors_, 0, SEEK_SET);
      dup2(errors_, STDERR_FILENO);
      const json result = run_here(json::parse(line).get<std::vector<std::string>>(), seconds);
      std::fprintf(out, "%s\n", result.dump().c_str());
      std::fflush(out);
    }
  }

  int errors_;
  pid_t id_ = 0;
  bool ended_ = false;
  FILE* commands_ = nullptr;
  FILE* results_ = nullptr;
};

}  // namespace

int main(int argc, char** argv) {
  const unsigned seconds = argc > 1 ? unsigned(std::atoi(argv[1])) : 20;
  const int share = argc > 2 ? std::atoi(argv[2]) : 64;
  dlopen("airlight_vdb.so", RTLD_LAZY);  // else each child loads it anew: OpenVDB takes 40 ms
  std::unique_ptr<Child> child;
  int served = 0;
  for (std::string line; std::getline(std::cin, line);) {
    auto arguments = json::parse(line).get<std::vector<std::string>>();
    if (arguments.front() == "seal") {
      seal();
      arguments.erase(arguments.begin());
    }
    if (!child || child->ended() || served == share) {
      child.reset();
      child = std::make_unique<Child>(seconds);
      served = 0;
    }
    ++served;
    const auto result = child->run(json(arguments).dump());
    // Standard error need not be UTF-8; that is for the judge to see: bytes become the code points of Latin-1.
    json sent = result;
    std::string latin;
    for (const unsigned char c : result["error"].get_ref<const std::string&>()) {
      if (c < 0x80) {
        latin += char(c);
      } else {
        latin += char(0xc0 | c >> 6);
        latin += char(0x80 | (c & 0x3f));
      }
    }
    sent["error"] = latin;
    std::cout << sent.dump() << std::endl;
  }
}
