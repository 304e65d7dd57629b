#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/energy.hpp"
#include "mcdbn/machines/partition.hpp"
#include "mcdbn/machines/sampling.hpp"
#include "modality_options.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

struct ScoreOptions {
  std::filesystem::path model, output;
  MatrixInput data;
  std::vector<std::string> modalities;  ///< NAME=FILE, of an MRBM
  bool log_partition = false;
  AisSettings annealing;
  std::vector<const CLI::Option*> of_log_partition;  ///< to check whether they were given
};

/// A number for each row that has a history.
struct Score {
  std::string name;
  Eigen::VectorXd values;
};

Eigen::VectorXd column_of(const Sequences& numbers, std::size_t from) {
  return stacked(numbers.to_host(), from).col(0).cast<double>();
}

/// @return the mean over units of squared errors, a row each
Eigen::VectorXd squared_errors(const MatrixF& data, const MatrixF& again) {
  return (data - again).cast<double>().cwiseAbs2().rowwise().mean();
}

Eigen::VectorXd reconstruction_errors(const Cdbn& stack, const Sequences& data) {
  const Sequences again = reconstruct(stack, data);
  return squared_errors(stacked(data.to_host(), again.valid_from),
                        stacked(again.to_host(), again.valid_from));
}

std::vector<Score> scores_of(const Cdbn& stack, const Sequences& data, std::uint64_t seed) {
  const std::size_t from = stack.total_order();
  std::vector<Score> scores = {{"free_energy", column_of(free_energy(stack, data), from)},
                               {"reconstruction_error", reconstruction_errors(stack, data)}};
  const Crbm& lowest = stack.layers.front();
  if (stack.layers.size() == 1 && lowest.shape().kind == VisibleKind::binary)
    scores.push_back(
        {"pseudo_log_likelihood", column_of(pseudo_log_likelihood(lowest, data, seed), from)});
  return scores;
}

/// log Z of an RBM. @throws ConfigError for other machines
LogPartition partition_of(const Cdbn& stack, const AisSettings& settings) {
  if (stack.layers.size() > 1)
    throw ConfigError("--log-partition: a stack has none that is known; it takes a single RBM");
  if (stack.total_order() > 0)
    throw ConfigError(
        "--log-partition: a machine with a history has one for each; it takes a single RBM");
  return log_partition(stack.layers.front(), settings);
}

/// log p of each row as the data are: that of scaled columns, in the machine's own deviations where
/// it has learnt some, less the logarithms of these scales.
Score log_likelihood(const Score& free_energy, const LogPartition& partition,
                     const SavedMachine& saved, const Crbm& machine) {
  const auto log_sum = [](const MatrixF& deviation) {
    return deviation.cast<double>().array().log().sum();
  };
  double scale = 0;
  if (!saved.scales.empty()) scale = log_sum(saved.scales.front().deviation);
  if (machine.has_deviation) scale += log_sum(machine.visible_deviation.to_host());
  return {"log_likelihood", (-free_energy.values.array() - partition.value - scale).matrix()};
}

/// The columns, and what else is known of the machine.
struct Scores {
  std::vector<Score> columns;
  std::optional<LogPartition> partition;
};

Scores stack_scores(Device& device, const SavedMachine& saved, const ScoreOptions& options) {
  const Cdbn stack = stack_of(saved, options.model);
  if (options.data.files.empty()) throw ConfigError("data: no files");
  const Sequences data =
      Sequences::from_host(device, checked_and_scaled(saved, stack, options.data));
  Scores scores{scores_of(stack, data, options.annealing.seed), {}};
  if (options.log_partition) {
    scores.partition = partition_of(stack, options.annealing);
    scores.columns.push_back(
        log_likelihood(scores.columns.front(), *scores.partition, saved, stack.layers.front()));
  }
  return scores;
}

/// Scores of each row of all modalities together, and the reconstruction error of each modality.
Scores mrbm_scores(Device& device, const SavedMachine& saved, const ScoreOptions& options) {
  const Mrbm& mrbm = mrbm_of(saved, options.model, "--modality");
  if (options.log_partition)
    throw ConfigError("--log-partition: an MRBM has none that is known; it takes a single RBM");
  if (!options.data.files.empty())
    throw ConfigError("data: those of an MRBM are given by --modality NAME=FILE");
  const MrbmUnits data =
      mrbm_units(device, saved, mrbm, read_modalities(options.modalities, options.data.tensor));
  const std::vector<Modality>& modalities = mrbm.shape().modalities;
  for (std::size_t m = 0; m < modalities.size(); ++m)
    if (!data.given[m])
      throw ConfigError(fmt::format("--modality {}=FILE: wanted, a score is of all modalities",
                                    modalities[m].name));
  const std::vector<Rows> rows(data.units.begin(), data.units.end());
  const std::vector<Matrix> again = reconstruct(mrbm, rows);
  Scores scores{{{"free_energy", free_energy(mrbm, rows).to_host().col(0).cast<double>()}}, {}};
  for (std::size_t m = 0; m < modalities.size(); ++m)
    scores.columns.push_back({"reconstruction_error_" + modalities[m].name,
                              squared_errors(data.units[m].to_host(), again[m].to_host())});
  return scores;
}

void print_scores(const CommandContext& context, const Scores& scores) {
  const auto& [columns, partition] = scores;
  nlohmann::ordered_json report;
  report["rows"] = columns.front().values.size();
  if (partition) {
    report["log_partition"] = partition->value;
    report["log_partition_error"] = partition->standard_error;
  }
  for (const Score& score : columns) report[score.name] = score.values.mean();
  if (context.json) {
    std::cout << report.dump(2) << '\n';
    return;
  }
  std::size_t width = 24;
  for (const auto& [name, value] : report.items()) width = std::max(width, name.size() + 1);
  for (const auto& [name, value] : report.items())
    std::cout << fmt::format(
        "{:<{}}{}\n", name, width,
        value.is_number_integer() ? value.dump() : fmt::format("{:.6g}", value.get<double>()));
}

void run_score(const CommandContext& context, const ScoreOptions& options) {
  check_matrix_output(options.output);
  check_settings(options.annealing);
  for (const CLI::Option* option : options.of_log_partition)
    if (option->count() > 0 && !options.log_partition)
      throw ConfigError(option->get_name() + " is for --log-partition");
  Device device = Device::open({context.platform, context.device});
  const SavedMachine saved = load_machine(device, options.model);
  const bool joint = std::holds_alternative<Mrbm>(saved.machine) || !options.modalities.empty();
  const Scores scores =
      joint ? mrbm_scores(device, saved, options) : stack_scores(device, saved, options);
  print_scores(context, scores);
  if (options.output.empty()) return;
  MatrixF table(scores.columns.front().values.size(),
                static_cast<Eigen::Index>(scores.columns.size()));
  for (std::size_t i = 0; i < scores.columns.size(); ++i)
    table.col(static_cast<Eigen::Index>(i)) = scores.columns[i].values.cast<float>();
  put_matrix(options.output, table);
}

}  // namespace

void add_score_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<ScoreOptions>();
  CLI::App* command = app.add_subcommand(
      "score", "Scores how well a single machine models data, means over the rows");
  add_machine_option(*command, options->model);
  add_matrix_input(*command, options->data, "data", "Matrices, each a sequence of its own");
  add_modality_option(*command, options->modalities,
                      "Data of an MRBM, in place of the files above: all its modalities");
  command->add_flag("--log-partition", options->log_partition,
                    "Estimate log Z of an RBM by annealed importance sampling, and with it the "
                    "log-likelihood");
  add_setting_flags(*command, options->annealing);
  for (const char* flag : {"--temperatures", "--chains"})
    options->of_log_partition.push_back(command->get_option(flag));
  add_matrix_output(*command, context, options->output,
                    "File to write, .npy, .csv or .safetensors: a row for each row that has a "
                    "history, a column for each printed score, in that order");
  add_json_option(*command, context);
  add_quiet_option(*command, context);
  add_device_options(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl score --model digits.safetensors digits.npy --log-partition --json\n"
      "  mcdbn-cl score --model m.safetensors --modality left=l.npy --modality right=r.npy\n"
      "Free energy (of a stack: its top machine's), mean squared error of the mean-field\n"
      "reconstruction, and of a binary machine the pseudo-log-likelihood of scikit-learn's\n"
      "score_samples; of an MRBM the free energy of all modalities together, and each one's\n"
      "reconstruction error. Where `fit --standardize` scaled the data, all but the "
      "log-likelihood\n"
      "are of the scaled data.");
  run_with(*command, context, options, run_score);
}

}  // namespace mcdbn::cli
