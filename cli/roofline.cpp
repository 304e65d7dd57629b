#include "roofline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "device/peak.hpp"

namespace mcdbn::cli {
namespace {

using Json = nlohmann::ordered_json;

Json kernel_roofline(Device& device, const KernelRate& rate, double peak_gflops) {
  Json kernel = {
      {"kernel", rate.work.kernel}, {"launches", rate.launches}, {"us", rate.seconds * 1e6}};
  if (rate.work.bytes <= 0) return kernel;
  const double gbytes_per_s = rate.work.bytes / rate.seconds * 1e-9;
  const double read_gbytes_per_s =
      measure_read_gbytes_per_s(device, static_cast<std::size_t>(rate.work.bytes));
  const double gflops = rate.work.flops / rate.seconds * 1e-9;
  const double intensity = rate.work.flops / rate.work.bytes;
  const double roof_gflops = std::min(peak_gflops, intensity * read_gbytes_per_s);
  kernel["flops"] = rate.work.flops;
  kernel["bytes"] = rate.work.bytes;
  kernel["flops_per_byte"] = intensity;
  kernel["gflops"] = gflops;
  kernel["percent_of_peak"] = 100.0 * gflops / peak_gflops;
  kernel["gbytes_per_s"] = gbytes_per_s;
  kernel["percent_of_bandwidth"] = 100.0 * gbytes_per_s / read_gbytes_per_s;
  kernel["bound"] = roof_gflops < peak_gflops ? "memory" : "arithmetic";
  return kernel;
}

}  // namespace

Json roofline(Device& device, const StepTimes& times, double peak_gflops) {
  Json kernels = Json::array();
  for (const KernelRate& rate : times.kernels)
    kernels.push_back(kernel_roofline(device, rate, peak_gflops));
  return {{"kernels", kernels}, {"between_launches_us", times.between_s * 1e6}};
}

void print_roofline(const Json& roofline) {
  for (const Json& kernel : roofline.at("kernels")) {
    std::cout << fmt::format("  {:<26} {:>3} launches {:>9.1f} us",
                             kernel["kernel"].get<std::string>(), kernel["launches"].get<int>(),
                             kernel["us"].get<double>());
    if (kernel.contains("bytes"))
      std::cout << fmt::format(
          " {:>6.1f} flops/byte {:>6.1f} GFLOP/s {:>4.1f} % of peak {:>6.1f} GB/s {:>4.1f} % of "
          "bandwidth, bound by {}",
          kernel["flops_per_byte"].get<double>(), kernel["gflops"].get<double>(),
          kernel["percent_of_peak"].get<double>(), kernel["gbytes_per_s"].get<double>(),
          kernel["percent_of_bandwidth"].get<double>(), kernel["bound"].get<std::string>());
    std::cout << '\n';
  }
  std::cout << fmt::format("  {:<26} {:>12} {:>9.1f} us\n", "between launches", "",
                           roofline.at("between_launches_us").get<double>());
}

}  // namespace mcdbn::cli
