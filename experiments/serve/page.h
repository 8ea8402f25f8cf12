// The files of the page that `airlight serve` shows, as they were compiled into the program.
#pragma once
#include <map>
#include <string>

namespace airlight::experiments::serve {

// By name: "page/index.html", "page/page.js", ..., "pixels.js". Made by cmake/embed_files.cmake.
const std::map<std::string, std::string>& embedded_page();

}  // namespace airlight::experiments::serve
