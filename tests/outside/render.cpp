// render SCENE FILM: renders a scene with Fogshop and writes an OpenEXR file.
#include <iostream>
#include <memory>

#include "methods/fogshop/fogshop.h"
#include "scene/base/error.h"
#include "scene/film/film.h"
#include "scene/renderer.h"

int main(int argc, char** argv) try {
  using namespace airlight;
  if (argc != 3) throw Error("expected a scene and a film");
  const fogshop::Fogshop method;
  const auto scene = std::make_shared<const scene::Scene>(scene::load_scene(argv[1]));
  const scene::Settings settings(method.settings(), {{"K", "12"}}, "render");
  const scene::Film film = method.prepare(scene, settings, {})->render(scene::view_of(*scene), {}).film;
  scene::write_exr(argv[2], film);
  return 0;
} catch (const airlight::Error& error) {
  std::cerr << "render: " << error.what() << '\n';
  return error.exit_code();
}
