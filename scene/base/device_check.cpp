#include "scene/base/device_check.h"

#include <utility>

namespace airlight::scene {
namespace {

DeviceCheck& the_check() {
  static DeviceCheck check;
  return check;
}

}  // namespace

void set_device_check(DeviceCheck check) { the_check() = std::move(check); }

void check_device(const Component& component) {
  if (the_check() && !component.device().empty()) the_check()(component);
}

}  // namespace airlight::scene
