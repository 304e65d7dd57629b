// Where the pose does not match the rays: the root's depth from how large body and image are.

#include <doctest/doctest.h>

#include <string>

#include "fitting/root_trajectory.hpp"
#include "mcdbn/base/errors.hpp"

namespace root_by_size_test {

using namespace mcdbn;

namespace {

const Eigen::Vector3d kRoot{0.3, -0.2, 4};

/// Five joints of a flat body across the view of a camera at the origin. [1 x 15]
MatrixD flat_body() {
  MatrixD body(1, 15);
  body << 0, 0, 0, 0.2, -0.5, 0, -0.2, -0.5, 0, 0.15, 0.8, 0, -0.1, 0.7, 0;
  return body;
}

/// The body as the camera sees it in `frames` frames, and the pose that stands in each, the first
/// `turned` of them upside down.
struct Scene {
  MatrixD relative;
  TrackRays track;

  Scene(int frames, int turned, const MatrixD& body = flat_body()) {
    const Eigen::Index joints = body.cols() / 3;
    relative = body.replicate(frames, 1);
    track.asked = static_cast<int>(joints);
    track.rays.resize(frames, 2 * joints);
    track.confidence = MatrixD::Ones(frames, joints);
    for (Eigen::Index k = 0; k < joints; ++k) {
      track.joint_names.push_back("joint " + std::to_string(k));
      track.indices.push_back(static_cast<int>(k));
      const Eigen::Vector3d place = body.row(0).segment<3>(3 * k).transpose() + kRoot;
      track.rays.middleCols(2 * k, 2) =
          (place.head<2>() / place.z()).transpose().replicate(frames, 1);
      relative.block(0, 3 * k, turned, 2) *= -1;
    }
  }
  RootPath path() const { return root_trajectory(relative, track, Camera{}, MatrixD(0, 3)); }
};

}  // namespace

TEST_CASE("root by size: a body that is upside down is as far away, its middle where it is seen") {
  for (const int frames : {1, 9}) {
    CAPTURE(frames);
    const RootPath path = Scene(frames, frames).path();
    CHECK(path.by_size);
    // Middles meet: root - middle = true root + middle.
    const Eigen::Vector3d middle =
        flat_body().reshaped<Eigen::RowMajor>(5, 3).colwise().mean().transpose();
    const Eigen::RowVector3d wanted = (kRoot + 2 * middle).transpose();
    CHECK((path.root.rowwise() - wanted).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("root by size: frames of which most match are bridged as if the others were not seen") {
  for (const int turned : {0, 4}) {
    CAPTURE(turned);
    const RootPath path = Scene(9, turned).path();
    CHECK_FALSE(path.by_size);
    CHECK((path.root.rowwise() - kRoot.transpose()).cwiseAbs().maxCoeff() < 1e-6);
  }
  Scene scene(9, 5);
  CHECK(scene.path().by_size);
  // Frames that show too little do not count.
  scene.track.confidence.topRows(2).rightCols(3).setZero();
  CHECK_FALSE(scene.path().by_size);
}

TEST_CASE("root by size: every joint is before the camera") {
  MatrixD body(1, 15);
  body << 0.1, 0, 0, -0.1, 0, 0, 0, 0.1, 0, 0, -0.1, 0, 0, 0, -2;
  Scene scene(1, 1, body);
  scene.track.rays << 0.5, 0, -0.5, 0, 0, 0.5, 0, -0.5, 0, 0;
  // By size alone at 0.2, with the last joint behind the camera: a tenth of its depth is left to
  // it.
  const MatrixD root = scene.path().root;
  CHECK((root - MatrixD(Eigen::RowVector3d(0, 0, 2 / 0.9))).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("root by size: what cannot be placed is refused for what it is") {
  Scene few(9, 9), one_place(9, 9);
  few.track.confidence.rightCols(3).setZero();
  CHECK_THROWS_WITH_AS(few.path(), doctest::Contains("never shows 3 joints of the model at once;"),
                       InputError);
  one_place.track.rays.setConstant(0.1);
  CHECK_THROWS_WITH_AS(one_place.path(), doctest::Contains("all joints of a frame at one place"),
                       InputError);
}

}  // namespace root_by_size_test
