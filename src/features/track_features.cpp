#include "mcdbn/features/track_features.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/fill_gap.hpp"
#include "base/json_place.hpp"
#include "base/numbers.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace {

constexpr int kRootFeatures = 3;  ///< x and y of the root, log size

/// Pixels of the joints in use, the root last; NaN where missing. Each [frames x joints + 1].
struct Pixels {
  MatrixD x, y;
};

constexpr int kFewestJoints = 3;  ///< the root among them: two do not determine a body's pose

std::vector<int> columns_of(const Track2d& track, const std::vector<std::string>& joint_names,
                            const std::string& root_name) {
  std::vector<int> columns;
  std::vector<std::string> missing;
  const auto select = [&](const std::string& name) {
    columns.push_back(track.find(name));
    if (columns.back() < 0) missing.push_back(name);
  };
  for (const std::string& name : joint_names) select(name);
  select(root_name);
  const auto wanted = std::min<std::size_t>(kFewestJoints, columns.size());
  if (columns.back() < 0 || columns.size() - missing.size() < wanted)
    throw InputError(
        fmt::format("the 2D track has no columns for the joints {}; {} are needed, {} among them",
                    fmt::join(missing, ", "), kFewestJoints, root_name));
  return columns;
}

Pixels select_joints(const Track2d& track, const std::vector<int>& columns) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  Pixels pixels{MatrixD::Constant(track.frames(), count, kNan),
                MatrixD::Constant(track.frames(), count, kNan)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const int column = columns[static_cast<std::size_t>(k)];
    if (column < 0) continue;
    const auto seen = track.confidence.col(column).array() > 0 &&
                      !track.x_px.col(column).array().isNaN() &&
                      !track.y_px.col(column).array().isNaN();
    pixels.x.col(k) = seen.select(track.x_px.col(column).array(), kNan);
    pixels.y.col(k) = seen.select(track.y_px.col(column).array(), kNan);
  }
  return pixels;
}

bool never_seen(const Pixels& pixels, Eigen::Index column) {
  return pixels.x.col(column).array().isNaN().all();
}

TrackFeatures::FillCount fill_short_gaps(Pixels& pixels, double fps) {
  TrackFeatures::FillCount count;
  const auto longest = static_cast<Eigen::Index>(TrackFeatures::kLongestGap_s * fps + 1e-6);
  const Eigen::Index frames = pixels.x.rows();
  for (Eigen::Index column = 0; column < pixels.x.cols(); ++column) {
    if (never_seen(pixels, column)) continue;
    for (Eigen::Index first = 0; first < frames; ++first) {
      if (!std::isnan(pixels.x(first, column))) continue;
      Eigen::Index last = first;
      while (last < frames && std::isnan(pixels.x(last, column))) ++last;
      const int gap = static_cast<int>(last - first);
      if (gap <= longest && gap < frames) {
        for (MatrixD* px : {&pixels.x, &pixels.y}) {
          auto values = px->col(column);
          fill_gap(values, first, last);
        }
        count.interpolated += gap;
      } else {
        count.missing += gap;
      }
      first = last;
    }
  }
  return count;
}

/// Squared distances from the root, NaN where unknown. [frames x joints]
MatrixD squared_distances(const MatrixD& x, const MatrixD& y) {
  return x.array().square() + y.array().square();
}

/// Each joint's usual part of the sum of squares: its mean over the frames that show it. A joint
/// that none shows has the part that `usual` gives it beside the others, or none.
RowVectorD usual_parts(const MatrixD& squared, const RowVectorD& usual) {
  RowVectorD part = RowVectorD::Zero(squared.cols());
  std::vector<Eigen::Index> unseen;
  double seen_sum = 0, seen_usual = 0;
  for (Eigen::Index joint = 0; joint < squared.cols(); ++joint) {
    const auto known = !squared.col(joint).array().isNaN();
    if (!known.any()) {
      unseen.push_back(joint);
      continue;
    }
    part[joint] =
        known.select(squared.col(joint).array(), 0.0).sum() / static_cast<double>(known.count());
    seen_sum += part[joint];
    if (usual.size() > 0) seen_usual += usual[joint];
  }
  if (seen_usual > 0)
    for (const Eigen::Index joint : unseen) part[joint] = usual[joint] * seen_sum / seen_usual;
  return part;
}

/// RMS distance of a frame's joints from the root; joints that are missing are stood in for by the
/// others, each weighing as much as it usually makes up of the sum. NaN where less than half of the
/// usual sum of those that are seen at all is there. @param usual as usual_parts  @return [frames]
std::vector<double> frame_sizes(const MatrixD& squared, const RowVectorD& usual) {
  const RowVectorD share = usual_parts(squared, usual);
  const auto ever_seen = (!squared.array().isNaN()).colwise().any();
  const double whole = share.sum();
  const double seen_whole = ever_seen.select(share.array(), 0.0).sum();
  std::vector<double> sizes(static_cast<std::size_t>(squared.rows()), kNan);
  for (Eigen::Index frame = 0; frame < squared.rows(); ++frame) {
    const auto known = !squared.row(frame).array().isNaN();
    const double part = known.select(share.array(), 0.0).sum();
    const double sum = known.select(squared.row(frame).array(), 0.0).sum();
    if (part > 0 && part >= 0.5 * seen_whole) {
      sizes[frame] = std::sqrt(sum / part * whole / static_cast<double>(squared.cols()));
    }
  }
  return sizes;
}

/// The logarithm of the sizes, smoothed: around every frame a line is fitted with weights that fall
/// to zero at `half_width` frames. A line follows a walk towards the camera to the very ends of the
/// clip, where a mean or median would lag. NaN where the window holds no number.
std::vector<double> smooth_log_sizes(const std::vector<double>& sizes, int half_width) {
  const int frames = static_cast<int>(sizes.size());
  std::vector<double> result(sizes.size(), kNan);
  for (int frame = 0; frame < frames; ++frame) {
    double w = 0, wt = 0, wtt = 0, wv = 0, wtv = 0;
    const int end = std::min(frames, frame + half_width);
    for (int other = std::max(0, frame - half_width + 1); other < end; ++other) {
      if (!(sizes[other] > 0)) continue;
      const double time = other - frame, value = std::log(sizes[other]);
      const double weight = 1.0 - std::abs(time) / half_width;
      w += weight;
      wt += weight * time;
      wtt += weight * time * time;
      wv += weight * value;
      wtv += weight * time * value;
    }
    const double determinant = w * wtt - wt * wt;
    if (determinant > 1e-9 * w * w) {
      result[frame] = (wtt * wv - wt * wtv) / determinant;
    } else if (w > 0) {
      result[frame] = wv / w;
    }
  }
  return result;
}

}  // namespace

TrackFeatures::TrackFeatures(std::vector<std::string> joint_names, std::string root_name)
    : joint_names_(std::move(joint_names)), root_name_(std::move(root_name)) {
  std::vector<std::string> sorted = joint_names_;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) {
    throw InputError(fmt::format("joint {} is listed twice; list it once", *twice));
  }
  std::erase(joint_names_, root_name_);
}

TrackFeatures TrackFeatures::for_skeleton(const Skeleton& skeleton, int root) {
  std::vector<std::string> names;
  std::vector<bool> in_body(skeleton.joints.size(), false);
  for (int j = root; j < skeleton.joint_count(); ++j) {
    const Joint& joint = skeleton.joints[j];
    in_body[j] = j == root || (joint.parent >= 0 && in_body[joint.parent]);
    const bool moves = std::any_of(joint.channels.begin(), joint.channels.end(),
                                   [](Channel channel) { return !is_rotation(channel); });
    if (in_body[j] && j != root && (moves || joint.offset.norm() > 1e-9)) {
      names.push_back(joint.name);
    }
  }
  return TrackFeatures(std::move(names), skeleton.joints[root].name);
}

int TrackFeatures::dimension() const {
  return 2 * static_cast<int>(joint_names_.size()) + kRootFeatures;
}

std::vector<std::string> TrackFeatures::feature_names() const {
  std::vector<std::string> names;
  for (const std::string& joint : joint_names_) {
    names.push_back(joint + "_x");
    names.push_back(joint + "_y");
  }
  for (const char* name : {"root_image_x", "root_image_y", "log_body_size"}) {
    names.emplace_back(name);
  }
  return names;
}

MatrixD TrackFeatures::encode(const Track2d& track, FillCount* filled,
                              const RowVectorD& usual_squares) const {
  Pixels pixels = select_joints(track, columns_of(track, joint_names_, root_name_));
  FillCount count = fill_short_gaps(pixels, track.fps);
  const auto joints = static_cast<Eigen::Index>(joint_names_.size());
  for (Eigen::Index joint = 0; joint < joints; ++joint)
    if (never_seen(pixels, joint))
      count.unseen.push_back(joint_names_[static_cast<std::size_t>(joint)]);
  if (filled) *filled = std::move(count);

  const Eigen::VectorXd root_x = pixels.x.col(joints), root_y = pixels.y.col(joints);
  const MatrixD x = pixels.x.leftCols(joints).colwise() - root_x;
  const MatrixD y = pixels.y.leftCols(joints).colwise() - root_y;
  const int half_width = std::max(2, static_cast<int>(std::lround(kSizeWindow_s * track.fps)));
  const std::vector<double> log_size =
      smooth_log_sizes(frame_sizes(squared_distances(x, y), usual_squares), half_width);

  MatrixD features(track.frames(), dimension());
  for (Eigen::Index frame = 0; frame < features.rows(); ++frame) {
    const double scale = std::exp(log_size[frame]);
    for (Eigen::Index joint = 0; joint < joints; ++joint) {
      features(frame, 2 * joint) = x(frame, joint) / scale;
      features(frame, 2 * joint + 1) = y(frame, joint) / scale;
    }
    const bool rootless = std::isnan(root_x[frame]);
    features(frame, 2 * joints) = (root_x[frame] - track.width_px / 2.0) / track.height_px;
    features(frame, 2 * joints + 1) = (root_y[frame] - track.height_px / 2.0) / track.height_px;
    features(frame, 2 * joints + 2) = rootless ? kNan : log_size[frame] - std::log(track.height_px);
  }
  return features;
}

Track2d TrackFeatures::decode(const MatrixD& features, double fps, int width_px,
                              int height_px) const {
  if (features.cols() != dimension())
    throw ShapeError(fmt::format("TrackFeatures::decode: {} columns, expected {}", features.cols(),
                                 dimension()));
  const auto joints = static_cast<Eigen::Index>(joint_names_.size());
  Track2d track;
  track.fps = fps;
  track.width_px = width_px;
  track.height_px = height_px;
  track.joint_names = {root_name_};
  track.joint_names.insert(track.joint_names.end(), joint_names_.begin(), joint_names_.end());
  track.x_px.resize(features.rows(), joints + 1);
  track.y_px.resize(features.rows(), joints + 1);
  track.confidence = MatrixD::Ones(features.rows(), joints + 1);
  const Eigen::ArrayXd root_x = features.col(2 * joints).array() * height_px + width_px / 2.0;
  const Eigen::ArrayXd root_y = features.col(2 * joints + 1).array() * height_px + height_px / 2.0;
  const Eigen::ArrayXd size_px = features.col(2 * joints + 2).array().exp() * height_px;
  track.x_px.col(0) = root_x;
  track.y_px.col(0) = root_y;
  for (Eigen::Index joint = 0; joint < joints; ++joint) {
    track.x_px.col(joint + 1) = root_x + size_px * features.col(2 * joint).array();
    track.y_px.col(joint + 1) = root_y + size_px * features.col(2 * joint + 1).array();
  }
  return track;
}

RowVectorD TrackFeatures::usual_squares(const RowVectorD& mean, const RowVectorD& deviation) const {
  if (mean.size() != dimension() || deviation.size() != dimension()) return {};
  const auto joints = static_cast<Eigen::Index>(joint_names_.size());
  const RowVectorD squares = mean.array().square() + deviation.array().square();
  RowVectorD usual(joints);
  for (Eigen::Index joint = 0; joint < joints; ++joint)
    usual[joint] = squares[2 * joint] + squares[2 * joint + 1];
  return usual;
}

nlohmann::json TrackFeatures::to_json() const {
  return {{"joints", joint_names_}, {"root", root_name_}};
}

TrackFeatures TrackFeatures::from_json(const nlohmann::json& json, const std::string& where) {
  const JsonPlace place(json, where);
  const std::vector<std::string> joints = place["joints"].texts();
  try {
    return TrackFeatures(joints, place["root"].text());
  } catch (const InputError& error) {
    place["joints"].fail(error.what());
  }
}

}  // namespace mcdbn
