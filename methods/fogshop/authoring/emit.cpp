#include "methods/fogshop/authoring/emit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "methods/fogshop/authoring/draws.h"
#include "scene/base/error.h"

namespace airlight::fogshop::authoring {

std::vector<Gaussian> particles(const Emitter& emitter, double time) {
  // Where the living may be among the births, one more on either side; each is then asked for its age.
  const double first = std::max(0.0, std::floor((time - emitter.life - emitter.t0) * emitter.rate) - 1);
  const double last = std::ceil((std::min(time, emitter.t1) - emitter.t0) * emitter.rate) + 1;
  if (last - first > double(GaussianList::greatest) || !(last < 0x1p32))
    throw Error(fmt::format("rate {:g} 1/s: more than {} particles are alive, or 2^32 were born", emitter.rate,
                            GaussianList::greatest));
  std::vector<Gaussian> alive;
  for (double k = first; k <= last; ++k) {
    const double birth = emitter.t0 + k / emitter.rate, age = time - birth;
    if (!(birth < emitter.t1) || !(age >= 0) || !(age < emitter.life)) continue;
    const double s = age / emitter.life;
    Gaussian gaussian;
    gaussian.a = emitter.a0 + (emitter.a1 - emitter.a0) * s;
    gaussian.c = emitter.c0 + (emitter.c1 - emitter.c0) * s;
    const Vec3 velocity = emitter.velocity + emitter.spread * Draws(emitter.seed, std::uint32_t(k)).ball();
    gaussian.b = emitter.position + velocity * age + 0.5 * age * age * emitter.acceleration;
    gaussian.color = emitter.color;
    gaussian.tag = emitter.tag;
    alive.push_back(gaussian);
  }
  return alive;
}

}  // namespace airlight::fogshop::authoring
