#include "mcdbn/drawing/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/interruption.hpp"
#include "base/text_file.hpp"
#include "drawing/film_file.hpp"
#include "drawing/render_figure.hpp"
#include "drawing/render_over.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;
using rendering::Figure;
using rendering::Palette;

struct Size {
  int width_px, height_px;
};
constexpr Size kVideoPanel{640, 720}, kSheetPanel{240, 320};
constexpr double kGridSpacing = 0.3;  ///< in body heights

/// Where place_camera aims: the middle of the points' box.
Eigen::Vector3d box_centre(const MatrixD& points) {
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> rows(
      points.data(), points.size() / 3, 3);
  return 0.5 * (rows.colwise().minCoeff() + rows.colwise().maxCoeff()).transpose();
}

double distance_to(const Camera& camera, const Eigen::Vector3d& point) {
  return camera.camera_from_world.row(2) * point + camera.translation.z();
}

/// One panel: its figures, and the camera that sees all of their motion.
class Panel {
 public:
  Panel(std::vector<const Figure*> figures, std::string label, const RenderOptions& options,
        Size size);

  /// Distance of the camera in body heights; panels side by side share the largest, unless one is
  /// given.
  double distance_in_heights() const { return distance_ / figures_.front()->height; }
  void set_distance_in_heights(double heights) { distance_ = heights * figures_.front()->height; }

  cv::Mat draw(double t_s) const;
  const std::string& label() const { return label_; }

 private:
  Camera camera_at(double t_s) const;
  CameraPlacement placement_at(double t_s) const;
  Eigen::Vector3d origin_at(double t_s) const;
  MatrixD framed_points() const;

  std::vector<const Figure*> figures_;
  std::string label_;
  const RenderOptions& options_;
  Size size_;
  MatrixD framed_;  ///< [1 x 3·points] what has to be in view
  double distance_ = 0;
};

Panel::Panel(std::vector<const Figure*> figures, std::string label, const RenderOptions& options,
             Size size)
    : figures_(std::move(figures)), label_(std::move(label)), options_(options), size_(size) {
  framed_ = framed_points();
  const Eigen::Vector3d centre = box_centre(framed_);
  const int directions = options.orbit ? 36 : 1;
  for (int i = 0; i < directions; ++i) {
    CameraPlacement placement = placement_at(0);
    placement.azimuth_deg += 360.0 * i / directions;
    placement.distance = options.placement.distance;
    distance_ = std::max(distance_, distance_to(place_camera(framed_, placement), centre));
  }
}

/// Every point of every frame, [1 x 3·points]; about the root where the camera follows it.
MatrixD Panel::framed_points() const {
  std::vector<double> all;
  for (const Figure* figure : figures_) {
    for (Eigen::Index frame = 0; frame < figure->points.rows(); ++frame) {
      const Eigen::Vector3d origin = origin_at(static_cast<double>(frame) / figure->fps);
      for (Eigen::Index column = 0; column < figure->points.cols(); ++column) {
        all.push_back(figure->points(frame, column) - origin[column % 3]);
      }
    }
  }
  return Eigen::Map<const MatrixD>(all.data(), 1, static_cast<Eigen::Index>(all.size()));
}

/// The point that the camera follows.
Eigen::Vector3d Panel::origin_at(double t_s) const {
  const Figure& leader = *figures_.front();
  if (!options_.follow_root) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d root = leader.root.row(leader.frame_at(t_s)).transpose();
  return {root.x(), 0, root.z()};
}

CameraPlacement Panel::placement_at(double t_s) const {
  CameraPlacement placement = options_.placement;
  placement.width_px = size_.width_px;
  placement.height_px = size_.height_px;
  if (options_.orbit) placement.azimuth_deg += options_.orbit_deg_per_s * t_s;
  if (distance_ > 0) placement.distance = distance_;
  return placement;
}

Camera Panel::camera_at(double t_s) const {
  if (options_.camera) return scaled(*options_.camera, size_.width_px, size_.height_px);
  Camera camera = place_camera(framed_, placement_at(t_s));
  camera.translation -= camera.camera_from_world * origin_at(t_s);
  return camera;
}

cv::Mat Panel::draw(double t_s) const {
  cv::Mat image = rendering::blank_panel(size_.width_px, size_.height_px);
  const Camera camera = camera_at(t_s);
  const Figure& leader = *figures_.front();
  const Eigen::Vector3d ground = leader.root.row(leader.frame_at(t_s)).transpose();
  rendering::draw_ground(image, camera, ground, kGridSpacing * leader.height);
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    const Figure& figure = *figures_[i];
    const Palette palette = i == 0 ? Palette::first : Palette::second;
    rendering::draw_figure(image, camera, figure, figure.frame_at(t_s), palette);
  }
  return image;
}

void check(const std::vector<RenderClip>& clips, const RenderOptions& options) {
  if (clips.empty()) throw InputError("nothing to render; give at least one clip");
  for (const RenderClip& clip : clips) {
    if (clip.motion.frames() == 0) {
      throw InputError(fmt::format("{}: the clip has no frames; nothing to render", clip.label));
    }
  }
  if (options.fps < 0 || options.fps > 240) {
    throw ConfigError(fmt::format("fps is {}; choose up to 240 frames a second", options.fps));
  }
  if (options.orbit && !(std::abs(options.orbit_deg_per_s) >= 1)) {
    throw ConfigError(fmt::format("orbit speed is {} degrees a second; choose 1 or more",
                                  options.orbit_deg_per_s));
  }
  if (options.sheet_columns < 1 || options.sheet_columns > 64) {
    throw ConfigError(
        fmt::format("{} columns in a contact sheet; choose 1 to 64", options.sheet_columns));
  }
  // A sheet has as many pictures; OpenCV would take the memory of any.
  constexpr double kMost_pixels = 1e8;
  const double pixels = static_cast<double>(options.placement.width_px) *
                        options.placement.height_px * options.sheet_columns;
  if (pixels > kMost_pixels)
    throw ConfigError(fmt::format("a row of {} pictures of {} x {} px; lower `image-size`",
                                  options.sheet_columns, options.placement.width_px,
                                  options.placement.height_px));
}

/// Even numbers, as video encoders want them.
Size panel_size(const RenderOptions& options, Size usual) {
  const CameraPlacement& placement = options.placement;
  Size size{placement.width_px > 0 ? placement.width_px : usual.width_px,
            placement.height_px > 0 ? placement.height_px : usual.height_px};
  if (options.camera && placement.height_px == 0) {
    size.width_px = cvRound(size.height_px * static_cast<double>(options.camera->width_px) /
                            options.camera->height_px);
  }
  return {size.width_px + size.width_px % 2, size.height_px + size.height_px % 2};
}

std::vector<Panel> make_panels(const std::vector<RenderClip>& clips,
                               const std::vector<Figure>& figures, const RenderOptions& options,
                               Size size) {
  std::vector<Panel> panels;
  if (options.overlay) {
    std::vector<const Figure*> all;
    std::string label;
    for (std::size_t i = 0; i < clips.size(); ++i) {
      all.push_back(&figures[i]);
      label += (i > 0 ? " + " : "") + clips[i].label;
    }
    panels.emplace_back(all, label, options, size);
    return panels;
  }
  for (std::size_t i = 0; i < clips.size(); ++i) {
    panels.emplace_back(std::vector<const Figure*>{&figures[i]}, clips[i].label, options, size);
  }
  if (options.placement.distance) return panels;
  double heights = 0;
  for (const Panel& panel : panels) heights = std::max(heights, panel.distance_in_heights());
  for (Panel& panel : panels) panel.set_distance_in_heights(heights);
  return panels;
}

double duration_s(const std::vector<Figure>& figures) {
  double longest = 0;
  for (const Figure& figure : figures) {
    longest = std::max(longest, static_cast<double>(figure.points.rows()) / figure.fps);
  }
  return longest;
}

void render_video(const std::vector<Panel>& panels, const std::vector<Figure>& figures,
                  const fs::path& path, double fps) {
  rendering::FilmWriter film(path, fps);
  const auto frame_at = [&](double t_s) {
    cv::Mat image;
    for (const Panel& panel : panels) {
      cv::Mat part = panel.draw(t_s);
      rendering::draw_text(part, panel.label(), 14, 10, 0.7);
      rendering::draw_text(part, fmt::format("{:.2f} s", t_s), 14, part.rows - 28, 0.6);
      if (image.empty()) {
        image = part;
      } else {
        cv::hconcat(image, part, image);
      }
    }
    return image;
  };
  const int frames = rendering::film_frames(duration_s(figures), film.fps(), path);
  for (int i = 0; i < frames; ++i) {
    check_interruption();
    film.write(frame_at(i / film.fps()));
  }
  film.finish();
}

/// Frames at even times: one row a panel, or two rows of a single one.
void render_sheet(const std::vector<Panel>& panels, const std::vector<Figure>& figures,
                  const fs::path& path, int columns) {
  const int rows = panels.size() == 1 ? 2 : static_cast<int>(panels.size());
  const int times = panels.size() == 1 ? 2 * columns : columns;
  const double last_s = duration_s(figures) - 1 / figures.front().fps;
  cv::Mat sheet;
  for (int row = 0; row < rows; ++row) {
    cv::Mat strip;
    for (int column = 0; column < columns; ++column) {
      check_interruption();
      const Panel& panel = panels[panels.size() == 1 ? 0 : static_cast<std::size_t>(row)];
      const int index = panels.size() == 1 ? row * columns + column : column;
      const double t_s = times > 1 ? last_s * index / (times - 1) : 0;
      cv::Mat cell = panel.draw(t_s);
      rendering::draw_text(cell, fmt::format("{:.2f} s", t_s), 8, cell.rows - 20, 0.5);
      if (column == 0 && (row == 0 || panels.size() > 1)) {
        rendering::draw_text(cell, panel.label(), 8, 6, 0.5);
      }
      if (strip.empty()) {
        strip = cell;
      } else {
        cv::hconcat(strip, cell, strip);
      }
    }
    sheet.push_back(strip);
  }
  std::vector<unsigned char> png;
  cv::imencode(".png", sheet, png);
  write_text_file(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace

void render(const std::vector<RenderClip>& clips, const fs::path& path,
            const RenderOptions& options, std::vector<std::string>* notices) {
  check(clips, options);
  const bool video = path.extension() == ".mp4";
  if (!video && path.extension() != ".png") {
    throw ConfigError(
        fmt::format("{}: unknown kind of file; end the name in .mp4 or .png", path.string()));
  }
  std::vector<Figure> figures;
  figures.reserve(clips.size());
  for (const RenderClip& clip : clips) figures.emplace_back(clip.motion);
  if (!options.over.empty()) {
    rendering::render_over(figures, path, options, notices);
    return;
  }
  const Size size = panel_size(options, video ? kVideoPanel : kSheetPanel);
  const std::vector<Panel> panels = make_panels(clips, figures, options, size);
  if (video) {
    constexpr double kHighest_fps = 60;
    const double fps = options.fps > 0 ? options.fps : std::min(figures.front().fps, kHighest_fps);
    render_video(panels, figures, path, fps);
  } else {
    render_sheet(panels, figures, path, options.sheet_columns);
  }
}

}  // namespace mcdbn
