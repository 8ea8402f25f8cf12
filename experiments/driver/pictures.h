// Films of an experiment: compared, and kept for looking at.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/driver/experiment.h"
#include "experiments/judging/metrics.h"
#include "scene/film/film.h"

namespace airlight::experiments {

// Letters, digits, '-' and '.' of a text; '_' for the rest, and for a dot that it begins with.
std::string file_name(const std::string& text);
// File name of a row's picture, without its ending. The picture of the reference is called "reference".
std::string picture_name(const std::string& method, const std::string& setting);

// Powers of two that bring the 99th percentile of the luminance to 0.8.
double exposure_of(const scene::Film&, const std::string& layer);

// The metrics of a method's film. The layer to compare is renamed to the reference's. Metrics "of converted" media
// compare with the film `converted`.
std::vector<Measure> compare(const Experiment&, const MethodCase&, const scene::Film&, const scene::Film& reference,
                             const scene::Film& converted, const Masks&);

// images/name.exr, without the layers that say how noisy it is, and .png.
void keep_picture(const std::filesystem::path& images, const std::string& name, const scene::Film&,
                  const std::string& layer, double exposure);

}  // namespace airlight::experiments
