// The room device: OpenCL: devices, programs, matrices, products, pointwise work, updates, tuning.
// It uses base.
// Installed are the headers of devices, matrices, parameters and tuning.
// Add here: a kernel in kernels/, its host side here (pointwise.cpp shows the pattern).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mcdbn/device/opencl.hpp"
#include "mcdbn/device/tuning.hpp"

namespace mcdbn {

struct DeviceInfo {
  int platform_index = 0;
  std::string platform_name;
  int device_index = 0;  ///< within its platform
  std::string name, vendor, driver_version, opencl_c_version;
  bool is_gpu = false;
  unsigned compute_units = 0;
  std::uint64_t global_memory_bytes = 0;
  std::uint64_t local_memory_bytes = 0;
  std::uint64_t largest_buffer_bytes = 0;
  std::size_t largest_group = 1;                            ///< work-items of a work-group, at most
  std::array<std::size_t, 3> largest_group_sides{1, 1, 1};  ///< of them in each dimension
  unsigned preferred_vector_width = 1;                      ///< floats
  unsigned native_vector_width = 1;                         ///< floats
};

/// Every device of every OpenCL platform; platforms without devices are passed over.
/// Empty where there is none.
std::vector<DeviceInfo> list_devices();

/// The list as text, one device a line; where there is none, what to install.
std::string describe_devices(const std::vector<DeviceInfo>& devices);

/// The device that the user asked for: an index or part of a name (case-insensitive); empty: any. A
/// number that is no index is part of a name.
struct DeviceSelection {
  std::string platform;
  std::string device;
  /// MCDBN_PLATFORM and MCDBN_DEVICE, as far as set.
  static DeviceSelection from_environment();
};

/// The devices of list_devices() that match, in its order.
std::vector<DeviceInfo> matching_devices(const DeviceSelection& selection);
/// Those of these devices that match, in their order.
std::vector<DeviceInfo> matching_devices(std::vector<DeviceInfo> devices,
                                         const DeviceSelection& selection);

/// When a kernel ran, in nanoseconds of the device's own clock.
struct LaunchTime {
  std::string kernel;
  std::uint64_t queued_ns = 0, started_ns = 0, ended_ns = 0;
};

class ProgramCache;  // of the library's own kernels; its header is not installed

/// An open device with one in-order queue and the programs built for it.
/// Cheap to pass by reference; everything else on the device refers to it and must not outlive it.
class Device {
 public:
  /// The device that matches; with nothing selected a GPU where there is one, else the CPU.
  /// @throws DeviceError listing what there is, if nothing matches or no platform exists
  static Device open(const DeviceSelection& selection = DeviceSelection::from_environment());
  explicit Device(const DeviceInfo& info);
  Device(Device&&) noexcept;
  ~Device();

  const DeviceInfo& info() const { return info_; }
  const cl::Context& context() const { return context_; }
  const cl::CommandQueue& queue() const { return queue_; }
  ProgramCache& programs() { return *programs_; }
  /// The user's tuned choices for this device, else what suits its kind.
  const Tuning& tuning() const { return tuning_; }
  /// Sets the tuning, limited to what the device can do.
  void set_tuning(const Tuning& tuning);
  /// Waits until everything enqueued has run. @throws DeviceError
  void finish();
  /// Kernel launches since the device was opened: `bench` reports launches a step.
  std::uint64_t launch_count() const { return launch_count_; }
  void count_launch() { ++launch_count_; }

  /// Whether from here on the time of every kernel launch is kept, which costs a little of it.
  /// @throws DeviceError
  void keep_launch_times(bool keep);
  /// True while keep_launch() must be called after each launch; if a library call launches several
  /// kernels, keep the last event.
  bool keeps_launch_times() const { return keeps_launch_times_; }
  void keep_launch(std::string kernel, const cl::Event& event);
  /// Times of the launches since the last call, in order; waits for the queue. @throws DeviceError
  std::vector<LaunchTime> take_launch_times();

 private:
  DeviceInfo info_;
  Tuning tuning_;
  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::unique_ptr<ProgramCache> programs_;
  std::uint64_t launch_count_ = 0;
  bool keeps_launch_times_ = false;
  std::vector<std::pair<std::string, cl::Event>> kept_launches_;
};

}  // namespace mcdbn
