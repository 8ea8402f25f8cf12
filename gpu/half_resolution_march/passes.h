// The passes of a picture on the device: what ends rays, the march of the blocks, the blur, and film pixels from blocks; surfaces and
// layers by gpu/ray_marcher/picture.h. All that a scene needs for them lies here, uploaded once.
#pragma once
#include <memory>

#include "gpu/lit_media/lit_media.h"
#include "gpu/ray_marcher/picture.h"
#include "reference/half_resolution_march/options.h"

namespace airlight::gpu::half_resolution_march {

using airlight::half_resolution_march::Options;

// The last picture: its marched film before the blur, and what saw it.
struct History {
  const Buffer& film;
  const scene::View& view;
};

class Passes {
 public:
  // Uploads, and makes the lights' maps: stages of the timer. Throws Unavailable where the device has no room, Interrupted if `progress`
  // says so.
  Passes(Context&, std::shared_ptr<const scene::Scene>, const Options&, ray_marcher::GridStorage, FirstHits::Way,
         StageTimer&, const std::function<bool(double)>& progress);

  // Becomes the passes of the next frame where programs and buffers serve it, and uploads what has changed. False, and nothing is done, where
  // they do not.
  bool become(std::shared_ptr<const scene::Scene>, StageTimer&, const std::function<bool(double)>& progress);

  const lit_media::LitMedia& media() const { return lit_; }
  const ray_marcher::RayEnds& ends() const { return ends_; }
  bool marches() const { return march_ != nullptr; }
  // Is there anything to be seen? Only then there is a picture to draw.
  bool draws() const { return march_ || ray_marcher::something_behind(*plan_.scene, plan_.lights.size()); }

  // Draws a picture into the frame and notes its layers for the download. Offsets begin with those of frame `first`. `last`: what is
  // blended in, null where there is nothing. `low`: the marched film before the blur, of low_bytes(view). `looks` as in Rounds.
  void draw(const scene::View&, int first, const History* last, const Buffer& low, Frame&, bool looks,
            const std::function<bool(double)>& progress);
  std::size_t low_bytes(const scene::View&) const;
  // After Frame::finish: false where rounds were too few, and the picture must be drawn again.
  bool finished(const Download&) const;
  // Counters of the last finished picture; nothing if no layer was wanted.
  std::map<std::string, double> counters(const scene::View&, const Download&) const;

 private:
  void set_blocks(Program&, const scene::View&) const;
  void find_depths(const scene::View&, const Buffer* distances, const Buffer& blocks, Frame&);
  void march(const scene::View&, int first, const Buffer& blocks, Frame&);
  void blend(const scene::View&, const History*, const Buffer& blocks, const Buffer& low);
  const Buffer& blur(const scene::View&, const Buffer& low, Frame&);
  void upsample(const scene::View&, const Buffer* distances, const Buffer& blocks, const Buffer& low,
                const ray_marcher::Band&);

  Context& context_;
  Options options_;
  airlight::lit_media::Plan plan_;
  ray_marcher::RayEnds ends_;
  lit_media::LitMedia lit_;
  airlight::ray_marcher::Options columns_;  // not read: light comes by maps, or undimmed
  ray_marcher::Picture picture_;
  ray_marcher::Rounds rounds_;
  // Null where no medium extinguishes.
  Program *low_depths_ = nullptr, *march_ = nullptr, *first_ = nullptr, *blend_ = nullptr, *blur_ = nullptr,
          *upsample_ = nullptr;
};

}  // namespace airlight::gpu::half_resolution_march
