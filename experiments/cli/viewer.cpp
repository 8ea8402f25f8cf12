#include "experiments/cli/viewer.h"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "scene/base/error.h"

namespace airlight::experiments::cli {
namespace {

// The protocol of tev (its Ipc.h). A message is its length as 32 bits, these four bytes included, its kind as one byte, and its body.
// Numbers are little-endian, texts end with a zero byte.
static_assert(std::endian::native == std::endian::little);
constexpr char update_image = 3, create_image = 4;
constexpr timeval patience{5, 0};

template <class T>
void append(std::string& body, T value) {
  body.append(reinterpret_cast<const char*>(&value), sizeof(T));
}
void append_text(std::string& body, const std::string& text) { body.append(text.c_str(), text.size() + 1); }

std::string channel(const std::string& layer, int c) {
  const std::string colour(1, "RGB"[c]);
  return layer == "mean" ? colour : layer + "." + colour;
}

}  // namespace

Viewer::Viewer(const std::string& where) {
  const std::size_t colon = where.rfind(':');
  const std::string host = where.substr(0, colon), port = colon == std::string::npos ? "" : where.substr(colon + 1);
  if (host.empty() || port.empty() || port.size() > 5 || port.find_first_not_of("0123456789") != std::string::npos)
    throw Error(fmt::format("--display '{}': expected HOST:PORT, e.g. 127.0.0.1:14158", where));
  addrinfo hints{}, *first = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  if (const int code = getaddrinfo(host.c_str(), port.c_str(), &hints, &first); code != 0)
    throw Unavailable(fmt::format("--display {}: {}", where, gai_strerror(code)));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(first, freeaddrinfo);
  int failure = 0;
  for (const addrinfo* a = first; a && socket_ < 0; a = a->ai_next) {
    const int s = ::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
    if (s < 0) continue;
    setsockopt(s, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);  // of connecting, too
    if (connect(s, a->ai_addr, a->ai_addrlen) == 0) {
      socket_ = s;
    } else {
      failure = errno;
      close(s);
    }
  }
  if (socket_ < 0) throw Unavailable(fmt::format("--display {}: no viewer answers: {}", where, std::strerror(failure)));
}

Viewer::~Viewer() { close(socket_); }

void Viewer::send(char kind, const std::string& body) {
  std::string message;
  append(message, std::uint32_t(sizeof(std::uint32_t) + 1 + body.size()));
  message += kind;
  message += body;
  for (std::size_t sent = 0; sent < message.size() && !lost_;) {
    const ssize_t now = ::send(socket_, message.data() + sent, message.size() - sent, MSG_NOSIGNAL);
    if (now >= 0)
      sent += std::size_t(now);
    else if (errno != EINTR)
      lost_ = true;
  }
}

void Viewer::show(const scene::Film& film, const std::string& title) {
  if (!opened_) {
    std::string body(1, 1);  // comes to the front
    append_text(body, title);
    append(body, std::int32_t(film.width));
    append(body, std::int32_t(film.height));
    append(body, std::int32_t(3 * film.layers.size()));
    for (const auto& [layer, values] : film.layers)
      for (int c = 0; c < 3; ++c) append_text(body, channel(layer, c));
    send(create_image, body);
    opened_ = true;
  }
  std::vector<float> plane(film.pixels());
  for (const auto& [layer, values] : film.layers)
    for (int c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = values[3 * i + c];
      std::string body(1, 0);
      append_text(body, title);
      append_text(body, channel(layer, c));
      for (const int number : {0, 0, film.width, film.height}) append(body, std::int32_t(number));
      body.append(reinterpret_cast<const char*>(plane.data()), plane.size() * sizeof(float));
      send(update_image, body);
    }
}

}  // namespace airlight::experiments::cli
