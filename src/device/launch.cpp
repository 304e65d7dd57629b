#include "device/launch.hpp"

#include <algorithm>
#include <bit>
#include <chrono>

#include "base/interruption.hpp"
#include "device/opencl_errors.hpp"

namespace mcdbn {
namespace {

void enqueue_on(const cl::CommandQueue& queue, const cl::Kernel& kernel, const LaunchSize& size,
                cl::Event* event) {
  const auto& [global, group] = size;
  const cl::NDRange local = group[0] == 0 ? cl::NullRange : cl::NDRange(group[0], group[1]);
  queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(global[0], global[1]), local,
                             nullptr, event);
}

/// How long a kernel ran, by the device's clock.
double run_s(const cl::Event& event) {
  const auto started_ns = event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
             ended_ns = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
  return ended_ns > started_ns ? 1e-9 * static_cast<double>(ended_ns - started_ns) : 0.0;
}

/// Waits for the launch, alone on a queue that keeps times: what it takes beyond the run counts as
/// compiling.
cl::Event run_for_the_first_time(Device& device, const cl::Kernel& kernel, const LaunchSize& size) {
  using Clock = std::chrono::steady_clock;
  device.finish();
  const auto begin = Clock::now();
  const cl::CommandQueue queue(device.context(), CL_QUEUE_PROFILING_ENABLE);
  cl::Event event;
  enqueue_on(queue, kernel, size, &event);
  run_interruptibly([queue] { queue.finish(); });
  const std::chrono::duration<double> took = Clock::now() - begin;
  device.programs().count_compiling(std::max(took.count() - run_s(event), 0.0));
  return event;
}

}  // namespace

void keep_pace(Device& device) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kShortest = std::chrono::milliseconds(50),
                 kLongest = std::chrono::milliseconds(150);
  constexpr std::size_t kMostLaunches = 1U << 16U;
  thread_local std::size_t launches = 0, together = 1;
  thread_local Clock::time_point last = Clock::now();
  if (++launches < together) return;
  device.finish();
  const auto took = Clock::now() - last;
  if (took < kShortest) together = std::min(2 * together, kMostLaunches);
  if (took > kLongest) together = std::max<std::size_t>(1, together / 2);
  launches = 0;
  last = Clock::now();
  check_interruption();
}

std::array<std::size_t, 2> local_size_for(const std::array<std::size_t, 2>& global,
                                          const DeviceInfo& info) {
  constexpr std::size_t kItems = 64;
  const std::size_t most = std::min(kItems, std::max<std::size_t>(info.largest_group, 1));
  const auto power_of_two_in = [](std::size_t number) {
    return number == 0 ? 1 : number & (~number + 1);
  };
  const auto side = [&](std::size_t range, std::size_t items, std::size_t largest) {
    return std::min(power_of_two_in(range),
                    std::bit_floor(std::max<std::size_t>(std::min(items, largest), 1)));
  };
  const std::size_t x = side(global[0], most, info.largest_group_sides[0]);
  return {x, side(global[1], most / x, info.largest_group_sides[1])};
}

void enqueue(Device& device, const cl::Kernel& kernel, const LaunchSize& size) {
  auto group = size.local;
  if (group[0] == 0 && !device.info().is_gpu) group = local_size_for(size.global, device.info());
  const LaunchSize cut{size.global, group};
  cl::Event event;
  if (device.programs().is_first_launch(kernel, group))
    event = run_for_the_first_time(device, kernel, cut);
  else
    enqueue_on(device.queue(), kernel, cut, device.keeps_launch_times() ? &event : nullptr);
  if (device.keeps_launch_times())
    device.keep_launch(kernel.getInfo<CL_KERNEL_FUNCTION_NAME>(), event);
  device.count_launch();
}

DeviceError launch_error(const Device& device, const cl::Kernel& kernel, const cl::Error& error) {
  std::string name = "a kernel";
  try {
    name = "kernel " + kernel.getInfo<CL_KERNEL_FUNCTION_NAME>();
  } catch (const cl::Error&) {
    // a lost device may not even give the name
  }
  return device_error(device.info().name, name, error);
}

}  // namespace mcdbn
