// Reference images, computed once: references/<key>.exr in the store (results/cache). Samples of a Monte Carlo renderer
// are kept as well (results/cache/samples): a reference with fewer samples is refined, and one that was interrupted goes
// on where it was; its samples are always exactly those asked for.
//
// The key is the content of scene, renderer, settings and of the sources of scene/ and reference/, the compiler, and
// where there is one the device and its shaders: another program that computes the same is served, a changed reference
// is not. A damaged or half-copied file is computed anew.
//
// A committed film (committed_references.h) goes before the cache.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "scene/renderer.h"

namespace airlight::experiments {

struct Reference {
  scene::Film film;
  std::string key;
  double seconds = 0;  // that it took when it was computed, all its samples
  bool cached = false;
  bool committed = false;
};

// `committed`: the film that is wanted, empty where none is. The key of one that is there is its content.
std::string reference_key(const scene::Scene&, const scene::Renderer&, const scene::Settings&,
                          const std::filesystem::path& committed = {});

// The committed film; else through the store of the execution, and a line says that the film is missing. Throws
// NotSupported, Interrupted if stopped, Error for a damaged film.
Reference reference_for(const std::shared_ptr<const scene::Scene>&, const scene::Renderer&, const scene::Settings&,
                        const scene::Execution&, const std::filesystem::path& committed = {});

// Renders, and keeps and finds nothing but what the renderer itself keeps in the store of the execution.
Reference compute_reference(const std::shared_ptr<const scene::Scene>&, const scene::Renderer&, const scene::Settings&,
                            const scene::Execution&);

}  // namespace airlight::experiments
