#include "mcdbn/device/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <functional>

#include "base/interruption.hpp"
#include "device/opencl_errors.hpp"
#include "device/program.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr const char* kInstallHint =
    "install an OpenCL driver: pocl-opencl-icd for any CPU, or the GPU vendor's; PoCL also "
    "vanishes "
    "where neither HOME nor POCL_CACHE_DIR is a writable folder";

std::string trimmed(std::string text) {
  while (!text.empty() &&
         (text.back() == '\0' || std::isspace(static_cast<unsigned char>(text.back()))))
    text.pop_back();
  return text;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Keeps the devices whose index is wanted or, where no index is, a part of whose name.
void keep_wanted(std::vector<DeviceInfo>& devices, const std::string& wanted,
                 int DeviceInfo::*index, std::string DeviceInfo::*name) {
  const auto has_index = [&](const DeviceInfo& info) {
    return std::to_string(info.*index) == wanted;
  };
  const auto has_name = [&](const DeviceInfo& info) {
    return lower(info.*name).find(lower(wanted)) != std::string::npos;
  };
  if (std::ranges::any_of(devices, has_index))
    std::erase_if(devices, std::not_fn(has_index));
  else
    std::erase_if(devices, std::not_fn(has_name));
}

std::vector<cl::Platform> platforms() {
  std::vector<cl::Platform> found;
  try {
    cl::Platform::get(&found);
  } catch (const cl::Error&) {
    found.clear();  // the ICD loader reports "no platform" as an error
  }
  return found;
}

std::vector<cl::Device> devices_of(const cl::Platform& platform) {
  std::vector<cl::Device> found;
  try {
    platform.getDevices(CL_DEVICE_TYPE_ALL, &found);
  } catch (const cl::Error&) {
    found.clear();
  }
  return found;
}

DeviceInfo describe(const cl::Platform& platform, int platform_index, const cl::Device& device,
                    int device_index) {
  DeviceInfo info;
  info.platform_index = platform_index;
  info.platform_name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
  info.device_index = device_index;
  info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
  info.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
  info.driver_version = trimmed(device.getInfo<CL_DRIVER_VERSION>());
  info.opencl_c_version = trimmed(device.getInfo<CL_DEVICE_OPENCL_C_VERSION>());
  info.is_gpu = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU) != 0;
  info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  info.global_memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
  info.local_memory_bytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
  info.largest_buffer_bytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
  info.largest_group = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  const auto sides = device.getInfo<CL_DEVICE_MAX_WORK_ITEM_SIZES>();
  std::copy_n(sides.begin(), std::min(sides.size(), info.largest_group_sides.size()),
              info.largest_group_sides.begin());
  info.preferred_vector_width = device.getInfo<CL_DEVICE_PREFERRED_VECTOR_WIDTH_FLOAT>();
  info.native_vector_width = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
  return info;
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> list;
  const auto all_platforms = platforms();
  for (std::size_t p = 0; p < all_platforms.size(); ++p) {
    const auto devices = devices_of(all_platforms[p]);
    for (std::size_t d = 0; d < devices.size(); ++d) {
      try {
        list.push_back(
            describe(all_platforms[p], static_cast<int>(p), devices[d], static_cast<int>(d)));
      } catch (const cl::Error&) {
        // one that cannot be queried cannot be worked with
      }
    }
  }
  return list;
}

std::string describe_devices(const std::vector<DeviceInfo>& devices) {
  if (devices.empty()) return fmt::format("no OpenCL device found: {}", kInstallHint);
  std::string text;
  for (const auto& info : devices)
    text += fmt::format("{}platform {} ({}), device {}: {}", text.empty() ? "" : "\n",
                        info.platform_index, info.platform_name, info.device_index, info.name);
  return text;
}

DeviceSelection DeviceSelection::from_environment() {
  const auto value = [](const char* name) {
    const char* text = std::getenv(name);
    return std::string(text ? text : "");
  };
  return {value("MCDBN_PLATFORM"), value("MCDBN_DEVICE")};
}

std::vector<DeviceInfo> matching_devices(const DeviceSelection& selection) {
  return matching_devices(list_devices(), selection);
}

std::vector<DeviceInfo> matching_devices(std::vector<DeviceInfo> devices,
                                         const DeviceSelection& selection) {
  keep_wanted(devices, selection.platform, &DeviceInfo::platform_index, &DeviceInfo::platform_name);
  keep_wanted(devices, selection.device, &DeviceInfo::device_index, &DeviceInfo::name);
  return devices;
}

Device Device::open(const DeviceSelection& selection) {
  const auto fitting = matching_devices(selection);
  if (fitting.empty()) {
    const auto all = list_devices();
    if (all.empty()) throw DeviceError(describe_devices(all));
    throw DeviceError(
        fmt::format("no OpenCL device matches platform '{}', device '{}'; there is:\n{}",
                    selection.platform, selection.device, describe_devices(all)));
  }
  const auto gpu = std::find_if(fitting.begin(), fitting.end(),
                                [](const DeviceInfo& info) { return info.is_gpu; });
  return Device(gpu != fitting.end() ? *gpu : fitting.front());
}

Device::Device(const DeviceInfo& info) : info_(info) {
  try {
    const auto platform = platforms().at(static_cast<std::size_t>(info.platform_index));
    device_ = devices_of(platform).at(static_cast<std::size_t>(info.device_index));
    context_ = cl::Context(device_);
    queue_ = cl::CommandQueue(context_, device_);
    programs_ = std::make_unique<ProgramCache>(context_, device_);
  } catch (const cl::Error& error) {
    throw device_error(info.name, "opening the device", error);
  } catch (const std::out_of_range&) {
    throw DeviceError(fmt::format("no such device: {}", info.name));
  }
  set_tuning(load_tuning(info).value_or(default_tuning(info)));
}

Device::Device(Device&&) noexcept = default;
Device::~Device() = default;

void Device::keep_launch_times(bool keep) {
  finish();
  queue_ = checked(info_.name, "a queue that keeps times", [&] {
    return cl::CommandQueue(context_, device_,
                            keep ? CL_QUEUE_PROFILING_ENABLE : cl_command_queue_properties{0});
  });
  keeps_launch_times_ = keep;
}

void Device::keep_launch(std::string kernel, const cl::Event& event) {
  kept_launches_.emplace_back(trimmed(std::move(kernel)), event);
}

std::vector<LaunchTime> Device::take_launch_times() {
  finish();
  std::vector<LaunchTime> times;
  times.reserve(kept_launches_.size());
  checked(info_.name, "times of launches", [&] {
    for (const auto& [kernel, event] : kept_launches_)
      times.push_back({kernel, event.getProfilingInfo<CL_PROFILING_COMMAND_QUEUED>(),
                       event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
                       event.getProfilingInfo<CL_PROFILING_COMMAND_END>()});
  });
  kept_launches_.clear();
  return times;
}

void Device::set_tuning(const Tuning& tuning) {
  tuning_ = limited(tuning, info_);
  programs_->set_unroll(tuning_.unroll);
}

void Device::finish() {
  checked(info_.name, "waiting for the device",
          [&] { run_interruptibly([queue = queue_] { queue.finish(); }); });
}

}  // namespace mcdbn
