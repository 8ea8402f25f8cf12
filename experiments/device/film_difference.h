// How far two films of one picture are apart where rounding alone should part them.
#pragma once
#include "scene/film/film.h"

namespace airlight::experiments {

// The value that `share` of |b - a| / (a + 1 % of the greatest a) of a layer lie below; infinite if anything is not finite.
double difference_quantile(const scene::Film& a, const scene::Film& b, const std::string& layer, double share);

}  // namespace airlight::experiments
