// A film's own noise: sixteen equal groups of samples, stored as layers.
//
// `mean` has layers batch.00, batch.01, ...; another layer L has L.batch.00, ... A film with neither batches nor a
// standard error is exact. Few samples make no batches: then there is only the standard error of each value, `se` or
// L.se. A renderer that knows more than its samples (none of them met anything, and yet something may be there) says so
// by a standard error above 0 where all batches are equal: an upper end of what the value may be off by. For a set of K
// such values that of one is an upper end of their sum: it comes from 3 in n samples of a pixel, and of K n samples
// that met nothing at most 3 would have (95 %).
#pragma once
#include <span>
#include <string>
#include <vector>

#include "scene/film/film.h"

namespace airlight::experiments {

// The batch layers of `layer`; empty if the film is exact. Throws Error if the film is noisy (it has `se` or batches)
// but not for this layer, naming the film as `what`.
std::vector<std::span<const float>> batches(const scene::Film&, const std::string& layer, const std::string& what);

// Standard errors of `layer`, or nothing. Throws Error if they are not finite or negative.
std::span<const float> standard_errors(const scene::Film&, const std::string& layer, const std::string& what);

// Is the film noisy, and too short for batches of this layer, but with standard errors of two or more samples?
bool has_only_errors(const scene::Film&, const std::string& layer, const std::string& what);

// Where all batches are equal, the standard error: what they cannot show. Empty if that is 0 everywhere.
std::vector<float> unresolved(const scene::Film&, const std::string& layer, const std::string& what);

// Throws Error (what, layer, pixel) unless all values are finite and there are as many as the film says.
std::span<const float> finite_layer(const scene::Film&, const std::string& layer, const std::string& what);

}  // namespace airlight::experiments
