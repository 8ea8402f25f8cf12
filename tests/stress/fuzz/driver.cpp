// airlight_fuzz: runs many command lines of the program from one process, for fuzz.py: starting the program takes ten
// times as long as refusing a file. Every command runs in a child of its own, so that a crash ends nothing else.
//
// Standard input: one command a line, a JSON list of its arguments. Standard output: one line for each,
//   {"code": N or null, "signal": N or null, "seconds": of the processor, "kib": most memory held,
//    "error": standard error}
// A command that begins with "seal" is run without that word, once the checksums of the files that a mutation left
// wrong are made right: of *.samples in the working folder, and of the rows of journals below project/results.
//
// usage: airlight_fuzz SECONDS
// SECONDS of the processor after which a command is killed; by SIGALRM after ten times that on the clock.
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
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/cli/program.h"
#include "experiments/driver/content_key.h"

namespace {

using nlohmann::json;

[[noreturn]] void run_here(std::vector<std::string> arguments, int errors, unsigned seconds) {
  const int nothing = open("/dev/null", O_RDWR);
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  // Of the processor, which others may use as well; and of the clock, where it waits for what never comes.
  const rlimit processor{seconds, seconds};
  setrlimit(RLIMIT_CPU, &processor);
  alarm(10 * seconds);
  arguments.insert(arguments.begin(), "airlight");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const int code = airlight::experiments::cli::run(int(arguments.size()), argv.data());
  std::fflush(stdout);
  std::fflush(stderr);
  _exit(code);
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
    sealed += line.size() < 33
                  ? line + "\n"
                  : airlight::experiments::content_key(std::string_view(line).substr(33)) + line.substr(32) + "\n";
  std::ofstream(path, std::ios::binary) << sealed;
}

void seal() {
  namespace fs = std::filesystem;
  for (const auto& file : fs::directory_iterator("."))
    if (file.path().extension() == ".samples") seal_samples(file.path());
  if (fs::exists("project/results"))
    for (const auto& file : fs::recursive_directory_iterator("project/results"))
      if (file.path().extension() == ".jsonl") seal_journal(file.path());
}

json run(const std::vector<std::string>& arguments, unsigned seconds) {
  const int errors = memfd_create("errors", MFD_CLOEXEC);
  const pid_t child = fork();
  if (child < 0 || errors < 0) throw std::runtime_error("no child can be started");
  if (child == 0) run_here(arguments, errors, seconds);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  json result;
  result["code"] = WIFEXITED(status) ? json(WEXITSTATUS(status)) : json();
  result["signal"] = WIFSIGNALED(status) ? json(WTERMSIG(status)) : json();
  const auto seconds_of = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  result["seconds"] = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  result["kib"] = usage.ru_maxrss;
  result["error"] = content(errors);
  close(errors);
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  const unsigned seconds = argc > 1 ? unsigned(std::atoi(argv[1])) : 20;
  for (std::string line; std::getline(std::cin, line);) {
    auto arguments = json::parse(line).get<std::vector<std::string>>();
    if (arguments.front() == "seal") {
      seal();
      arguments.erase(arguments.begin());
    }
    const auto result = run(arguments, seconds);
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
