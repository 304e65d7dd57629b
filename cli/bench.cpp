#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iostream>

#include "base/text_file.hpp"
#include "commands.hpp"
#include "device/launch_trace.hpp"
#include "device/median_time.hpp"
#include "device/peak.hpp"
#include "device/tuner.hpp"
#include "learning/bench_steps.hpp"
#include "mcdbn/learning/learning_settings.hpp"
#include "roofline.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

constexpr std::size_t kTimedRuns = 15;  // whose launches are timed: the median counts
constexpr double kTunedPairs = 5;       // a tuner measures so often (tuner.cpp)
constexpr double kLongest_s = 600;      // of a measurement: no machine is steady for longer

struct BenchOptions {
  bool tune = false;
  bool roofline = false;
  std::filesystem::path trace;
  std::vector<std::string> layers;
  double seconds = 1.0;
};

/// Adds the median time, the launches and what follows from them to the step's description.
nlohmann::ordered_json measure(Device& device, const BenchStep& step, double seconds,
                               double peak_gflops) {
  step.run();  // builds programs
  std::uint64_t runs = 0;
  const auto launches_before = device.launch_count();
  const double median_s = median_time_s(
      device,
      [&] {
        ++runs;
        step.run();
      },
      seconds);
  const auto launches = (device.launch_count() - launches_before) / runs;

  nlohmann::ordered_json result = step.what;
  result["median_us"] = median_s * 1e6;
  result["launches"] = launches;
  if (step.what.contains("frames"))
    result["us_per_frame"] = median_s * 1e6 / step.what["frames"].get<double>();
  if (step.flops > 0) {
    result["gflops"] = step.flops / median_s * 1e-9;
    result["percent_of_peak"] = 100.0 * step.flops / median_s * 1e-9 / peak_gflops;
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
  if (result.contains("us_per_frame"))
    std::cout << fmt::format(" {:>7.2f} us a frame", result["us_per_frame"].get<double>());
  std::cout << std::endl;
}

/// The steps of the layers that were named; without any, all but the epochs, which are long.
std::vector<BenchStepMaker> wanted_steps(const std::vector<std::string>& layers) {
  std::vector<BenchStepMaker> makers = bench_steps();
  if (layers.empty()) return makers;
  for (BenchStepMaker& maker : epoch_steps()) makers.push_back(std::move(maker));
  std::erase_if(makers, [&](const BenchStepMaker& maker) {
    return std::ranges::count(layers, maker.layer) == 0;
  });
  return makers;
}

/// Seconds of all these steps.
double steps_s(Device& device, const std::vector<BenchStepMaker>& makers, double seconds) {
  double sum_s = 0;
  for (const BenchStepMaker& maker : makers) {
    const BenchStep step = maker.make(device);
    step.run();  // builds programs
    sum_s += median_time_s(device, step.run, seconds);
  }
  return sum_s;
}

/// Sets and keeps what suits the device, by mini-batches of the usual sizes: of CRBMs, and of
/// fine-tuning, which takes most of its time for products.
void tune_by_steps(Device& device, double seconds) {
  const auto time_of = [&](const std::vector<BenchStepMaker>& makers) {
    return [&, makers](const Tuning&) { return steps_s(device, makers, seconds / kTunedPairs); };
  };
  const TuningNotice notice = [](const std::string& measured) { spdlog::info("{}", measured); };
  const TunedWork work{.products_s = time_of({fine_tuning_steps().front()}),
                       .minibatches_s = time_of(crbm_minibatch_steps(LearningSettings{}.batch))};
  if (!tune(device, tuning_for_units(device, notice), work, seconds, notice))
    spdlog::warn(
        "the tuning serves this run alone: it cannot be kept in the user's cache folder "
        "($XDG_CACHE_HOME/mcdbn-cl, or ~/.cache/mcdbn-cl)");
}

void run_bench(const CommandContext& context, const BenchOptions& options) {
  if (options.tune && options.seconds == 0)
    throw ConfigError("--tune needs more than one run: give --seconds above 0");
  Device device = Device::open({context.platform, context.device});
  if (options.tune) tune_by_steps(device, options.seconds);
  const double peak_gflops = measure_peak_gflops(device);
  nlohmann::ordered_json results = nlohmann::ordered_json::array();
  if (!context.json)
    std::cout << fmt::format("{}, {} compute units: {:.1f} GFLOP/s with fma alone\n",
                             device.info().name, device.info().compute_units, peak_gflops);
  LaunchTrace trace;
  for (const BenchStepMaker& maker : wanted_steps(options.layers)) {
    const BenchStep step = maker.make(device);
    results.push_back(measure(device, step, options.seconds, peak_gflops));
    if (!context.json) print_line(step, results.back());
    if (!options.roofline && options.trace.empty()) continue;
    const StepTimes times = time_kernels(device, step.run, step.kernels, kTimedRuns);
    trace.add(described(step.what), times.last_times);
    if (!options.roofline) continue;
    results.back()["roofline"] = roofline(device, times, peak_gflops);
    if (!context.json) print_roofline(results.back()["roofline"]);
  }
  if (!options.trace.empty()) write_text_file(options.trace, trace.json().dump() + '\n');
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
      "bench",
      "Times the mini-batch of each layer, products, regeneration and generation on a device");
  const auto options = std::make_shared<BenchOptions>();
  command
      ->add_option(
          "--only", options->layers,
          "Layers to measure (default: all but epoch): gaussian_crbm, binary_crbm, "
          "persistent_gaussian_crbm, persistent_binary_crbm, mrbm, joint_likelihood, fine_tuning, "
          "mrbm_chain, gemm, regeneration, generation, epoch (a thousand to a million frames)")
      ->check(CLI::IsMember({"gaussian_crbm", "binary_crbm", "persistent_gaussian_crbm",
                             "persistent_binary_crbm", "mrbm", "joint_likelihood", "fine_tuning",
                             "mrbm_chain", "gemm", "regeneration", "generation", "epoch"}))
      ->type_name("LAYER");
  command->add_flag(
      "--tune", options->tune,
      "First tune the kernels for the device; the result is kept in the user's cache folder");
  command->add_flag(
      "--roofline", options->roofline,
      "Also compare each kernel's arithmetic and memory traffic with the device's limits");
  mark_output(command->add_option(
                  "--trace", options->trace,
                  "Write the launches of one run of each step, for chrome://tracing or Perfetto"),
              context)
      ->type_name("FILE.json");
  command
      ->add_option("--seconds", options->seconds,
                   "Seconds for each measurement; 0: run once, to check that it works")
      ->check(in_range(within(0, kLongest_s)))
      ->capture_default_str();
  add_device_options(*command, context);
  add_json_option(*command, context);
  add_quiet_option(*command, context);
  command->footer("Example:\n  mcdbn-cl bench --only gaussian_crbm --json");
  run_with(*command, context, options, run_bench);
}

}  // namespace mcdbn::cli
