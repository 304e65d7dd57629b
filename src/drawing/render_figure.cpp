#include "drawing/render_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "motion/body_size.hpp"

namespace mcdbn::rendering {
namespace {

const cv::Scalar kPaper(250, 249, 248);  // BGR, as all colours here
const cv::Scalar kGrid(205, 200, 196);
const cv::Scalar kShadow(226, 222, 219);
const cv::Scalar kInk(70, 62, 58);

constexpr int kSubpixelBits = 4;

cv::Scalar colour_of(Side side, Palette palette) {
  static const std::array<std::array<cv::Scalar, 3>, 2> kColours{
      {{cv::Scalar(186, 110, 32), cv::Scalar(80, 72, 66), cv::Scalar(62, 52, 208)},
       {cv::Scalar(132, 158, 20), cv::Scalar(120, 120, 126), cv::Scalar(40, 142, 240)}}};
  return kColours[static_cast<std::size_t>(palette)][static_cast<std::size_t>(side)];
}

cv::Scalar mix(const cv::Scalar& from, const cv::Scalar& to, double weight) {
  return from * (1 - weight) + to * weight;
}

cv::Point subpixel(const Eigen::Vector2d& pixel) {
  // Far outside the image OpenCV's fixed-point coordinates would overflow.
  constexpr double kLimit_px = 1e5, kScale = 1 << kSubpixelBits;
  return {cvRound(std::clamp(pixel.x(), -kLimit_px, kLimit_px) * kScale),
          cvRound(std::clamp(pixel.y(), -kLimit_px, kLimit_px) * kScale)};
}

double depth_of(const Camera& camera, const Eigen::Vector3d& point) {
  return camera.camera_from_world.row(2) * point + camera.translation.z();
}

void draw_line(cv::Mat& image, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
               const cv::Scalar& colour, int thickness_px) {
  if (from.hasNaN() || to.hasNaN()) return;
  cv::line(image, subpixel(from), subpixel(to), colour, thickness_px, cv::LINE_AA, kSubpixelBits);
}

void draw_disc(cv::Mat& image, const Eigen::Vector2d& centre, double radius_px,
               const cv::Scalar& colour) {
  if (centre.hasNaN() || !(radius_px < 1e4)) return;
  cv::circle(image, subpixel(centre), cvRound(radius_px * (1 << kSubpixelBits)), colour, cv::FILLED,
             cv::LINE_AA, kSubpixelBits);
}

/// The figure's points at one frame, [points x 3].
MatrixD points_at(const Figure& figure, int frame) {
  return figure.points.row(frame).reshaped<Eigen::RowMajor>(figure.points.cols() / 3, 3);
}

void draw_shadow(cv::Mat& image, const Camera& camera, const Figure& figure, MatrixD points,
                 double px_per_unit) {
  points.col(1).setConstant(figure.ground_y);
  const MatrixD pixels = project_points(camera, points);
  const int thickness_px = std::max(1, cvRound(0.03 * figure.height * px_per_unit));
  for (const Figure::Bone& bone : figure.bones) {
    draw_line(image, pixels.row(bone.from), pixels.row(bone.to), kShadow, thickness_px);
  }
}

void draw_head(cv::Mat& image, const Eigen::Vector2d& neck, const Eigen::Vector2d& top,
               double length_px, const cv::Scalar& colour) {
  const Eigen::Vector2d centre = 0.5 * (neck + top);
  draw_disc(image, centre, 0.5 * length_px + 1.5, kPaper);
  draw_disc(image, centre, 0.5 * length_px, colour);
}

/// By joint, whether it is above the joint that carries the body: it stays where it is, metres
/// away.
std::vector<bool> apart_from_body(const Skeleton& skeleton, int root) {
  std::vector<bool> apart(skeleton.joints.size(), false);
  for (int joint = skeleton.joints[static_cast<std::size_t>(root)].parent; joint >= 0;
       joint = skeleton.joints[static_cast<std::size_t>(joint)].parent)
    apart[static_cast<std::size_t>(joint)] = true;
  return apart;
}

}  // namespace

Figure::Figure(const Motion& motion) : fps(motion.fps()) {
  const Skeleton& skeleton = motion.skeleton;
  const int joints = skeleton.joint_count();
  const int root_joint = moving_root({&motion});
  const std::vector<bool> apart = apart_from_body(skeleton, root_joint);
  std::vector<Eigen::Vector3d> sites;
  std::vector<int> site_joints;
  for (int j = 0; j < joints; ++j) {
    const Joint& joint = skeleton.joints[static_cast<std::size_t>(j)];
    if (apart[static_cast<std::size_t>(j)]) continue;
    const Side side = side_of(joint.name);
    if (joint.parent >= 0 && !apart[static_cast<std::size_t>(joint.parent)])
      bones.push_back({joint.parent, j, side, false});
    for (const Eigen::Vector3d& site : joint.end_sites) {
      const bool is_head = joint.name.find("ead") != std::string::npos && site.norm() > 0;
      bones.push_back({j, joints + static_cast<int>(sites.size()), side, is_head});
      sites.push_back(site);
      site_joints.push_back(j);
    }
  }
  points.resize(motion.frames(), 3 * (joints + static_cast<Eigen::Index>(sites.size())));
  root.resize(motion.frames(), 3);
  for (int frame = 0; frame < motion.frames(); ++frame) {
    const WorldPose pose = forward_kinematics(skeleton, motion.channels.row(frame));
    for (int j = 0; j < joints; ++j) {
      const int shown = apart[static_cast<std::size_t>(j)] ? root_joint : j;
      points.row(frame).segment<3>(3 * j) =
          pose.position[static_cast<std::size_t>(shown)].transpose();
    }
    for (std::size_t s = 0; s < sites.size(); ++s) {
      const auto joint = static_cast<std::size_t>(site_joints[s]);
      const Eigen::Vector3d tip = pose.position[joint] + pose.world_from_joint[joint] * sites[s];
      points.row(frame).segment<3>(3 * (joints + static_cast<Eigen::Index>(s))) = tip.transpose();
    }
    root.row(frame) = points.row(frame).segment<3>(3 * root_joint);
  }
  const auto heights = points(Eigen::all, Eigen::seqN(1, points.cols() / 3, 3));
  ground_y = heights.minCoeff();
  root.col(1).setConstant(ground_y);
  height = std::max(body_height(skeleton), 1e-6);
}

int Figure::frame_at(double t_s) const {
  return std::clamp(static_cast<int>(std::lround(t_s * fps)), 0,
                    static_cast<int>(points.rows()) - 1);
}

void draw_ground(cv::Mat& image, const Camera& camera, const Eigen::Vector3d& centre,
                 double spacing) {
  constexpr int kLines = 9, kPieces = 4;  // to each side; lines are cut up so that they can fade
  const Eigen::Vector3d snapped(std::round(centre.x() / spacing) * spacing, centre.y(),
                                std::round(centre.z() / spacing) * spacing);
  const double step = spacing / kPieces;
  for (const int axis : {0, 2}) {
    for (int line = -kLines; line <= kLines; ++line) {
      MatrixD ends(2 * kLines * kPieces + 1, 3);
      for (Eigen::Index i = 0; i < ends.rows(); ++i) {
        Eigen::Vector3d end = snapped;
        end[2 - axis] += line * spacing;
        end[axis] += static_cast<double>(i - kLines * kPieces) * step;
        ends.row(i) = end.transpose();
      }
      const MatrixD pixels = project_points(camera, ends);
      for (Eigen::Index i = 0; i + 1 < ends.rows(); ++i) {
        const double far = (ends.row(i).transpose() - centre).norm() / (kLines * spacing);
        if (far >= 1) continue;
        draw_line(image, pixels.row(i), pixels.row(i + 1), mix(kGrid, kPaper, far * far), 1);
      }
    }
  }
}

void draw_figure(cv::Mat& image, const Camera& camera, const Figure& figure, int frame,
                 Palette palette) {
  const MatrixD points = points_at(figure, frame);
  const MatrixD pixels = project_points(camera, points);
  const Eigen::Vector3d centre = points.colwise().mean().transpose();
  const double centre_depth = depth_of(camera, centre);
  if (!(centre_depth > 0)) return;
  const double px_per_unit = camera.fy_px / centre_depth;
  const int thickness_px = std::max(2, cvRound(0.024 * figure.height * px_per_unit));
  if (palette == Palette::first) draw_shadow(image, camera, figure, points, px_per_unit);

  const auto middle = [&](const Figure::Bone& bone) -> Eigen::Vector3d {
    return 0.5 * (points.row(bone.from) + points.row(bone.to)).transpose();
  };
  std::vector<Figure::Bone> bones = figure.bones;
  std::sort(bones.begin(), bones.end(), [&](const Figure::Bone& a, const Figure::Bone& b) {
    return depth_of(camera, middle(a)) > depth_of(camera, middle(b));
  });
  for (const Figure::Bone& bone : bones) {
    const double behind = (depth_of(camera, middle(bone)) - centre_depth) / figure.height;
    const double paleness = std::clamp(0.18 + 0.75 * behind, 0.0, 0.5);
    const cv::Scalar colour = mix(colour_of(bone.side, palette), kPaper, paleness);
    const Eigen::Vector2d from = pixels.row(bone.from), to = pixels.row(bone.to);
    if (bone.is_head) {
      const double length = (points.row(bone.from) - points.row(bone.to)).norm();
      draw_head(image, from, to, length * px_per_unit, colour);
      continue;
    }
    draw_line(image, from, to, kPaper, thickness_px + 3);  // sets limbs off where they cross
    draw_line(image, from, to, colour, thickness_px);
    draw_disc(image, from, 0.62 * thickness_px, mix(colour, kInk, 0.25));
    draw_disc(image, to, 0.62 * thickness_px, mix(colour, kInk, 0.25));
  }
}

void draw_text(cv::Mat& image, const std::string& text, int x_px, int y_px, double scale) {
  const cv::Point baseline(x_px, y_px + cvRound(20 * scale));
  cv::putText(image, text, baseline, cv::FONT_HERSHEY_SIMPLEX, 0.8 * scale, kInk,
              std::max(1, cvRound(1.2 * scale)), cv::LINE_AA);
}

cv::Mat blank_panel(int width_px, int height_px) {
  return cv::Mat(height_px, width_px, CV_8UC3, kPaper);
}

}  // namespace mcdbn::rendering
