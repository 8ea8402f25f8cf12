// Radiance pictures (.hdr), as the reference manual of Radiance describes them: "File Formats", section "Picture File Format".
#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "scene/base/error.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"
#include "scene/film/color_image_parts.h"

namespace airlight::scene {
namespace {

using Rgbe = std::array<unsigned char, 4>;  // three mantissas and their exponent

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), file_(read_whole_file(path, most_image_bytes)) {}

  ColorImage read() {
    read_header();
    require_size(path_, image_.width, image_.height);
    image_.rgb.reserve(3 * std::size_t(image_.width) * std::size_t(image_.height));
    std::vector<Rgbe> row(std::size_t(image_.width));
    for (int y = 0; y < image_.height; ++y) {
      read_row(row, y);
      // Other programs decode a mantissa without Radiance's half step upwards, too: 0 stays 0.
      for (const Rgbe& p : row)
        for (int c = 0; c < 3; ++c)
          image_.rgb.push_back(p[3] ? float(std::ldexp(double(p[std::size_t(c)]), p[3] - 136) / exposure_) : 0);
    }
    return std::move(image_);
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw Error(fmt::format("{}: {}", path_, fmt::format(format, std::forward<Args>(args)...)));
  }

  std::string next_line() {
    const std::size_t end = file_.find('\n', at_);
    if (end == std::string::npos || end - at_ > 4096) fail("damaged Radiance picture: its header has no end");
    std::string line = file_.substr(at_, end - at_);
    at_ = end + 1;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
  }

  void read_header() {
    if (file_.rfind("#?", 0) != 0) fail("no Radiance picture ({} bytes)", file_.size());
    next_line();
    bool known = false;
    for (std::string line = next_line(); !line.empty(); line = next_line()) {
      if (line.rfind("FORMAT=", 0) == 0) {
        if (line != "FORMAT=32-bit_rle_rgbe") fail("found {}, expected FORMAT=32-bit_rle_rgbe", printable(line, 80));
        known = true;
      } else if (line.rfind("EXPOSURE=", 0) == 0) {
        double factor = 0;
        if (!(std::istringstream(line.substr(9)) >> factor) || !(factor > 0 && std::isfinite(factor)))
          fail("found {}, expected a number above 0", printable(line, 80));
        exposure_ *= factor;
      }
    }
    if (!known) fail("damaged Radiance picture: its header has no FORMAT");
    if (!(exposure_ > 0 && std::isfinite(exposure_))) fail("the product of its exposures is {}", exposure_);
    const std::string size = next_line();
    std::istringstream in(size);
    std::string down, right;
    long long width = 0, height = 0;
    if (!(in >> down >> height >> right >> width) || down != "-Y" || right != "+X")
      fail("found '{}', expected -Y HEIGHT +X WIDTH (rows from the top)", printable(size, 80));
    require_size(path_, width, height);
    image_.width = int(width);
    image_.height = int(height);
  }

  unsigned char next(int row) {
    if (at_ >= file_.size()) fail("damaged Radiance picture: it ends in row {} of {}", row, image_.height);
    return static_cast<unsigned char>(file_[at_++]);
  }

  void read_row(std::vector<Rgbe>& row, int y) {
    Rgbe first;
    for (unsigned char& byte : first) byte = next(y);
    const bool in_planes = row.size() >= 8 && row.size() < 32768 && first[0] == 2 && first[1] == 2 && first[2] < 128;
    if (!in_planes) return read_pixels(row, y, first);
    if (std::size_t(first[2]) * 256 + first[3] != row.size())
      fail("damaged Radiance picture: row {} has {} pixels, expected {}", y, first[2] * 256 + first[3], row.size());
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t x = 0; x < row.size();) {
        const unsigned char code = next(y);
        const std::size_t count = code > 128 ? code - 128u : code;
        if (count == 0 || count > row.size() - x) fail("damaged Radiance picture: a run leaves row {}", y);
        const unsigned char repeated = code > 128 ? next(y) : 0;
        for (std::size_t end = x + count; x < end; ++x) row[x][c] = code > 128 ? repeated : next(y);
      }
  }

  // Pixel by pixel, where (1, 1, 1, n) repeats the pixel before n times; several such in turn give n's digits, lowest first.
  void read_pixels(std::vector<Rgbe>& row, int y, Rgbe pixel) {
    int digits = 0;
    for (std::size_t x = 0;;) {
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
        const std::size_t count = digits < 3 ? std::size_t(pixel[3]) << (8 * digits) : row.size() + 1;
        if (x == 0 || count > row.size() - x) fail("damaged Radiance picture: a run leaves row {}", y);
        for (std::size_t end = x + count; x < end; ++x) row[x] = row[x - 1];
        ++digits;
      } else {
        row[x++] = pixel;
        digits = 0;
      }
      if (x == row.size()) return;
      for (unsigned char& byte : pixel) byte = next(y);
    }
  }

  std::string path_, file_;
  std::size_t at_ = 0;
  double exposure_ = 1;
  ColorImage image_;
};

}  // namespace

ColorImage read_radiance(const std::string& path) { return Reader(path).read(); }

}  // namespace airlight::scene
