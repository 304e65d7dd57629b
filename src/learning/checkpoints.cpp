#include "learning/checkpoints.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/interruption.hpp"
#include "base/output_file.hpp"
#include "base/shown.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;

constexpr const char *kLast = "checkpoint.safetensors",
                     *kPrevious = "checkpoint.previous.safetensors",
                     *kNext = "checkpoint.next.safetensors";

TrainingState::Content saved(const Checkpoints::Visit& visit) {
  TrainingState::Content content;
  TrainingState state = TrainingState::saving(content);
  visit(state);
  return content;
}

void restore(TrainingState::Content& content, const Checkpoints::Visit& visit) {
  TrainingState state = TrainingState::restoring(content);
  visit(state);
}

}  // namespace

Checkpoints::Checkpoints(Options options) : options_(std::move(options)) {
  std::string damage;
  for (const char* name : {kLast, kPrevious}) {
    const fs::path path = options_.folder / name;
    if (found_ || !fs::exists(path)) continue;
    try {
      found_ = read_checkpoint(path);
    } catch (const InputError& error) {
      damage = error.what();
    }
  }
  if (!damage.empty() && !found_) throw InputError(damage);
  if (!damage.empty()) options_.warn(damage + "; gone on from the one before it");
  if (found_) restore(found_->extra_state, options_.extra_state);
}

std::optional<std::size_t> Checkpoints::begin(const std::string& stage, Visit result,
                                              Visit running) {
  stage_ = stage;
  result_ = std::move(result);
  running_ = std::move(running);
  if (!found_) return 0;
  if (const auto finished = found_->finished_stages.find(stage);
      finished != found_->finished_stages.end()) {
    restore(finished->second, result_);
    finished_[stage] = std::move(finished->second);
    return {};
  }
  const CheckpointContent stages = std::exchange(found_, {}).value();
  if (stages.running_stage.empty()) return 0;
  if (stages.running_stage != stage)
    throw InputError(fmt::format("{}: of another training: it stands in {}, not {}",
                                 stages.running_state.file, shown(stages.running_stage), stage));
  TrainingState::Content state = stages.running_state;
  restore(state, result_);
  restore(state, running_);
  return stages.done_minibatches;
}

void Checkpoints::end() {
  finished_[stage_] = saved(result_);
  stage_.clear();
  result_ = running_ = [](TrainingState&) {};
  try_to_write(0);
}

void Checkpoints::write(std::size_t done) {
  last_ = Clock::now();
  const TrainingState::Content now = saved([this](TrainingState& state) {
    result_(state);
    running_(state);
  });
  const fs::path last = options_.folder / kLast;
  const OutputsAtOnce at_once;
  write_checkpoint(options_.folder / kNext,
                   {finished_, stage_, done, now, saved(options_.extra_state)});
  std::error_code error;
  if (fs::exists(last)) fs::rename(last, options_.folder / kPrevious, error);
  fs::rename(options_.folder / kNext, last, error);
  if (error)
    throw InputError(fmt::format("{}: cannot be replaced: {}", last.string(), error.message()));
}

void Checkpoints::try_to_write(std::size_t done) {
  try {
    write(done);
  } catch (const InputError& error) {
    options_.warn(fmt::format("no checkpoint, the training goes on: {}", error.what()));
  }
}

bool Checkpoints::exist_in(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / kLast, error) || fs::exists(folder / kPrevious, error);
}

void Checkpoints::drop_previous(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / kPrevious, ignored);
}

StageRun::StageRun(Device& device, Checkpoints* checkpoints, const std::string& stage,
                   const Checkpoints::Visit& result, const Checkpoints::Visit& running)
    : device_(device), checkpoints_(checkpoints) {
  if (checkpoints_) done_ = checkpoints_->begin(stage, result, running);
}

void StageRun::after_step(std::size_t done) {
  if (!checkpoints_) return check_interruption();
  if (!deferred_) {
    device_.finish();
    deferred_.emplace();
  }
  const bool stop = interruption_requested();
  if (stop || checkpoints_->due()) checkpoints_->try_to_write(done);
  if (stop) throw Interrupted("interrupted");
}

void StageRun::end() {
  if (checkpoints_) checkpoints_->end();
}

}  // namespace mcdbn
