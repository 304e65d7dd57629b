#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.hpp"
#include "matrix_options.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/energy.hpp"
#include "mcdbn/machines/partition.hpp"
#include "mcdbn/machines/sampling.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

struct ScoreOptions {
  std::filesystem::path model, output;
  MatrixInput data;
  bool log_partition = false;
  AisSettings annealing;
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
Eigen::VectorXd reconstruction_errors(const Cdbn& stack, const Sequences& data) {
  const Sequences again = reconstruct(stack, data);
  const MatrixF difference =
      stacked(data.to_host(), again.valid_from) - stacked(again.to_host(), again.valid_from);
  return difference.cast<double>().cwiseAbs2().rowwise().mean();
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

/// log p of each row as the data are: that of scaled columns less the logarithms of their scales.
Score log_likelihood(const Score& free_energy, const LogPartition& partition,
                     const SavedMachine& saved) {
  double scale = 0;
  if (!saved.scales.empty())
    scale = saved.scales.front().deviation.cast<double>().array().log().sum();
  return {"log_likelihood", (-free_energy.values.array() - partition.value - scale).matrix()};
}

void print_scores(const CommandContext& context, const std::vector<Score>& scores,
                  const std::optional<LogPartition>& partition) {
  nlohmann::ordered_json report;
  report["rows"] = scores.front().values.size();
  if (partition) {
    report["log_partition"] = partition->value;
    report["log_partition_error"] = partition->standard_error;
  }
  for (const Score& score : scores)
    report[score.name] = score.values.size() == 0 ? 0.0 : score.values.mean();
  if (context.json) {
    std::cout << report.dump(2) << '\n';
    return;
  }
  for (const auto& [name, value] : report.items())
    std::cout << fmt::format("{:<24}{:.6g}\n", name, value.get<double>());
}

void run_score(const CommandContext& context, const ScoreOptions& options) {
  check_matrix_output(options.output);
  check_settings(options.annealing);
  Device device = Device::open({context.platform, context.device});
  const SavedMachine saved = load_machine(device, options.model);
  const Cdbn stack = stack_of(saved, options.model);
  const Sequences data = Sequences::from_host(
      device,
      scaled(saved, options.data.read(), stack.layers.front().shape().visible, options.data));
  std::vector<Score> scores = scores_of(stack, data, options.annealing.seed);
  std::optional<LogPartition> partition;
  if (options.log_partition) {
    partition = partition_of(stack, options.annealing);
    scores.push_back(log_likelihood(scores.front(), *partition, saved));
  }
  print_scores(context, scores, partition);
  if (options.output.empty()) return;
  MatrixF table(scores.front().values.size(), static_cast<Eigen::Index>(scores.size()));
  for (std::size_t i = 0; i < scores.size(); ++i)
    table.col(static_cast<Eigen::Index>(i)) = scores[i].values.cast<float>();
  put_matrix(options.output, table);
}

}  // namespace

void add_score_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<ScoreOptions>();
  CLI::App* command =
      app.add_subcommand("score", "Says how well a single machine knows data, means over the rows");
  add_machine_option(*command, options->model);
  add_matrix_input(*command, options->data, "data", "Matrices, each a sequence of its own")
      ->required();
  command->add_flag("--log-partition", options->log_partition,
                    "Estimate log Z of an RBM by annealed importance sampling, and with it the "
                    "log-likelihood");
  add_setting_flags(*command, options->annealing);
  add_matrix_output(*command, options->output,
                    "File to write, .npy, .csv or .safetensors: a row for each row that has a "
                    "history, its columns what is printed, in that order");
  add_json_option(*command, context);
  add_device_options(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl score --model digits.safetensors digits.npy --log-partition --json\n"
      "Free energy (of a stack: its top machine's), mean squared error of the mean-field\n"
      "reconstruction, and of a binary machine the pseudo-log-likelihood of scikit-learn's\n"
      "score_samples. Scaled data are scored as the machine sees them, but for the "
      "log-likelihood.");
  command->callback(
      [&context, options] { context.run = [&context, options] { run_score(context, *options); }; });
}

}  // namespace mcdbn::cli
