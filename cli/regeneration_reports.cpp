#include "regeneration_reports.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "base/counted.hpp"
#include "base/numbers.hpp"
#include "camera/quarter_roll.hpp"
#include "camera/shown_body.hpp"
#include "mcdbn/camera/level_view.hpp"
#include "mcdbn/camera/track_stretches.hpp"
#include "mcdbn/features/track_features.hpp"
#include "motion/body_root.hpp"
#include "motion/sliding_feet.hpp"

namespace mcdbn::cli {

void report_written(const std::filesystem::path& path, int frames, double fps) {
  spdlog::info("{}: {} at {:.4g} fps", path.string(), counted(frames, "frame"), fps);
}

void report_first_frame(const std::filesystem::path& file, const std::vector<long long>& numbers) {
  if (numbers.size() < 2 || numbers.front() < 2) return;
  if (numbers.back() - numbers.front() + 1 != std::ssize(numbers)) return;
  spdlog::warn(
      "{}: its first frame is number {}, and the motion begins there: to draw it over the whole "
      "film, render --over-from {} (or {}, if the film's first frame is number 1)",
      file.string(), numbers.front(), numbers.front(), numbers.front() - 1);
}

void report_turned(const std::string& name, const Track2d& track, bool axes_are_unnamed) {
  const std::optional<int> roll_deg = quarter_roll_deg(track);
  if (!roll_deg) return;
  const bool upside_down = *roll_deg == 180;
  spdlog::warn(
      "{}: in most frames the body {}: {}set --camera-roll {} if the film is stored turned, or "
      "--camera-roll 0 if the person {}",
      name, upside_down ? "is upside down in the image" : "lies across the image",
      axes_are_unnamed && !upside_down
          ? "exchange x and y in the file if it has y first, as MoveNet's arrays do; "
          : "",
      *roll_deg, upside_down ? "stands on the hands" : "lies there");
}

void report_assumed(const Camera& camera, const std::string& found_from) {
  const Eigen::Vector3d up = camera.camera_from_world.col(1);
  const auto deg = [](double angle) {
    return std::round(10 * angle / kRadiansPerDegree) / 10 + 0.0;
  };
  spdlog::warn(
      "no --camera: assumed to look down by {:g} degrees and to be turned by {:g}{}, with a "
      "vertical field of view of {:.4g} degrees; set what is known with --camera-pitch, "
      "--camera-roll, --camera-fov",
      deg(std::asin(std::clamp(-up.z(), -1.0, 1.0))), deg(std::atan2(-up.x(), -up.y())),
      found_from.empty() ? "" : fmt::format(" (from {})", found_from),
      2 * std::atan(0.5 * camera.height_px / camera.fy_px) / kRadiansPerDegree);
}

void report_findings(const std::string& name, const Track2d& track,
                     const std::vector<long long>& numbers, const TrackFindings& findings) {
  const TrackFeatures::FillCount& filled = findings.filled;
  const std::vector<FrameRange>& stretches = findings.stretches.stretches;
  if (stretches.size() > 1)
    spdlog::warn(
        "{}: jumps to another place or size, as if to another person or after a cut: frames {} are "
        "regenerated each by themselves, with one body",
        name, described(stretches, numbers));
  if (const auto& strays = findings.stretches.strays; !strays.empty())
    spdlog::warn("{}: another person in frames {}: left out", name, described(strays, numbers));
  if (!findings.swaps.empty())
    spdlog::warn("{}: {}; put right", name, described(findings.swaps, numbers));
  auto nobody = frames_of_nobody(track);
  std::erase_if(nobody, [&](const FrameRange& gap) {
    return gap.frames <= TrackFeatures::kLongestGap_s * track.fps;  // interpolated
  });
  if (!nobody.empty())
    spdlog::warn("{}: nobody is seen in frames {}: the motion there is made up", name,
                 described(nobody, numbers));
  if (!filled.unseen.empty())
    spdlog::warn("{}: {} are never seen: inferred", name, fmt::join(filled.unseen, ", "));
  if (filled.interpolated + filled.missing > 0)
    spdlog::warn("{}: {} missing joints interpolated over short gaps, {} inferred from the others",
                 name, filled.interpolated, filled.missing);
  if (filled.outside > 0)
    spdlog::warn(
        "{}: {} seen joints are outside of the level view, {:.0f} degrees and more from its "
        "direction: the network does not see them; from a camera that looks down by more than 65 "
        "degrees the motion may be metres off",
        name, filled.outside, std::acos(kLevelViewLeastCosine) / kRadiansPerDegree);
  if (findings.placed_by_size)
    spdlog::warn(
        "{}: the network's poses do not match what the camera shows: the person is placed by size, "
        "and the motion may be far off; check --camera, --camera-pitch and --camera-roll. Persons "
        "upside down, lying or seen in part are answered so, too",
        name);
}

void report_sliding_feet(const std::string& name, const Track2d& track, const Motion& motion) {
  if (share_of_sliding(motion, frames_of_feet(track)) <= 0.5) return;
  spdlog::warn(
      "{}: in most frames the feet slide, faster than the body gets on: did the camera move? It "
      "has to stand still, else the path is wrong, and heights may be (on a treadmill they slide, "
      "too)",
      name);
}

void report_uncertainty(const Motion& motion, const MatrixD& deviations) {
  if (deviations.size() == 0) return;
  const Skeleton& skeleton = motion.skeleton;
  std::vector<std::pair<double, std::string>> joints;
  for (int joint = body_root(skeleton) + 1; joint < skeleton.joint_count(); ++joint)
    joints.emplace_back(std::sqrt(deviations.middleCols(3 * joint, 3).squaredNorm() /
                                  static_cast<double>(3 * deviations.rows())),
                        skeleton.joints[static_cast<std::size_t>(joint)].name);
  std::ranges::sort(joints, std::greater());
  double squares = 0;
  for (const auto& [deviation, name] : joints) squares += deviation * deviation;
  if (joints.empty()) return;
  spdlog::info(
      "joints are off by a standard deviation of {:.3g} in the file's unit along each axis, "
      "{} most, by {:.3g}",
      std::sqrt(squares / static_cast<double>(joints.size())), joints.front().second,
      joints.front().first);
}

}  // namespace mcdbn::cli
