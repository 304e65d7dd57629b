#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "mcdbn/corpus/clip_list.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

/// The folder of a training. What is being trained lies in its folder `unfinished`: run.json, the
/// settings and the clips that the training was begun with; config.toml; metrics.jsonl; the last
/// two checkpoints. When all is done model.safetensors, config.toml and metrics.jsonl are put where
/// they belong, in place of those of a training before, and `unfinished` is gone: the three always
/// belong together. While one program trains there no other can (FolderLock).
class RunFolder {
 public:
  /// Makes the folder and notes what is going to be trained.
  /// @param replace where there is a training already, finished or not: its `unfinished` goes now,
  /// its model when the new one is there
  /// @param start a model file that the training starts from, of which a copy is kept; or none
  /// @throws ConfigError if there is one and it is not to be replaced, Error if another program
  /// trains there, InputError
  static RunFolder begin(const std::filesystem::path& path, const TrainingConfig& config,
                         const std::vector<ListedClip>& clips, bool replace,
                         const std::filesystem::path& start = {});
  /// One that was interrupted.
  /// @throws InputError if there is none, Error if another program trains there
  static RunFolder resume(const std::filesystem::path& path);

  RunFolder(RunFolder&&) noexcept;
  ~RunFolder();

  const TrainingConfig& config() const { return config_; }
  const std::vector<ListedClip>& clips() const { return clips_; }
  /// The model that the training starts from, if it does; its file is start_model().
  const std::optional<StartedFrom>& started_from() const { return started_from_; }
  std::filesystem::path start_model() const { return unfinished() / "start.safetensors"; }
  /// Whether all is done already.
  bool is_complete() const { return complete_; }
  std::filesystem::path unfinished() const;
  std::filesystem::path model() const;  ///< where it will be
  /// Where its clips are kept as they were read (cached_training_clips); gone with `unfinished`.
  std::filesystem::path clip_cache() const { return unfinished() / "clips.cache"; }

  /// Discards what begin() made, if nothing was learnt since: a training that was refused before
  /// its first epoch needs no `replace` the next time. @return whether it did
  bool discard_if_untrained();

  /// The model is there: everything is put where it belongs. On a full disk the checkpoint before
  /// the last makes room; if that will not do the model goes to the folder for temporary files.
  /// @throws InputError naming the place of what was trained
  void complete(const Model& model);

 private:
  class Lock;

  RunFolder(std::filesystem::path path, std::unique_ptr<Lock> lock);
  void write_start_record(const std::filesystem::path& start);
  void put_in_place();

  std::filesystem::path path_;
  std::unique_ptr<Lock> lock_;
  TrainingConfig config_;
  std::vector<ListedClip> clips_;
  std::optional<StartedFrom> started_from_;
  bool begun_here_ = false, complete_ = false;
};

}  // namespace mcdbn
