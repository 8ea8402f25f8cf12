// What a film says about its own noise: sixteen equal groups of samples, stored as layers.
//
// `mean` has layers batch.00, batch.01, ...; another layer L has L.batch.00, ... A film with neither batches nor a
// standard error is exact.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "scene/film.h"

namespace airlight::experiments {

// The batch layers of `layer`; empty if the film is exact. Throws Error if the film is noisy (it has `se` or batches)
// but not for this layer, naming the film as `what`.
std::vector<std::span<const float>> batches(const scene::Film&, const std::string& layer, const std::string& what);

// Throws Error (what, layer, pixel) unless all values are finite and there are as many as the film says.
std::span<const float> finite_layer(const scene::Film&, const std::string& layer, const std::string& what);

}  // namespace airlight::experiments
