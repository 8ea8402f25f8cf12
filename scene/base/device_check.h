// Whether a component may compute on its device.
#pragma once
#include <functional>

#include "scene/base/component.h"

namespace airlight::scene {

// Throws Unavailable where the component must not compute on its device.
using DeviceCheck = std::function<void(const Component&)>;

// Sets the check that Renderer::prepare and Solver::start ask for components with a device; empty (the default): none is
// made. Not thread safe: the program sets it before it begins to work.
void set_device_check(DeviceCheck);

// Asks that check.
void check_device(const Component&);

}  // namespace airlight::scene
