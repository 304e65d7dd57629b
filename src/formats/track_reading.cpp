#include "formats/track_reading.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "formats/image_shares.hpp"
#include "formats/likely_image.hpp"
#include "formats/likely_joint_set.hpp"
#include "formats/people_following.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/motion/frame_rate.hpp"

namespace mcdbn {
namespace {

using Frames = std::vector<std::vector<SeenPerson>>;

/// Number of frames that may be missing in any film.
constexpr long long kFewFrames = 100;

struct Extent {
  double least_x = 1e300, most_x = -1e300, least_y = 1e300, most_y = -1e300;
};

/// The frames in their order, with empty ones where numbers are missing; their numbers and notices
/// are the reading's.
Frames frames_by_number(SeenPeople& seen, TrackReading& reading) {
  const long long first = seen.frames.begin()->first, last = seen.frames.rbegin()->first;
  const auto count = static_cast<long long>(seen.frames.size());
  long long step = 0;
  for (const auto& [number, people] : seen.frames) step = std::gcd(step, number - first);
  step = std::max(step, 1LL);
  const bool sparse = (last - first) / step >= kSparse * count + kFewFrames;
  if (sparse)
    reading.notices.push_back(fmt::format(
        "the numbers of its {} frames run from {} to {}: they are taken one after the other", count,
        first, last));
  else if (step > 1)
    reading.notices.push_back(fmt::format(
        "its frames are numbered in steps of {}: they are taken one after the other", step));
  Frames frames(static_cast<std::size_t>(sparse ? count : (last - first) / step + 1));
  for (std::size_t i = 0; i < frames.size(); ++i)
    reading.frame_numbers.push_back(first + static_cast<long long>(i) * step);
  std::size_t next = 0;
  for (auto& [number, people] : seen.frames) {
    const std::size_t at = sparse ? next++ : static_cast<std::size_t>((number - first) / step);
    frames[at] = std::move(people);
    reading.frame_numbers[at] = number;
  }
  return frames;
}

void require_people(const Frames& frames, const std::vector<long long>& numbers,
                    const std::string& file) {
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (frames[i].size() > kMostPeople)
      throw InputError(fmt::format("{}: {} people in frame {}; at most {} are followed", file,
                                   frames[i].size(), numbers[i], kMostPeople));
}

Extent extent_of(const Frames& frames) {
  Extent extent;
  for_each_seen_joint(frames, [&](double x, double y, double) {
    extent.least_x = std::min(extent.least_x, x);
    extent.most_x = std::max(extent.most_x, x);
    extent.least_y = std::min(extent.least_y, y);
    extent.most_y = std::max(extent.most_y, y);
  });
  return extent;
}

/// The smallest usual image that holds everything that was seen, but for 2 %: detectors guess a
/// little beyond the edge.
ImageSize guessed_image(const Extent& extent) {
  constexpr std::array<std::pair<int, int>, 7> kUsual{{{640, 480},
                                                       {1280, 720},
                                                       {1920, 1080},
                                                       {2560, 1440},
                                                       {2704, 1520},
                                                       {3840, 2160},
                                                       {7680, 4320}}};
  const auto holds = [&](int width_px, int height_px) {
    return extent.most_x <= 1.02 * width_px && extent.most_y <= 1.02 * height_px;
  };
  for (const auto& [long_side, short_side] : kUsual) {
    if (holds(long_side, short_side)) return {long_side, short_side};
    if (holds(short_side, long_side)) return {short_side, long_side};
  }
  const auto whole = [](double extent) {
    return static_cast<int>(std::ceil(std::min(extent, Camera::kImage_px.most)));
  };
  return {std::max(whole(extent.most_x), 1), std::max(whole(extent.most_y), 1)};
}

/// @param likely whether the people in it show that it is of that shape
std::string shares_notice(const ImageSize& size, bool known, bool likely) {
  std::string taken = fmt::format("coordinates are shares of the image, taken as {} x {} px",
                                  size.width_px, size.height_px);
  if (known) return taken;
  const std::string so =
      fmt::format(" and people look likelier so than in {} x {}", size.height_px, size.width_px);
  return fmt::format("{}, for the file does not give its size{}; set it with `image-size`", taken,
                     likely ? so : "");
}

/// Coordinates that are shares of the image become pixels. @return the image's size
ImageSize put_in_pixels(Frames& frames, const SeenPeople& seen, const TrackReadOptions& options,
                        const std::string& file, std::vector<std::string>& notices) {
  const std::optional<ImageSize> known = seen.size_of_image(options);
  if (seen.takes_default_size(options))
    notices.push_back(fmt::format(
        "the file does not give the image's size: {} x {} px are taken; set it with `image-size`",
        known->width_px, known->height_px));
  const bool shares = !seen.in_pixels && are_shares(frames, seen.has_depths_only, file);
  const std::optional<ImageSize> likely =
      shares && !known ? likely_image(seen.keypoints, frames) : std::nullopt;
  const ImageSize size = known ? *known : likely.value_or(kLyingImage);
  if (shares)
    for (auto& people : frames) shares_to_px(people, size);
  const Extent extent = extent_of(frames);
  if (extent.most_x < extent.least_x) return size;  // nothing was seen
  const double farthest =
      std::max({-extent.least_x, -extent.least_y, extent.most_x, extent.most_y});
  if (farthest > kFarthest_px)
    throw InputError(fmt::format("{}: a coordinate of {:.3g}, which is no pixel", file, farthest));
  if (!shares && !seen.in_pixels) require_image_places(frames, seen.has_depths_only, file);
  if (!shares) {
    if (known) return *known;
    const ImageSize guess = guessed_image(extent);
    notices.push_back(fmt::format(
        "the file does not give the image's size: taken as {} x {} px, which holds all that was "
        "seen but for 2 % (x to {:.0f}, y to {:.0f}); set it with `image-size`",
        guess.width_px, guess.height_px, extent.most_x, extent.most_y));
    return guess;
  }
  notices.push_back(shares_notice(size, known.has_value(), likely.has_value()));
  return size;
}

/// Frames a second by the times of the first and the last frame that have one; none: no two have.
/// Times are rounded, so a rate that is nearly whole is whole.
std::optional<double> rate_of_times(const SeenPeople& seen, const std::vector<long long>& numbers) {
  constexpr double kNearly = 4e-4;  // 29.97 Hz and 30 Hz differ by 1e-3
  if (seen.times_s.size() < 2) return {};
  const auto frame_of = [&](long long number) {
    return static_cast<double>(std::ranges::lower_bound(numbers, number) - numbers.begin());
  };
  const auto &first = *seen.times_s.begin(), &last = *seen.times_s.rbegin();
  const double rate_hz =
      (frame_of(last.first) - frame_of(first.first)) / (last.second - first.second);
  const double whole_hz = std::round(rate_hz);
  return std::abs(rate_hz - whole_hz) < kNearly * rate_hz ? whole_hz : rate_hz;
}

/// The film's rate by its frames' times, else as the file gives it; none: it has neither.
std::optional<double> rate_of_file(const SeenPeople& seen, TrackReading& reading) {
  const auto by_times = rate_of_times(seen, reading.frame_numbers);
  if (!by_times) return seen.fps;
  if (!kFrameRate_hz.contains(*by_times)) {
    reading.notices.push_back(fmt::format(
        "its times make {:.4g} frames a second, which is no film's: they are not used", *by_times));
    return seen.fps;
  }
  constexpr double kOther = 0.05;
  if (seen.fps && std::abs(*seen.fps - *by_times) > kOther * *by_times)
    reading.notices.push_back(fmt::format(
        "the file gives {:.4g} frames a second, its times make {:.4g}, which are taken; set "
        "another rate with `fps` if that is wrong",
        *seen.fps, *by_times));
  return by_times;
}

/// Heat maps overshoot 1 a little; other scales end where nearly all of the file's values do.
void limit_confidences(Frames& frames, std::vector<std::string>& notices) {
  std::vector<double> all;
  for_each_seen_joint(frames, [&](double, double, double c) { all.push_back(c); });
  const auto greatest = std::ranges::max_element(all);
  if (greatest == all.end() || *greatest <= 1) return;
  double scale = 1;
  if (*greatest > 1.5) {
    const auto nearly_last = all.begin() + static_cast<std::ptrdiff_t>((all.size() - 1) * 95 / 100);
    const double largest = *greatest;
    std::ranges::nth_element(all, nearly_last);
    scale = std::max(*nearly_last, 1.0);
    notices.push_back(
        fmt::format("confidences up to {:.4g} are divided by {:.4g}, their 95 % "
                    "quantile, and cut at 1",
                    largest, scale));
  } else {
    notices.push_back(fmt::format("confidences up to {:.4g} are cut at 1", *greatest));
  }
  // What was seen stays seen, however small the share is that is left.
  constexpr double kLeast = std::numeric_limits<double>::min();
  for_each_seen_joint(frames,
                      [&](double, double, double& c) { c = std::clamp(c / scale, kLeast, 1.0); });
}

Track2d track_of(const SeenPeople& seen, const Frames& frames, const Followed& followed) {
  const auto rows = static_cast<Eigen::Index>(frames.size());
  const auto joints = static_cast<Eigen::Index>(seen.joint_names.size());
  Track2d track;
  track.joint_names = seen.joint_names;
  track.keypoints = seen.keypoints;
  track.x_px = track.y_px =
      MatrixD::Constant(rows, joints, std::numeric_limits<double>::quiet_NaN());
  track.confidence = MatrixD::Zero(rows, joints);
  for (const auto& [frame, who] : followed) {
    const SeenPerson& person = frames[frame][who];
    for (Eigen::Index joint = 0; joint < joints; ++joint) {
      track.x_px(frame, joint) = person.x_px[joint];
      track.y_px(frame, joint) = person.y_px[joint];
      track.confidence(frame, joint) = person.confidence[joint];
    }
  }
  return track;
}

/// Without those who were seen for less than half a second and a tenth of the frames.
/// @param frames of the film
void drop_fleeting(std::vector<Followed>& people, double frames, double fps,
                   std::vector<std::string>& notices) {
  if (people.size() < 2) return;
  long longest = 0;
  for (const Followed& followed : people) longest = std::max(longest, std::ssize(followed));
  const double few = std::min(fps / 2, frames / 10);
  const long least = std::min(static_cast<long>(std::ceil(few)), longest);
  const std::size_t before = people.size();
  std::erase_if(people, [&](const Followed& followed) { return std::ssize(followed) < least; });
  if (const std::size_t dropped = before - people.size(); dropped > 0)
    notices.push_back(fmt::format("{} more {} seen for less than {} frames, and left out", dropped,
                                  dropped == 1 ? "body was" : "bodies were", least));
}

/// Which of the file's numbers were taken for one person.
void note_number_changes(const SeenPeople& seen, const Frames& frames,
                         const std::vector<Followed>& people, TrackReading& reading) {
  constexpr std::size_t kMostListed = 5;
  const std::vector<NumberChange> changes = number_changes(frames, people);
  if (changes.empty()) return;
  std::vector<std::string> listed;
  for (const auto& [before, after, frame] :
       std::span(changes).first(std::min(changes.size(), kMostListed)))
    listed.push_back(fmt::format("{} after {} from frame {}", seen.name_of_track(after),
                                 seen.name_of_track(before), reading.frame_numbers[frame]));
  if (changes.size() > kMostListed)
    listed.push_back(fmt::format("and {} more", changes.size() - kMostListed));
  reading.notices.push_back(
      fmt::format("track numbers that begin where others end are taken for the same person: {}",
                  fmt::join(listed, ", ")));
}

/// Which of the people are wanted.
std::vector<std::size_t> chosen(const std::string& person, std::size_t people,
                                const std::string& file, std::vector<std::string>& notices) {
  if (person == "largest") {
    if (people > 1)
      notices.push_back(
          fmt::format("{} people: the largest is taken; choose another with `person`", people));
    return {0};
  }
  if (person == "all") {
    std::vector<std::size_t> all(people);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  std::size_t number = 0;
  const char* end = person.data() + person.size();
  const auto [rest, error] = std::from_chars(person.data(), end, number);
  if (error != std::errc() || rest != end || number == 0)
    throw ConfigError(fmt::format("`person` {}: give largest, all, or a number from 1 on", person));
  if (number > people)
    throw InputError(fmt::format("{}: no person {}: {} seen", file, number,
                                 people == 1 ? "one was" : fmt::format("{} were", people)));
  return {number - 1};
}

}  // namespace

TrackReading tracks_of(SeenPeople seen, const TrackReadOptions& options, const std::string& file) {
  if (seen.frames.empty()) throw InputError(fmt::format("{}: no frames", file));
  TrackReading reading;
  reading.notices = std::move(seen.notices);
  reading.axes_are_unnamed = seen.axes_are_unnamed;
  require_joints(seen.joint_names.size(), file);
  Frames frames = frames_by_number(seen, reading);
  for (auto& people : frames)
    std::erase_if(people, [](const SeenPerson& person) {
      return std::ranges::none_of(person.confidence, [](double c) { return c > 0; });
    });
  require_people(frames, reading.frame_numbers, file);
  const ImageSize size = put_in_pixels(frames, seen, options, file, reading.notices);
  name_likeliest_set(seen, frames);
  if (const JointSet* set = joint_set_of(seen.joint_names)) reading.joint_set = set->name;
  limit_confidences(frames, reading.notices);
  const std::optional<double> given = options.fps ? options.fps : rate_of_file(seen, reading);
  if (!given)
    reading.notices.push_back(fmt::format(
        "the file does not give its rate: {} frames a second are taken; set it with `fps`",
        kUsualFps));
  if (options.fps) check_range("`fps`", kFrameRate_hz, *options.fps);
  if (!options.fps && given && !kUsualFrameRate_hz.contains(*given))
    reading.notices.push_back(fmt::format(
        "the file gives {:.4g} frames a second; set another rate with `fps` if that is wrong",
        *given));
  const double fps = given.value_or(kUsualFps);
  std::vector<Followed> people =
      follow_people(frames, static_cast<int>(std::clamp(kPatience_s * fps, 1.0, 1000.0)));
  drop_fleeting(people, static_cast<double>(frames.size()), fps, reading.notices);
  note_number_changes(seen, frames, people, reading);
  reading.people_seen = static_cast<int>(people.size());
  // Without any person there is one track, of missing joints.
  if (people.empty()) people.emplace_back();
  for (const std::size_t person : chosen(options.person, people.size(), file, reading.notices)) {
    Track2d track = track_of(seen, frames, people[person]);
    track.fps = fps;
    track.width_px = size.width_px;
    track.height_px = size.height_px;
    reading.people.push_back(std::move(track));
  }
  return reading;
}

}  // namespace mcdbn
