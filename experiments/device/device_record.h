// What `airlight doctor --check` found on a device. It is kept for this program, this device and its driver, and a method that failed is
// refused there.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/device/parity.h"

namespace airlight::experiments {

struct DeviceRecord {
  std::string checked;  // when (UTC)
  std::vector<Parity> findings;
};

// $XDG_CACHE_HOME/airlight/devices, or ~/.cache/airlight/devices; empty where neither XDG_CACHE_HOME nor HOME is set.
std::filesystem::path device_records();

// The record of the device in use; nothing where it was not checked by this program, with this driver and these shaders. A file that is
// damaged counts as not there, and one line says so. Throws NoDevice.
std::optional<DeviceRecord> find_device_record();

// Replaces the record of the device in use, and returns the file. Throws CannotWrite, NoDevice; Error where there is no folder for it.
std::filesystem::path keep_device_record(const DeviceRecord&);

// Throws Unavailable, with the finding, if the method failed on the device in use. For scene::set_device_check.
void refuse_failed_method(const scene::Component&);

}  // namespace airlight::experiments
