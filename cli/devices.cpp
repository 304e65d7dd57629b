#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/device/device.hpp"

namespace mcdbn::cli {
namespace {

constexpr double kBytesPerGib = 1024.0 * 1024.0 * 1024.0;

void print_as_json(const std::vector<DeviceInfo>& devices) {
  nlohmann::json list = nlohmann::json::array();
  for (const DeviceInfo& device : devices) {
    list.push_back({{"platform_index", device.platform_index},
                    {"platform", device.platform_name},
                    {"device_index", device.device_index},
                    {"name", device.name},
                    {"vendor", device.vendor},
                    {"driver", device.driver_version},
                    {"opencl_c_version", device.opencl_c_version},
                    {"type", device.is_gpu ? "gpu" : "cpu"},
                    {"compute_units", device.compute_units},
                    {"global_memory_bytes", device.global_memory_bytes},
                    {"largest_buffer_bytes", device.largest_buffer_bytes},
                    {"local_memory_bytes", device.local_memory_bytes},
                    {"largest_work_group", device.largest_group},
                    {"largest_work_group_sides", device.largest_group_sides},
                    {"preferred_vector_width", device.preferred_vector_width},
                    {"native_vector_width", device.native_vector_width}});
  }
  print_json({{"devices", list}});
}

void print_as_text(const std::vector<DeviceInfo>& devices) {
  for (const DeviceInfo& device : devices) {
    std::cout << fmt::format(
        "platform {} {}\n  device {} {}\n    driver {}, {}, {} compute units, {:.1f} GiB\n"
        "    work-groups of up to {}, {} KiB of local memory, vectors of {}\n",
        device.platform_index, device.platform_name, device.device_index, device.name,
        device.driver_version, device.opencl_c_version, device.compute_units,
        static_cast<double>(device.global_memory_bytes) / kBytesPerGib, device.largest_group,
        device.local_memory_bytes / 1024,
        std::max(device.preferred_vector_width, device.native_vector_width));
  }
}

}  // namespace

void add_devices_command(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand("devices", "Lists the OpenCL platforms and devices");
  add_json_option(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl devices --json\n  mcdbn-cl train clips/ -o run/ --device 0");
  command->callback([&context] {
    context.run = [&context] {
      const std::vector<DeviceInfo> devices = list_devices();
      if (context.json) {
        print_as_json(devices);
      } else {
        print_as_text(devices);
      }
      if (devices.empty()) throw DeviceError(describe_devices(devices));
    };
  });
}

}  // namespace mcdbn::cli
