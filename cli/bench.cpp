#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "bench_steps.hpp"
#include "commands.hpp"
#include "mcdbn/device/peak.hpp"

namespace mcdbn::cli {
namespace {

struct BenchOptions {
  std::vector<std::string> layers;
  double seconds = 1.0;
};

double elapsed_s(const std::chrono::steady_clock::time_point& start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Seconds of `count` runs, enqueued one after another as an epoch does, a run.
double time_runs_s(Device& device, const BenchStep& step, std::size_t count) {
  device.finish();
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < count; ++i) step.run();
  device.finish();
  return elapsed_s(start) / static_cast<double>(count);
}

/// Adds the median time, the launches and what follows from them to the step's description.
nlohmann::ordered_json measure(Device& device, const BenchStep& step, double seconds,
                               double peak_gflops) {
  constexpr double kSampleS = 0.01;  // long enough that the clock and the queue's end do not count
  constexpr std::size_t kFewestSamples = 5;
  step.run();  // builds programs
  const auto launches_before = device.launch_count();
  const double once_s = time_runs_s(device, step, 1);
  const auto launches = device.launch_count() - launches_before;
  const auto runs = static_cast<std::size_t>(std::clamp(kSampleS / once_s, 1.0, 1000.0));
  std::vector<double> samples_s;
  const auto start = std::chrono::steady_clock::now();
  while (samples_s.size() < kFewestSamples || elapsed_s(start) < seconds)
    samples_s.push_back(time_runs_s(device, step, runs));
  const auto middle = samples_s.begin() + static_cast<std::ptrdiff_t>(samples_s.size() / 2);
  std::nth_element(samples_s.begin(), middle, samples_s.end());

  nlohmann::ordered_json result = step.what;
  result["median_us"] = *middle * 1e6;
  result["launches"] = launches;
  if (step.flops > 0) {
    result["gflops"] = step.flops / *middle * 1e-9;
    result["percent_of_peak"] = 100.0 * step.flops / *middle * 1e-9 / peak_gflops;
  }
  return result;
}

/// "gaussian_crbm  visible 96  order 5 …"
std::string described(const nlohmann::ordered_json& what) {
  std::string text = what.at("layer").get<std::string>();
  for (const auto& [name, value] : what.items())
    if (name != "layer")
      text +=
          fmt::format("  {} {}", name, value.is_string() ? value.get<std::string>() : value.dump());
  return text;
}

void print_line(const BenchStep& step, const nlohmann::ordered_json& result) {
  std::cout << fmt::format("{:<76} {:>10.1f} us {:>6} launches", described(step.what),
                           result["median_us"].get<double>(), result["launches"].get<int>());
  if (result.contains("gflops"))
    std::cout << fmt::format(" {:>7.1f} GFLOP/s {:>5.1f} % of peak", result["gflops"].get<double>(),
                             result["percent_of_peak"].get<double>());
  std::cout << std::endl;
}

void run_bench(const CommandContext& context, const BenchOptions& options) {
  Device device = Device::open({context.platform, context.device});
  const double peak_gflops = measure_peak_gflops(device);
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  if (!context.json)
    std::cout << fmt::format("{}, {} compute units: {:.1f} GFLOP/s with fma alone\n",
                             device.info().name, device.info().compute_units, peak_gflops);
  for (const BenchStepMaker& make : bench_steps()) {
    const BenchStep step = make(device);
    const auto& wanted = options.layers;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(),
                                     step.what.at("layer").get<std::string>()) == wanted.end())
      continue;
    results.push_back(measure(device, step, options.seconds, peak_gflops));
    if (!context.json) print_line(step, results.back());
  }
  if (context.json) {
    const nlohmann::ordered_json report = {{"device", device.info().name},
                                           {"driver", device.info().driver_version},
                                           {"compute_units", device.info().compute_units},
                                           {"peak_gflops", peak_gflops},
                                           {"steps", results}};
    std::cout << report.dump(2) << '\n';
  }
}

}  // namespace

void add_bench_command(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "bench", "Times the mini-batch of each layer, products and regeneration on a device");
  const auto options = std::make_shared<BenchOptions>();
  command
      ->add_option("--only", options->layers,
                   "Layers to measure (default: all): gaussian_crbm, binary_crbm, mrbm, gemm, "
                   "regeneration")
      ->check(CLI::IsMember({"gaussian_crbm", "binary_crbm", "mrbm", "gemm", "regeneration"}))
      ->type_name("LAYER");
  command->add_option("--seconds", options->seconds, "Time for each measurement")
      ->check(CLI::Range(0.0, 600.0))
      ->capture_default_str();
  add_device_options(*command, context);
  add_json_option(*command, context);
  command->footer("Example:\n  mcdbn-cl bench --only gaussian_crbm --json");
  command->callback(
      [&context, options] { context.run = [&context, options] { run_bench(context, *options); }; });
}

}  // namespace mcdbn::cli
