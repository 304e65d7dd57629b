#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/interruption.hpp"
#include "learning/checkpoint_file.hpp"

namespace mcdbn {

/// The checkpoints of one training: what its finished stages made and where the running one stands,
/// in one file, written whole or not at all; the last two are kept, so that there is one to go on
/// from if the other is damaged.
class Checkpoints {
 public:
  using Visit = std::function<void(TrainingState&)>;

  struct Options {
    std::filesystem::path folder;           ///< holds checkpoint.safetensors, and the one before it
    std::chrono::duration<double> every{};  ///< from one to the next
    /// The training's own: what it writes beside its parameters.
    Visit extra_state = [](TrainingState&) {};
    /// Called when a checkpoint could not be written; the training goes on.
    std::function<void(const std::string&)> warn = [](const std::string&) {};
  };

  /// Reads what is there to go on from. @throws InputError if none that is there can be read
  explicit Checkpoints(Options options);

  /// Begins a stage, or restores it: `result` of a finished one, `result` and `running` of an
  /// interrupted one. Called for every stage of a training, in order.
  /// @param result what is needed of the stage when it is over
  /// @param running what else it changes
  /// @return number of its mini-batches that are done; nothing: it is over
  std::optional<std::size_t> begin(const std::string& stage, Visit result, Visit running);
  /// Ends the stage: its result stays in all further checkpoints, the first of which is written.
  void end();

  /// Whether it is time for the next one.
  bool due() const { return Clock::now() - last_ >= options_.every; }
  /// @param done mini-batches of the running stage  @throws InputError if it cannot be written
  void write(std::size_t done);
  /// As write(), but an error is only a warning.
  void try_to_write(std::size_t done);

  static bool exist_in(const std::filesystem::path& folder);
  /// Deletes the last but one, to free disk space.
  static void drop_previous(const std::filesystem::path& folder);

 private:
  using Clock = std::chrono::steady_clock;
  Options options_;
  std::optional<CheckpointContent> found_;
  std::map<std::string, TrainingState::Content> finished_;
  std::string stage_;  ///< the running one; empty between two
  Visit result_, running_;
  Clock::time_point last_ = Clock::now();
};

/// One stage of a training as it goes through its mini-batches. With checkpoints it stops between
/// two of them and writes one; without it stops at once, as nothing is kept.
class StageRun {
 public:
  /// Begins or restores a stage, as Checkpoints::begin(). @param checkpoints none: nothing is kept
  StageRun(Device& device, Checkpoints* checkpoints, const std::string& stage,
           const Checkpoints::Visit& result, const Checkpoints::Visit& running);

  bool is_over() const { return !done_; }
  /// Number of mini-batches that were done when it was begun or restored.
  std::size_t done() const { return done_.value_or(0); }
  /// After each mini-batch that is enqueued.
  /// @throws Interrupted once a checkpoint is written, if there are any
  void after_step(std::size_t done);
  void end();

 private:
  Device& device_;
  /// With checkpoints, from the first mini-batch on; before, while kernels are built, nothing is
  /// lost.
  std::optional<InterruptionDeferred> deferred_;
  Checkpoints* checkpoints_;
  std::optional<std::size_t> done_ = 0;
};

}  // namespace mcdbn
