#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "interrupt.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "sweep.hpp"
#include "training_options.hpp"
#include "training_run.hpp"

namespace mcdbn::cli {
namespace {

struct TrainOptions {
  std::vector<std::filesystem::path> data;
  std::filesystem::path run;
  std::filesystem::path sweep;
  TrainingOptions settings;
};

void run_train(const CommandContext& context, const TrainOptions& options) {
  const TrainingConfig config = options.settings.resolve();
  config.validate();
  const auto files = find_clips(options.data);
  if (!options.sweep.empty()) {
    run_sweep(context, read_sweep_file(options.sweep), files, options.settings, options.run);
    return;
  }
  Device device = Device::open({context.platform, context.device});
  const InterruptGuard interrupt;
  train_to_folder(context, device, files, config, options.run, interrupt);
}

}  // namespace

void add_train_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App* command = app.add_subcommand("train", "Trains a model on BVH clips");
  command->add_option("data", options->data, "BVH files, or folders that hold some")
      ->required()
      ->type_name("PATH");
  command
      ->add_option("-o,--output", options->run,
                   "Run folder to write: model.safetensors, metrics.jsonl, config.toml")
      ->required()
      ->type_name("RUN");
  command
      ->add_option(
          "--sweep", options->sweep,
          "TOML file of configurations to train and compare; RUN holds one folder for each, "
          "and sweep.jsonl. Run again, it goes on where it stopped")
      ->type_name("FILE");
  options->settings.add_to(*command);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl train walks/ -o run\n"
      "  mcdbn-cl train walks/ -o run --hidden 200 --gaussian-epochs 50 --platform Portable\n"
      "  mcdbn-cl train walks/ -o sweep --sweep sweep.toml\n"
      "A sweep file: test = ['held_out/'] and [grid] with order = [3, 5], hidden = [100, 300] …, "
      "all\n"
      "combinations, or [[configuration]] tables of settings.");
  command->callback(
      [&context, options] { context.run = [&context, options] { run_train(context, *options); }; });
}

}  // namespace mcdbn::cli
