#include "sampling_options.hpp"

#include <fmt/format.h>

#include "mcdbn/base/errors.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

/// Samples run as one batch and each step of a chain is a launch: more is a typing error.
constexpr int kMost = 1000;
/// Draws ten times as far from their mean as the model's carry no information any more.
constexpr double kHottest = 10.0;
/// Usual temperature of several samples of a calibrated model: at 1 they deviate half as far as its
/// answers are off, at 2 as far. The best of ten on detectors' tracks is 18 % better than their
/// mean at 2, and 10 % at 1 (docs/results.md).
constexpr double kSeveral = 2.0;

/// @param drawn a single answer is drawn, too
double usual_temperature(const RegenerationOptions& options, bool drawn) {
  if (options.samples > 1) return options.sampling.steady ? kSeveral : 1.0;
  return drawn ? 1.0 : 0.0;
}

}  // namespace

const char* SamplingOptions::drawing_flag() const {
  if (samples.value_or(1) > 1) return "--samples";
  if (temperature.value_or(0) > 0) return "--temperature";
  if (gibbs_steps.value_or(0) > 0) return "--gibbs-steps";
  if (mrbm_gibbs_steps.value_or(0) > 0) return "--mrbm-gibbs-steps";
  return nullptr;
}

RegenerationOptions SamplingOptions::regeneration(const Mcdbn& network, std::uint64_t seed) const {
  RegenerationOptions options;
  options.samples = samples.value_or(1);
  options.seed = seed;
  options.sampling = network.sampling;
  if (gibbs_steps || mrbm_gibbs_steps) {
    // Algorithm 5 as it stands: drawn anew in every frame, the temperature as it was given.
    options.sampling = {};
    options.sampling.gibbs_steps = gibbs_steps.value_or(mrbm_gibbs_steps ? 0 : 1);
    options.sampling.mrbm_gibbs_steps = mrbm_gibbs_steps.value_or(0);
  }
  const bool anew = gibbs_steps.value_or(0) > 0 || mrbm_gibbs_steps.value_or(0) > 0;
  options.temperature =
      temperature.value_or(usual_temperature(options, anew || network.sampling.sampled));
  if (options.samples > 1 && !options.samples_decoder() && !options.samples_mrbm())
    throw ConfigError(fmt::format(
        "--samples {}: all would be the mean-field answer; give a --temperature above 0 and "
        "--gibbs-steps or --mrbm-gibbs-steps above 0, or leave these options out",
        options.samples));
  return options;
}

void add_sampling_options(CLI::App& command, SamplingOptions& options, const char* samples_help) {
  command.add_option("--samples", options.samples, samples_help)->check(in_range(within(1, kMost)));
  command
      .add_option("--temperature", options.temperature,
                  "0: the mean-field answer; the higher, the further variations are from it "
                  "(default: 2 with several samples; 1 with --gibbs-steps or --mrbm-gibbs-steps, "
                  "or for a model trained with --regeneration-sampled; else 0)")
      ->check(in_range(within(0, kHottest)));
  command
      .add_option(
          "--gibbs-steps", options.gibbs_steps,
          "Draw every frame anew, with k steps in the decoder (Algorithm 5; default: as the "
          "model was trained for)")
      ->check(in_range(within(0, kMost)));
  command
      .add_option("--mrbm-gibbs-steps", options.mrbm_gibbs_steps,
                  "Draw every frame anew, with k steps of the chain that infers each sample's 3D "
                  "code")
      ->check(in_range(within(0, kMost)));
}

}  // namespace mcdbn::cli
