#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/motion/skeleton.hpp"
#include "motion/joint_sides.hpp"

namespace mcdbn::rendering {

/// A clip made ready to draw.
struct Figure {
  struct Bone {
    int from, to;  ///< points
    Side side;
    bool is_head;  ///< drawn as a head, not as a line
  };

  explicit Figure(const Motion& motion);

  /// [frames x 3·points]: the joints, then the End Sites; world. A joint above the one that carries
  /// the body (moving_root) is no part of the figure: it has no bones, and its point is that one's.
  MatrixD points;
  MatrixD root;  ///< [frames x 3] on the ground below the root
  std::vector<Bone> bones;
  double fps;
  double height;    ///< about that of the body, file units
  double ground_y;  ///< the lowest point of the clip

  /// The frame shown at that time; the last one holds.
  int frame_at(double t_s) const;
  Eigen::Vector3d point(int frame, int index) const {
    return points.row(frame).segment<3>(3 * index).transpose();
  }
};

/// Colours of a figure: the second one of an overlay has its own.
enum class Palette { first, second };

/// A grid on the ground around `centre`, fading with distance. @param spacing world units
void draw_ground(cv::Mat& image, const Camera& camera, const Eigen::Vector3d& centre,
                 double spacing);
void draw_figure(cv::Mat& image, const Camera& camera, const Figure& figure, int frame,
                 Palette palette);
/// Text with its upper left corner there; `scale` 1 is about 20 px high.
void draw_text(cv::Mat& image, const std::string& text, int x_px, int y_px, double scale);
cv::Mat blank_panel(int width_px, int height_px);

}  // namespace mcdbn::rendering
