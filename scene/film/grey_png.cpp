// Grey images as PNG, by libpng without its corrections of gamma.
#include <fmt/format.h>
#include <png.h>

#include <cmath>
#include <csetjmp>
#include <cstring>
#include <memory>

#include "scene/base/atomic_file.h"
#include "scene/base/error.h"
#include "scene/base/limits.h"
#include "scene/base/printable.h"
#include "scene/base/read_file.h"
#include "scene/film/grey_image.h"
#include "scene/film/grey_image_parts.h"

namespace airlight::scene {
namespace {

// State shared by libpng's callbacks: bytes of the file, and the last message. Callbacks leave by
// longjmp, past no destructor.
struct Stream {
  const std::string* in = nullptr;
  std::size_t at = 0;
  std::string* out = nullptr;
  char words[200] = "";
};

void fail(png_structp png, png_const_charp message) {
  auto* stream = static_cast<Stream*>(png_get_error_ptr(png));
  std::strncpy(stream->words, message, sizeof stream->words - 1);
  png_longjmp(png, 1);
}
void no_warning(png_structp, png_const_charp) {}

void take(png_structp png, png_bytep bytes, png_size_t count) {
  auto* stream = static_cast<Stream*>(png_get_io_ptr(png));
  if (stream->in->size() - stream->at < count) png_error(png, "truncated");
  std::memcpy(bytes, stream->in->data() + stream->at, count);
  stream->at += count;
}
void give(png_structp png, png_bytep bytes, png_size_t count) {
  static_cast<Stream*>(png_get_io_ptr(png))->out->append(reinterpret_cast<const char*>(bytes), count);
}
void no_flush(png_structp) {}

struct Reader {
  Stream stream;
  png_structp png = nullptr;
  png_infop info = nullptr;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Header {
  png_uint_32 width = 0, height = 0;
  int depth = 0, channels = 0;  // as they are handed over: 8 or 16 bits; 1 to 4
  bool alpha = false;
};

bool read_header(Reader& r, Header& header) {
  if (setjmp(png_jmpbuf(r.png))) return false;
  png_set_read_fn(r.png, &r.stream, take);
  png_read_info(r.png, r.info);
  png_set_expand(r.png);  // palettes to colours, bits to bytes, transparency to alpha
  png_set_interlace_handling(r.png);
  png_read_update_info(r.png, r.info);
  header.width = png_get_image_width(r.png, r.info);
  header.height = png_get_image_height(r.png, r.info);
  header.depth = png_get_bit_depth(r.png, r.info);
  header.channels = png_get_channels(r.png, r.info);
  header.alpha = png_get_color_type(r.png, r.info) & PNG_COLOR_MASK_ALPHA;
  return true;
}

bool read_rows(Reader& r, std::vector<png_bytep>& rows) {
  if (setjmp(png_jmpbuf(r.png))) return false;
  png_read_image(r.png, rows.data());
  png_read_end(r.png, nullptr);
  return true;
}

}  // namespace

GreyImage read_grey_png(const std::string& path, std::size_t most_pixels) {
  const std::string file = read_whole_file(path, std::size_t(1) << 30);
  if (file.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(file.data()), 0, 8) != 0)
    throw Error(fmt::format("{}: no PNG file ({} bytes)", path, file.size()));
  Reader r;
  r.stream.in = &file;
  r.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &r.stream, fail, no_warning);
  r.info = r.png ? png_create_info_struct(r.png) : nullptr;
  if (!r.info) throw Error(fmt::format("{}: out of memory", path));
  const auto damaged = [&] { return Error(fmt::format("{}: damaged PNG: {}", path, printable(r.stream.words, 200))); };
  Header header;
  if (!read_header(r, header)) throw damaged();
  require_pixels(path, header.width, header.height, most_pixels);
  const std::size_t row = png_get_rowbytes(r.png, r.info);
  require_memory(double(row) * header.height + 8.0 * header.width * header.height,
                 fmt::format("{}: {} x {} pixels", path, header.width, header.height));
  std::vector<png_byte> bytes(row * header.height);
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < header.height; ++y) rows.push_back(bytes.data() + y * row);
  if (!read_rows(r, rows)) throw damaged();

  GreyImage image{int(header.width), int(header.height), {}, header.alpha ? "its alpha channel is ignored" : ""};
  image.values.reserve(std::size_t(header.width) * header.height);
  const int size = header.depth / 8, colours = header.channels - (header.alpha ? 1 : 0);
  for (std::size_t y = 0; y < header.height; ++y)
    for (std::size_t x = 0; x < header.width; ++x) {
      const png_byte* p = rows[y] + x * header.channels * size;
      for (int c = 1; c < colours; ++c)
        if (std::memcmp(p, p + c * size, size) != 0)
          throw Error(fmt::format("{}: column {}, row {}: colours differ, expected grey (R = G = B)", path, x, y));
      image.values.push_back(size == 2 ? (256 * p[0] + p[1]) / 65535.0 : p[0] / 255.0);
    }
  return image;
}

void write_grey_png(const std::string& path, const GreyImage& image) {
  std::vector<png_byte> bytes;
  bytes.reserve(2 * image.values.size());
  for (const double value : image.values) {
    if (!(value >= 0 && value <= 1)) throw Error(fmt::format("{}: a value of {}, expected 0 to 1", path, value));
    const long v = std::lround(65535 * value);
    bytes.push_back(png_byte(v >> 8));
    bytes.push_back(png_byte(v & 255));
  }
  std::string file;
  std::vector<png_bytep> rows;
  for (int y = 0; y < image.height; ++y) rows.push_back(bytes.data() + std::size_t(y) * image.width * 2);
  struct Writer {
    Stream stream;
    png_structp png = nullptr;
    png_infop info = nullptr;
    ~Writer() { png_destroy_write_struct(&png, &info); }
  } w;
  w.stream.out = &file;
  w.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &w.stream, fail, no_warning);
  w.info = w.png ? png_create_info_struct(w.png) : nullptr;
  if (!w.info) throw Error(fmt::format("{}: out of memory", path));
  if (setjmp(png_jmpbuf(w.png))) throw Error(fmt::format("{}: cannot encode: {}", path, w.stream.words));
  png_set_write_fn(w.png, &w.stream, give, no_flush);
  png_set_IHDR(w.png, w.info, png_uint_32(image.width), png_uint_32(image.height), 16, PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(w.png, w.info);
  png_write_image(w.png, rows.data());
  png_write_end(w.png, nullptr);
  write_file_atomically(path, file);
}

}  // namespace airlight::scene
