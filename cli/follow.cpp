#include "follow.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/interruption.hpp"
#include "base/named_errors.hpp"
#include "base/output_file.hpp"
#include "camera_options.hpp"
#include "formats/track_reading.hpp"
#include "line_source.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/frame_stream.hpp"
#include "mcdbn/formats/track_lines.hpp"
#include "mcdbn/machines/size_limits.hpp"
#include "motion_model/keypoint_columns.hpp"
#include "output_ending.hpp"
#include "regeneration_reports.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

constexpr const char *kBvh = "bvh", *kCsv = "csv", *kJson = "json";
constexpr const char* kGroup = "Track that is still growing";

/// Where frames go: a file that can be read while it is written, or standard output.
class FrameOutput {
 public:
  FrameOutput(const std::filesystem::path& path, const std::string& frames, double fps)
      : name_(path.empty() ? "standard output" : path.string()) {
    const std::string ending = ending_of(path);
    const std::string format = !frames.empty()                           ? frames
                               : ending == ".csv"                        ? kCsv
                               : ending == ".json" || ending == ".jsonl" ? kJson
                                                                         : kBvh;
    if (!path.empty()) {
      check_replaceable(path);
      file_.open(path, std::ios::binary | std::ios::trunc);
      if (!file_) throw InputError(fmt::format("{}: cannot be written", path.string()));
    }
    std::ostream& out = path.empty() ? std::cout : file_;
    stream_ = format == kCsv    ? csv_stream(out, fps)
              : format == kJson ? json_stream(out, fps)
                                : bvh_stream(out, fps, !path.empty());
  }
  ~FrameOutput() {
    try {
      finish();  // the frames so far make a complete file
    } catch (const Error& error) {
      spdlog::error("{}", error.what());
    }
  }
  FrameOutput(const FrameOutput&) = delete;
  FrameOutput& operator=(const FrameOutput&) = delete;

  /// @throws InputError naming the output
  void write(const Skeleton& skeleton, const std::vector<LiveFrame>& frames) {
    named([&] {
      for (const LiveFrame& frame : frames) {
        stream_->write(skeleton, frame.channels, frame.seen);
        ++written_;
        shows_somebody_ = shows_somebody_ || frame.seen;
      }
    });
  }
  /// No more frames will come. @throws InputError naming the output
  void finish() {
    if (!std::exchange(finished_, true)) named([&] { stream_->finish(); });
  }
  std::size_t written() const { return written_; }
  bool shows_somebody() const { return shows_somebody_; }  ///< any frame, not the mean pose alone

 private:
  template <typename Write>
  void named(const Write& write) {
    try {
      write();
    } catch (const InputError& error) {
      finished_ = true;  // nothing more can be written
      throw InputError(fmt::format("{}: {}", name_, error.what()));
    }
  }

  std::string name_;
  bool finished_ = false;
  std::ofstream file_;
  std::unique_ptr<FrameStream> stream_;
  std::size_t written_ = 0;
  bool shows_somebody_ = false;
};

/// The model's joints of which the track has no column.
/// @param like the track without frames, from which the model can regenerate
std::vector<std::string> joints_without_column(const Modalities& modalities, const Track2d& like,
                                               const ClipPlacement& placement) {
  const auto map = keypoint_map_of(modalities, like, placement);
  const Track2d shown = map ? map->joints_of(like) : like;
  std::vector<std::string> missing = modalities.track_features.joint_names();
  std::erase_if(missing, [&](const std::string& joint) { return shown.find(joint) >= 0; });
  return missing;
}

/// Regenerates a track frame by frame.
class Following {
 public:
  /// @param name the track's, for messages  @param rate_hz of frames that do not give it
  /// @throws ConfigError as LiveRegeneration
  Following(const Model& model, std::string name, std::filesystem::path output,
            ClipPlacement placement, FollowOptions options, double rate_hz)
      : model_(model),
        name_(std::move(name)),
        output_(std::move(output)),
        placement_(std::move(placement)),
        options_(std::move(options)),
        rate_hz_(rate_hz),
        nobody_(LiveRegeneration::before_anybody(model_, placement_, options_.look_ahead)) {}

  void take(const TrackFrame& frame, const TrackLines& lines) {
    if (!live_ && lines.knows_joints()) begin(lines.like());
    if (live_)
      push(frame);
    else
      write_nobody();
  }

  void take_broken() {
    if (live_)
      push(TrackFrame::unseen(joints_));
    else
      write_nobody();
  }
  bool has_frames() const { return frames_ != nullptr; }
  bool saw_anybody() const { return saw_anybody_; }  ///< any joint of the person in any frame
  bool shows_somebody() const { return frames_ && frames_->shows_somebody(); }

  /// @return frames written
  std::size_t finish() {
    if (!frames_) return 0;
    if (live_) frames_->write(live_->skeleton(), live_->finish());
    frames_->finish();
    if (live_ && !placement_.camera && shows_somebody()) report_assumed(live_->camera(), "");
    return frames_->written();
  }

 private:
  /// @param fps of the track
  FrameOutput& frames(double fps) {
    if (!frames_) frames_ = std::make_unique<FrameOutput>(output_, options_.frames, fps);
    return *frames_;
  }
  void begin(const Track2d& like) {
    joints_ = like.joint_count();
    if (placement_.camera) placement_.camera = camera_of_track(*placement_.camera, like, name_);
    live_ = with_name(name_, [&] {
      return std::make_unique<LiveRegeneration>(model_, like, placement_, options_.look_ahead);
    });
    if (const auto missing = joints_without_column(model_.modalities, like, placement_);
        !missing.empty())
      spdlog::warn("{}: {} are never seen: inferred", name_, fmt::join(missing, ", "));
    frames(like.fps);
    spdlog::info("a frame is written at most {} frames (of {:g} a second) after it came in",
                 live_->latency_frames(), model_.modalities.fps);
  }
  void push(const TrackFrame& frame) {
    saw_anybody_ = saw_anybody_ || (frame.confidence.array() > 0).any();
    const std::vector<LiveFrame> finished = live_->push(frame);
    frames_->write(live_->skeleton(), finished);
  }
  /// For a frame before the joints are known, of which only JSON has any: at once.
  void write_nobody() {
    frames(rate_hz_).write(nobody_.skeleton, {{nobody_.channels.row(0), false}});
  }

  const Model& model_;
  std::string name_;
  std::filesystem::path output_;
  ClipPlacement placement_;
  FollowOptions options_;
  double rate_hz_;
  Motion nobody_;  ///< one frame
  Eigen::Index joints_ = 0;
  bool saw_anybody_ = false;
  std::unique_ptr<LiveRegeneration> live_;
  std::unique_ptr<FrameOutput> frames_;
};

/// What there is to report of a track of which frames were written.
/// @throws InputError if a person was asked for by number and is in no frame
void report_unseen(const Following& following, const std::string& name, const std::string& person) {
  if (!following.saw_anybody() && person != TrackReadOptions{}.person)
    throw InputError(fmt::format("{}: no person {} in any frame", name, person));
  if (!following.shows_somebody())
    spdlog::warn("{}: no frame shows enough of a person: all are the mean pose", name);
}

}  // namespace

void add_follow_options(CLI::App& command, FollowOptions& options) {
  command
      .add_flag("--follow", options.follow,
                "Read the track line by line while it is written, from --input or standard input: "
                "one frame a line, JSON or our CSV; write frames as they are finished, to -o or "
                "standard output. Ctrl-C ends it and leaves a complete file")
      ->group(kGroup);
  command
      .add_option_function<std::size_t>(
          "--look-ahead", [&options](std::size_t frames) { options.look_ahead = frames; },
          "Frames to come that an answer waits for, at the model's rate, at most the model's own; "
          "the fit waits for 3 more. With fewer than the model was trained with the rest is "
          "extrapolated from the track (default: the model's)")
      ->check(in_range(size_limits::kLookAhead))
      ->type_name("FRAMES")
      ->group(kGroup);
  command
      .add_option(
          "--frames", options.frames,
          "Format of the frames: bvh; csv: joints' places; json: a line a frame, channels and "
          "places (default: by the output's ending, else bvh)")
      ->check(CLI::IsMember({kBvh, kCsv, kJson}))
      ->group(kGroup);
}

void check_frames_output(const std::filesystem::path& output, const FollowOptions& options) {
  if (options.frames.empty()) check_ending(output, {".bvh", ".csv", ".json", ".jsonl"});
}

void follow_track(const Model& model, const std::filesystem::path& input,
                  const std::filesystem::path& output, const TrackReadOptions& reading,
                  const ClipPlacement& placement, const FollowOptions& options) {
  const std::string name = input == "-" ? "standard input" : input.string();
  TrackLines lines(name, reading);
  // After a request to stop the frames in progress are still written.
  const InterruptionDeferred until_the_end;
  LineSource source(input);
  Following following(model, name, output, placement, options, reading.fps.value_or(kUsualFps));
  while (const std::optional<std::string> line = source.next()) {
    std::optional<TrackFrame> frame;
    bool broken = false;
    try {
      frame = lines.read(*line);
    } catch (const InputError& error) {
      // An image whose size nothing gives would be missed in every frame that shows a person.
      const bool size_is_known = lines.knows_joints() || reading.image_size || reading.camera_image;
      if (!following.has_frames() || !size_is_known) throw;
      spdlog::warn("{}: taken as a frame that shows no person", error.what());
      broken = true;
    }
    if (frame) following.take(*frame, lines);
    if (broken) following.take_broken();
    for (const std::string& notice : lines.take_notices()) spdlog::warn("{}", with_flags(notice));
  }
  const std::size_t written = following.finish();
  if (written == 0 && interruption_requested()) {
    spdlog::info("{}: stopped before the first frame; nothing is written", name);
    return;
  }
  if (written == 0) throw InputError(fmt::format("{}: no frame that shows a person", name));
  spdlog::info("{}: {} frames", output.empty() ? "standard output" : output.string(), written);
  report_unseen(following, name, reading.person);
}

}  // namespace mcdbn::cli
