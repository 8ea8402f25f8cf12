// Readers behind read_color_image (color_image.h), one for each kind of file. Each throws Error.
#pragma once
#include <array>
#include <cstddef>
#include <string>

#include "scene/film/color_image.h"

namespace airlight::scene {

inline constexpr std::size_t most_image_bytes = std::size_t(1) << 30;  // of a file

// Throws Error where a side is not 1 to 16384, or where 8-bit and linear pixels together need more memory than is allowed.
void require_size(const std::string& path, long long width, long long height);
// Linear light of an sRGB byte: IEC 61966-2-1.
std::array<float, 256> linear_of_srgb();

// Baseline and progressive JPEG of 8 bits, grey or YCbCr, by libjpeg-turbo: sRGB, turned into linear light.
ColorImage read_jpeg(const std::string& path);
// Radiance picture (32-bit_rle_rgbe): linear light, divided by the product of its EXPOSURE lines.
ColorImage read_radiance(const std::string& path);

}  // namespace airlight::scene
