// Tone curves: linear light to what a display shows, both linear in [0, 1], per channel unless said otherwise.
#pragma once
#include "scene/base/settings.h"
#include "scene/math/types.h"

namespace airlight::scene {

enum class Tone {
  clamp,  // cut off above 1
  aces,   // fit of the ACES film curve (Narkowicz 2015, "ACES filmic tone mapping curve")
  agx,    // AgX (Sobotka 2022): channels are mixed, then a sigmoid of the logarithm that keeps middle grey, 0.18
};

const Choices<Tone>& tones();

Rgb toned(Tone, const Rgb& linear);

}  // namespace airlight::scene
