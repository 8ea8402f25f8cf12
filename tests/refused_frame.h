// A next frame that a preparation refuses changes nothing in it.
#pragma once
#include <catch2/catch.hpp>
#include <memory>

#include "tests/pictures.h"

namespace airlight::test {

// With `light` in the place of the first light the renderer refuses the scene.
inline void check_refused_frame(const scene::Renderer& renderer, const std::shared_ptr<const scene::Scene>& still,
                                const scene::Light& light, const Given& given = {}) {
  const auto prepared = renderer.prepare(still, {renderer.settings(), given}, {1, {}});
  const scene::Film first = prepared->render(view_of(*still), {1, {}}).film;
  auto other = std::make_shared<scene::Scene>(*still);
  other->lights[0] = light;
  finish(*other);
  CHECK_FALSE(prepared->next(other, {1, {}}));
  CHECK(prepared->render(view_of(*still), {1, {}}).film.layers == first.layers);
}

}  // namespace airlight::test
