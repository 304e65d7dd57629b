#include "learning/checkpoints.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/interruption.hpp"
#include "base/output_file.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kKey = "mcdbn-checkpoint";
constexpr int kCheckpointVersion = 1;
constexpr const char *kLast = "checkpoint.safetensors",
                     *kPrevious = "checkpoint.previous.safetensors",
                     *kNext = "checkpoint.next.safetensors";
/// Between the name of a stage and that of a matrix.
constexpr char kBetween = '/';

void put(Safetensors& file, const std::string& stage, const TrainingState::Content& content) {
  const std::string prefix = stage + kBetween;
  for (const auto& [name, tensor] : content.matrices)
    file.tensors[std::string(prefix).append(name)] = tensor;
}

TrainingState::Content get(const Safetensors& file, const std::string& stage, json numbers) {
  TrainingState::Content content{std::move(numbers), {}};
  const std::string prefix = stage + kBetween;
  for (auto found = file.tensors.lower_bound(prefix);
       found != file.tensors.end() && found->first.starts_with(prefix); ++found)
    content.matrices[found->first.substr(prefix.size())] = found->second;
  return content;
}

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
      found_ = read(path);
    } catch (const InputError& error) {
      damage = error.what();
    }
  }
  if (!damage.empty() && !found_) throw InputError(damage);
  if (!damage.empty()) options_.warn(damage + "; gone on from the one before it");
  if (found_) restore(found_->more, options_.more);
}

Checkpoints::Stages Checkpoints::read(const fs::path& path) {
  const Safetensors file = read_safetensors(path);
  try {
    const json about = json::parse(file.metadata.at(kKey));
    if (about.at("format_version") != kCheckpointVersion)
      throw InputError(fmt::format("{}: a checkpoint of another version of mcdbn-cl; train anew",
                                   path.string()));
    Stages stages;
    for (const auto& [stage, numbers] : about.at("over").items())
      stages.over[stage] = get(file, stage, numbers);
    stages.running = about.at("stage");
    stages.done = about.at("done");
    stages.now = get(file, stages.running, about.at("now"));
    stages.more.numbers = about.at("more");
    return stages;
  } catch (const json::exception&) {
    throw InputError(fmt::format("{}: no checkpoint of mcdbn-cl", path.string()));
  } catch (const std::out_of_range&) {
    throw InputError(fmt::format("{}: no checkpoint of mcdbn-cl", path.string()));
  }
}

std::optional<std::size_t> Checkpoints::begin(const std::string& stage, Visit result,
                                              Visit running) {
  stage_ = stage;
  result_ = std::move(result);
  running_ = std::move(running);
  if (!found_) return 0;
  if (const auto over = found_->over.find(stage); over != found_->over.end()) {
    restore(over->second, result_);
    over_[stage] = std::move(over->second);
    return {};
  }
  const Stages stages = std::exchange(found_, {}).value();
  if (stages.running.empty()) return 0;
  if (stages.running != stage)
    throw InputError(fmt::format("the checkpoint is of another training: it stands in {}, not {}",
                                 stages.running, stage));
  TrainingState::Content now = stages.now;
  restore(now, result_);
  restore(now, running_);
  return stages.done;
}

void Checkpoints::end() {
  over_[stage_] = saved(result_);
  stage_.clear();
  result_ = running_ = [](TrainingState&) {};
  try_to_write(0);
}

void Checkpoints::write(std::size_t done) {
  last_ = Clock::now();
  Safetensors file;
  json about = {{"format_version", kCheckpointVersion},
                {"over", json::object()},
                {"stage", stage_},
                {"done", done}};
  for (const auto& [stage, content] : over_) {
    about["over"][stage] = content.numbers;
    put(file, stage, content);
  }
  const TrainingState::Content now = saved([this](TrainingState& state) {
    result_(state);
    running_(state);
  });
  about["now"] = now.numbers;
  put(file, stage_, now);
  about["more"] = saved(options_.more).numbers;
  file.metadata[kKey] = about.dump();
  const fs::path last = options_.folder / kLast;
  const OutputsAtOnce at_once;
  write_safetensors(options_.folder / kNext, file);
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
  if (!deferred_) {
    device_.finish();
    deferred_.emplace();
  }
  const bool stop = interruption_requested();
  if (checkpoints_ && (stop || checkpoints_->due())) checkpoints_->try_to_write(done);
  if (stop) throw Interrupted("interrupted");
}

void StageRun::end() {
  if (checkpoints_) checkpoints_->end();
}

}  // namespace mcdbn
