#include "mcdbn/motion_model/run_folder.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "base/folder_lock.hpp"
#include "base/text_file.hpp"
#include "base/utf8.hpp"
#include "learning/checkpoints.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "motion_model/run_record.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;

constexpr const char *kModelFile = "model.safetensors", *kMetricsFile = "metrics.jsonl",
                     *kRunFile = "run.json", *kUnfinished = "unfinished";
/// The model at last: while it is among the unfinished files the others may be, too.
constexpr std::array kResults{"config.toml", kMetricsFile, kModelFile};

/// What is recorded is text, and files are recorded by their absolute names.
void check_names(const ListedClip& clip) {
  const std::string file = fs::absolute(clip.file).lexically_normal().string();
  require_utf8(file, file + ": its name");
  require_utf8(clip.person, file + ": its person");
  require_utf8(clip.action, file + ": its action");
}

bool holds_training(const fs::path& path) {
  for (const char* name : kResults)
    if (fs::exists(path / name)) return true;
  return fs::exists(path / kUnfinished);
}

}  // namespace

/// Hides FolderLock from the public header.
class RunFolder::Lock : public FolderLock {
 public:
  using FolderLock::FolderLock;
};

RunFolder::RunFolder(fs::path path, std::unique_ptr<Lock> lock)
    : path_(std::move(path)), lock_(std::move(lock)) {}
RunFolder::RunFolder(RunFolder&&) noexcept = default;
RunFolder::~RunFolder() = default;

fs::path RunFolder::unfinished() const {
  return path_ / kUnfinished;
}

fs::path RunFolder::model() const {
  return path_ / kModelFile;
}

RunFolder RunFolder::begin(const fs::path& path, const TrainingConfig& config,
                           const std::vector<ListedClip>& clips, bool replace,
                           const fs::path& start) {
  for (const ListedClip& clip : clips) check_names(clip);
  make_folder(path);  // gone again, if nothing is kept in it, with the command's other outputs
  const OutputsAtOnce at_once;
  RunFolder run(path, std::make_unique<Lock>(path));
  if (holds_training(path) && !replace)
    throw ConfigError(fmt::format(
        "{}: holds a training already; `force` trains anew in its place, `resume` goes on with one "
        "that was interrupted",
        path.string()));
  run.config_ = config;
  run.clips_ = clips;
  run.begun_here_ = true;
  try {
    run.write_start_record(start);
  } catch (...) {
    run.discard_if_untrained();  // of a full disk nothing is left that stands in the way later
    throw;
  }
  return run;
}

void RunFolder::write_start_record(const fs::path& start) {
  std::error_code error;
  fs::remove_all(unfinished(), error);
  make_folder(unfinished());
  write_text_file(unfinished() / kResults[0], settings_toml(config_));
  if (!start.empty()) {
    const TrainingClip file = identify_clip(start);
    require_utf8(file.path, file.path + ": its name");
    started_from_ = {file.path, file.fingerprint};
    write_text_file(start_model(), read_text_file(start));
  }
  write_run_record(unfinished() / kRunFile, {config_, clips_, started_from_});
}

RunFolder RunFolder::resume(const fs::path& path) {
  if (!holds_training(path))
    throw InputError(fmt::format("{}: holds no training to go on with", path.string()));
  RunFolder run(path, std::make_unique<Lock>(path));
  if (fs::exists(run.unfinished() / kModelFile)) run.put_in_place();
  const fs::path record = run.unfinished() / kRunFile;
  if (!fs::exists(record)) {
    if (!fs::exists(run.model()))
      throw InputError(fmt::format(
          "{}: the training there was interrupted before it began; begin it with --force",
          path.string()));
    std::error_code error;
    fs::remove_all(run.unfinished(), error);
    run.complete_ = true;
    return run;
  }
  RunRecord content = read_run_record(record);
  run.config_ = content.config;
  run.clips_ = std::move(content.clips);
  run.started_from_ = std::move(content.from);
  return run;
}

bool RunFolder::discard_if_untrained() {
  std::error_code error;
  const fs::path metrics = unfinished() / kMetricsFile;
  const bool learnt = Checkpoints::exist_in(unfinished()) ||
                      fs::exists(unfinished() / kModelFile, error) ||
                      (fs::exists(metrics, error) && !fs::is_empty(metrics, error));
  if (!begun_here_ || complete_ || learnt) return false;
  fs::remove_all(unfinished(), error);
  return true;
}

void RunFolder::complete(const Model& model) {
  const OutputsAtOnce at_once;
  const fs::path file = unfinished() / kModelFile;
  const auto save = [&](const fs::path& to) -> std::optional<std::string> {
    try {
      save_model(to, model, config_.half_precision ? StoredNumbers::half : StoredNumbers::single);
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  };
  auto failure = save(file);
  if (failure) {
    Checkpoints::drop_previous(unfinished());
    failure = save(file);
  }
  if (failure) {
    const fs::path elsewhere = make_temporary_folder() / kModelFile;
    if (!elsewhere.has_parent_path() || save(elsewhere))
      throw InputError(fmt::format(
          "{}; make room, then go on from the last checkpoint: mcdbn-cl train --resume {}",
          *failure, path_.string()));
    throw InputError(fmt::format("{}; the model lies in {}: make room and move it to {}", *failure,
                                 elsewhere.string(), this->model().string()));
  }
  put_in_place();
}

void RunFolder::put_in_place() {
  // From here on nothing has to be trained, however this ends.
  std::error_code error;
  fs::remove(unfinished() / kRunFile, error);
  fs::remove(this->model(), error);
  for (const char* name : kResults) {
    const fs::path from = unfinished() / name;
    if (!fs::exists(from, error)) continue;
    fs::rename(from, path_ / name, error);
    if (error)
      throw InputError(
          fmt::format("{}: cannot be put in place: {}", from.string(), error.message()));
  }
  fs::remove_all(unfinished(), error);
  complete_ = true;
}

}  // namespace mcdbn
