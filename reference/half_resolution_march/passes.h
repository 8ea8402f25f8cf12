// The passes of a picture: what ends film rays, the march of the blocks, the composition.
#pragma once
#include <algorithm>
#include <memory>

#include "reference/half_resolution_march/low_film.h"
#include "reference/half_resolution_march/march.h"
#include "scene/picture.h"

namespace airlight::half_resolution_march {

// Values that are prepared once for a scene.
struct Plan {
  std::shared_ptr<const scene::Scene> scene;
  Options options;
  std::shared_ptr<const lit_media::LitMedia> media;
};

// Is there anything that can end a camera ray before infinity? And anything to be seen behind the media?
bool ends_rays(const scene::Scene&);
bool seen_behind(const scene::Scene&);

struct Counters {
  lit_media::Counters media;
  long long rays = 0;    // marched
  long long pixels = 0;  // camera rays whose end was looked up
  double longest = 0;    // way of a marched ray through media [m]
  // Marched pixels that meet media, after the first picture: `used` are blended with the last picture, `rejected` are
  // not in it, `clamped` are used and were limited by `clamp`.
  long long history_used = 0, history_rejected = 0, history_clamped = 0;
  void operator+=(const Counters& other) {
    media += other.media;
    rays += other.rays;
    pixels += other.pixels;
    longest = std::max(longest, other.longest);
    history_used += other.history_used;
    history_rejected += other.history_rejected;
    history_clamped += other.history_clamped;
  }
};

// By film pixel. Empty where there is nothing to know.
struct Behind {
  std::vector<double> depth;  // along the camera's axis [m], infinite where nothing ends the ray
  std::vector<Rgb> radiance;  // of what ends the ray, without media between [W/m^2/sr]
};
double bytes_needed(const Plan&, const scene::View&);

Behind look_behind(const Plan&, const scene::View&, const scene::Execution&, Counters&);

// Where the ray of a block was in the last picture.
struct Trace {
  bool in_media = false;  // the ray meets any
  bool seen = false;      // the last camera saw the point that is looked for
  double x = 0, y = 0;    // on the last film [film pixels]
  double depth = 0;       // that what ends the ray has along the last camera's axis [m]; infinite where nothing does
};

struct Marched {
  LowFilm film;
  std::vector<Trace> traces;  // by block; none without a last picture
};

// One ray for each block and frame, and the depth of each block. Offsets begin with those of frame `first`. `last`: what the last picture
// was seen by, null where there is none.
Marched march_blocks(const Plan&, const scene::View&, const Behind&, int first, const scene::View* last,
                     const scene::Execution&, Counters&);

// Why steps are too coarse for the view, in one line, or nothing.
std::string doubt_of(const lit_media::LitMedia&, const Options&, const scene::Scene&, const scene::View&);

// `edge`: difference of depth [m] that counts as one.
void compose(const Plan&, const scene::View&, const LowFilm&, double edge, const Behind&, const scene::PictureLayers&,
             const scene::Execution&);

}  // namespace airlight::half_resolution_march
