// Shared parts of the readers of grey images.
#pragma once
#include "scene/film/grey_image.h"

namespace airlight::scene {

GreyImage read_grey_png(const std::string& path, std::size_t most_pixels);
GreyImage read_grey_exr(const std::string& path, const std::string& channel, std::size_t most_pixels);

void write_grey_png(const std::string& path, const GreyImage&);

// Throws Error if there are more pixels, or none.
void require_pixels(const std::string& path, std::size_t width, std::size_t height, std::size_t most_pixels);

}  // namespace airlight::scene
