// The studio behind HTTP: the page, and its questions.
//
// A request is answered only if its Host is this server, its Origin (where there is one) too, its body is JSON of at most 64 KiB, and, with a
// token, if it brings that. Bad requests are answered by 400 and one line. Names in requests lead to no file: the page is in the program, and
// scenes are numbers.
#pragma once
#include <memory>
#include <string>

#include "experiments/serve/studio.h"

namespace airlight::experiments::serve {

struct ServerOptions {
  std::string host = "127.0.0.1";
  int port = 7007;    // 0: any that is free
  std::string token;  // needed by every question; empty: none
};

class Server {
 public:
  // Throws Error where the port is taken.
  Server(Studio&, const ServerOptions&);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const;
  // Answers requests on other threads until stop() or the end of this object.
  void start();
  void stop();

 private:
  struct Hidden;  // httplib, which takes long to compile
  std::unique_ptr<Hidden> hidden_;
};

bool is_loopback(const std::string& host);
std::string random_token();  // 32 hex digits, from the system

}  // namespace airlight::experiments::serve
