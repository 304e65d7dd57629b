#include "camera/track_rays.hpp"

#include <doctest/doctest.h>

#include "camera/odd_camera.hpp"

using namespace mcdbn;

TEST_CASE("track rays: the joints that were asked for and are there, as the camera saw them") {
  const Camera camera = test::odd_camera();
  Track2d track;
  track.joint_names = {"Hand", "Hips", "Foot"};
  track.fps = 47;
  MatrixD points(2, 9);
  points << 10, 20, 300, 0, 0, 250, -30, 90, 280,  //
      12, 18, 310, 1, 2, 240, -20, 80, 290;
  // Through the lens in camera axes.
  Camera lens = camera;
  lens.camera_from_world.setIdentity();
  lens.translation.setZero();
  const MatrixD pixels = project_points(lens, points);
  track.x_px = pixels(Eigen::all, Eigen::seqN(0, 3, 2));
  track.y_px = pixels(Eigen::all, Eigen::seqN(1, 3, 2));
  track.confidence = MatrixD::Constant(2, 3, 0.5);
  track.confidence(1, 2) = 0;
  const TrackRays rays = track_rays({"Hips", "Tail", "Foot"}, track, camera);
  CHECK(rays.joint_names == std::vector<std::string>{"Hips", "Foot"});
  CHECK(rays.indices == std::vector<int>{0, 2});
  CHECK(rays.asked == 3);
  CHECK(rays.fps == 47);
  REQUIRE(rays.joints() == 2);
  REQUIRE(rays.frames() == 2);
  for (int frame = 0; frame < 2; ++frame) {
    for (int joint = 0; joint < 2; ++joint) {
      const Eigen::Vector3d point = points.row(frame).segment<3>(3 * (joint + 1));
      const Eigen::Vector2d ray = rays.rays.row(frame).segment<2>(2 * joint);
      CHECK((ray - point.head<2>() / point.z()).norm() < 1e-6);
    }
  }
  CHECK(rays.seen(0, 1));
  CHECK_FALSE(rays.seen(1, 1));
  CHECK(rays.confidence(0, 0) == 0.5);
}
