// Sends pictures to a viewer that speaks tev's protocol over TCP, while they are made.
#pragma once
#include <string>

#include "scene/film/film.h"

namespace airlight::experiments::cli {

class Viewer {
 public:
  // `where` is HOST:PORT, e.g. 127.0.0.1:14158, where tev listens. Throws Error for another form, and Unavailable where nothing answers
  // within 5 s.
  explicit Viewer(const std::string& where);
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  ~Viewer();

  // Shows all layers under this title: `mean` as R, G, B, the others as LAYER.R and so on. The first picture opens a window, later ones,
  // which must have the same layers and size, replace its pixels. A viewer that went away gets nothing more; `lost` says so.
  void show(const scene::Film&, const std::string& title);
  bool lost() const { return lost_; }

 private:
  void send(char kind, const std::string& body);

  int socket_ = -1;
  bool opened_ = false, lost_ = false;
};

}  // namespace airlight::experiments::cli
