// Counter-based random numbers: Philox4x32-10 (Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3").
//
// Every number is a pure function of (seed, stream, pixel, sample, dimension), so that a result depends on no thread
// and no order of evaluation. A dimension is (vertex of the path, purpose, index): a branch that draws more numbers
// never shifts the ones of another purpose or a later vertex.
//
//   counter = (low word of the dimension, sample low, sample high, pixel),  key = (seed, stream + high word << 8)
//
// with dimension = vertex * 2^28 + purpose * 2^24 + index < 2^56. Streams: 0 reference, 1 test, 2.. independent
// repeats, at most 255.
#pragma once
#include <array>
#include <cstdint>

namespace airlight {

using PhiloxCounter = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;

inline PhiloxCounter philox4x32_10(PhiloxCounter c, PhiloxKey k) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t(0xD2511F53u) * c[0];
    const std::uint64_t p1 = std::uint64_t(0xCD9E8D57u) * c[2];
    c = {std::uint32_t(p1 >> 32) ^ c[1] ^ k[0], std::uint32_t(p1), std::uint32_t(p0 >> 32) ^ c[3] ^ k[1],
         std::uint32_t(p0)};
    k[0] += 0x9E3779B9u;
    k[1] += 0xBB67AE85u;
  }
  return c;
}

// A uniform in (0, 1) from 64 random bits: an odd multiple of 2^-53, never 0 and never 1. Long optical depths need it:
// with 24 bits none above 17.3 can be drawn.
inline double uniform53(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t(high) << 32 | low) >> 12;
  return (double(bits) + 0.5) * 0x1p-52;
}

// A uniform in (0, 1) from 32 random bits, for choices and directions.
inline double uniform32(std::uint32_t bits) { return (double(bits) + 0.5) * 0x1p-32; }

// 128 random bits, as two fine uniforms, or one fine and two coarse, or four coarse.
struct RandomBlock {
  PhiloxCounter words;
  double fine(int i) const { return uniform53(words[2 * i], words[2 * i + 1]); }  // i = 0, 1
  double coarse(int i) const { return uniform32(words[i]); }                      // i = 0..3
};

enum class Purpose : std::uint32_t { camera, flight, light, connection, scatter, transmittance, retry, late_retry };

// All random numbers of one sample of one pixel.
class SampleRandom {
 public:
  SampleRandom(std::uint32_t seed, std::uint32_t stream, std::uint32_t pixel, std::uint64_t sample)
      : seed_(seed), stream_(stream), pixel_(pixel), sample_(sample) {}

  // vertex < 2^28, index < 2^24.
  RandomBlock block(std::uint32_t vertex, Purpose purpose, std::uint32_t index = 0) const {
    const std::uint32_t low = vertex << 28 | std::uint32_t(purpose) << 24 | index;
    return {philox4x32_10({low, std::uint32_t(sample_), std::uint32_t(sample_ >> 32), pixel_},
                          {seed_, stream_ + ((vertex >> 4) << 8)})};
  }

 private:
  std::uint32_t seed_, stream_, pixel_;
  std::uint64_t sample_;
};

}  // namespace airlight
