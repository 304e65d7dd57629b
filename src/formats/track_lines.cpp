#include "mcdbn/formats/track_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/shown.hpp"
#include "formats/csv_text.hpp"
#include "formats/image_shares.hpp"
#include "formats/joint_naming.hpp"
#include "formats/likely_joint_set.hpp"
#include "formats/person_choice.hpp"
#include "formats/track_formats.hpp"
#include "formats/track_reading.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/frame_rate.hpp"

namespace mcdbn {
namespace {

bool is_json(std::string_view line) {
  return line.starts_with('{') || line.starts_with('[') || line == "null";
}

double farthest(const std::vector<SeenPerson>& people) {
  double most = 0;
  for (const SeenPerson& person : people)
    for (std::size_t joint = 0; joint < person.x_px.size(); ++joint)
      if (person.confidence[joint] > 0)
        most = std::max({most, std::abs(person.x_px[joint]), std::abs(person.y_px[joint])});
  return most;
}

}  // namespace

class TrackLines::Reader {
 public:
  Reader(std::string name, const TrackReadOptions& options)
      : name_(std::move(name)), options_(options), choice_(options.person) {
    if (options.fps) check_range("`fps`", kFrameRate_hz, *options.fps);
  }

  std::optional<TrackFrame> read(std::string_view line) {
    ++line_;
    if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    line = trimmed(line);
    if (line.empty()) {
      if (!is_known_) header_ += '\n';  // lines are counted
      return {};
    }
    if (!std::exchange(has_begun_, true)) json_ = is_json(line);
    if (json_) return frame_of(people_of_json(line));
    if (line.front() == '#' || !has_header_) {
      // Comments count as long as no frame was read.
      if (!is_known_) header_ += fmt::format("{}\n", line);
      has_header_ = has_header_ || line.front() != '#';
      return {};
    }
    return frame_of(people_of_row(line));
  }

  bool knows_joints() const { return is_known_; }
  const Track2d& like() const { return like_; }
  std::vector<std::string> take_notices() { return std::exchange(notices_, {}); }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_, what));
  }

  /// The format that recognises it, of all or only that of the lines before it.
  const TrackFormat* format_of(const TrackSource& source) const {
    if (format_) return format_->recognises(source) ? format_ : nullptr;
    const auto found = std::ranges::find_if(
        track_formats(), [&](const TrackFormat& format) { return format.recognises(source); });
    return found == track_formats().end() ? nullptr : &*found;
  }

  /// A JSON line is an entry of a list of frames, as in a file of such lines; or a file's whole
  /// content, as MMPose writes it of an image.
  SeenPeople people_of_json(std::string_view line) {
    const std::string place = fmt::format("{}:{}", name_, line_);
    TrackSource source(fmt::format("[{}]", line), place);
    if (!format_ && !options_.format.empty()) format_ = &track_format(options_.format);
    // A line without people may have any format: a camera may run for long before anybody comes.
    if (shows_nobody(source.json().value())) return {};
    const TrackFormat* format = format_of(source);
    if (!format) {
      TrackSource whole(std::string(line), place);
      format = format_of(whole);
      if (format) source = std::move(whole);
    }
    if (!format_) format_ = format;
    if (!format_) fail("not a frame of a 2D track in a known format");
    try {
      SeenPeople people = format_->read(source);
      if (people.frames.size() > 1) fail("more than one frame in a line");
      if (!people.frames.empty()) compare_image(people.frames.begin()->first);
      return people;
    } catch (const NoPersonSeen&) {
      return {};
    }
  }

  /// Who writes a line for each person gets a motion that is longer than the film.
  /// @param number of the image, the file's own, or 0 where lines have none
  void compare_image(long long number) {
    if (number != 0 && number == image_ && !std::exchange(warned_of_image_, true))
      notices_.push_back(fmt::format(
          "line {} is of the same image, {}, as the one before: each line is taken as a "
          "frame; write all people of an image in one line",
          line_, number));
    image_ = number;
  }

  SeenPeople people_of_row(std::string_view line) {
    const auto lines = static_cast<int>(std::ranges::count(header_, '\n'));
    return track_csv_format().read(
        TrackSource(fmt::format("{}{}", header_, line), name_, line_ - lines - 1));
  }

  TrackFrame frame_of(SeenPeople seen) {
    std::vector<SeenPerson> people;
    if (!seen.frames.empty()) people = std::move(seen.frames.begin()->second);
    // A CSV gives the joints in its header, JSON in a frame with a person.
    const bool is_first = !is_known_ && (!json_ || farthest(people) > 0);
    if (!is_known_ && !is_first) return TrackFrame::unseen(0);
    if (is_first) learn_image(seen, people);
    if (shares_) shares_to_px(people, {like_.width_px, like_.height_px});
    if (const double far = farthest(people); far > kFarthest_px)
      fail(fmt::format("a coordinate of {:.3g}, which is no pixel", far));
    if (is_first) learn_joints(seen, people);
    TrackFrame frame = TrackFrame::unseen(like_.joint_count());
    // Rows are of one person: there is no second.
    const bool of_one = !json_ && !people.empty() && choice_.number() == 1;
    const auto chosen =
        of_one ? std::optional<std::size_t>(0) : choice_.choose(people, kPatience_s * like_.fps);
    if (!chosen) return frame;
    const SeenPerson& person = people[*chosen];
    if (static_cast<Eigen::Index>(person.x_px.size()) != frame.joints())
      fail(fmt::format("{} joints, in the frames before {}", person.x_px.size(), frame.joints()));
    for (Eigen::Index joint = 0; joint < frame.joints(); ++joint) {
      const auto at = static_cast<std::size_t>(joint);
      if (!(person.confidence[at] > 0)) continue;
      frame.x_px[joint] = person.x_px[at];
      frame.y_px[joint] = person.y_px[at];
      frame.confidence[joint] = std::min(person.confidence[at], 1.0);
    }
    return frame;
  }

  void learn_image(const SeenPeople& seen, const std::vector<SeenPerson>& people) {
    const std::optional<ImageSize> size = seen.size_of_image(options_);
    if (!size) fail("a frame does not give the image's size: set it with `image-size`");
    like_.width_px = size->width_px;
    like_.height_px = size->height_px;
    shares_ = !seen.in_pixels &&
              are_shares({people}, seen.has_depths_only, fmt::format("{}:{}", name_, line_));
  }

  /// @param people in pixels
  void learn_joints(SeenPeople& seen, const std::vector<SeenPerson>& people) {
    if (seen.takes_default_size(options_))
      notices_.push_back(
          fmt::format("the track does not give the image's size: {} x {} px are taken; set it with "
                      "`image-size`",
                      like_.width_px, like_.height_px));
    if (!options_.fps && !seen.fps)
      notices_.push_back(fmt::format(
          "the track does not give its rate: {} frames a second are taken; set it with `fps`",
          kUsualFps));
    if (shares_)
      notices_.push_back(fmt::format("coordinates are shares of the image, taken as {} x {} px",
                                     like_.width_px, like_.height_px));
    name_likeliest_set(seen, {people});
    notices_.insert(notices_.end(), seen.notices.begin(), seen.notices.end());
    like_.joint_names = seen.joint_names;
    like_.keypoints = seen.keypoints;
    like_.fps = options_.fps.value_or(seen.fps.value_or(kUsualFps));
    for (MatrixD* values : {&like_.x_px, &like_.y_px, &like_.confidence})
      values->resize(0, like_.joint_count());
    is_known_ = true;
  }

  std::string name_;
  TrackReadOptions options_;
  PersonChoice choice_;
  int line_ = 0;
  long long image_ = 0;  ///< of the line before
  bool has_begun_ = false, json_ = false, has_header_ = false, is_known_ = false, shares_ = false,
       warned_of_image_ = false;
  std::string header_;  ///< of a CSV, with the comments and empty lines around it
  const TrackFormat* format_ = nullptr;
  Track2d like_;
  std::vector<std::string> notices_;
};

TrackLines::TrackLines(std::string name, const TrackReadOptions& options)
    : reader_(std::make_unique<Reader>(std::move(name), options)) {}
TrackLines::~TrackLines() = default;
TrackLines::TrackLines(TrackLines&&) noexcept = default;
TrackLines& TrackLines::operator=(TrackLines&&) noexcept = default;

std::optional<TrackFrame> TrackLines::read(std::string_view line) {
  return reader_->read(line);
}
bool TrackLines::knows_joints() const {
  return reader_->knows_joints();
}
const Track2d& TrackLines::like() const {
  return reader_->like();
}
std::vector<std::string> TrackLines::take_notices() {
  return reader_->take_notices();
}

}  // namespace mcdbn
