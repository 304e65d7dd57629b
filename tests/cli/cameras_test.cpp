// Cameras whose images or units are not those of the track and of the motion.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "base/text_file.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "tiny_pipeline.hpp"

namespace cameras_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

fs::path walk() {
  return TinyPipeline::instance().motion() / "walk_s02_01.bvh";
}

/// A clip's track, of 1920 x 1080 px, and the camera that sees it.
struct Seen {
  fs::path track, camera;

  Seen(const ScratchFolder& folder, const fs::path& clip)
      : track(folder / (clip.stem().string() + ".csv")),
        camera(folder / (clip.stem().string() + ".yaml")) {
    REQUIRE(run_cli(fmt::format("project '{}' -o '{}' --write-camera '{}'", clip.string(),
                                track.string(), camera.string()))
                .exit_code == 0);
  }
};

/// The track of the film that was scaled to half its width and height.
fs::path halved(const ScratchFolder& folder, const fs::path& track) {
  mcdbn::Track2d half = mcdbn::read_track_csv(track);
  half.x_px *= 0.5;
  half.y_px *= 0.5;
  half.width_px /= 2;
  half.height_px /= 2;
  write_track_csv(folder / "half.csv", half);
  return folder / "half.csv";
}

/// The track without the line that gives its rate and its size.
fs::path without_size(const ScratchFolder& folder, const fs::path& track) {
  const std::string text = mcdbn::read_text_file(track);
  return folder.write("unsized_" + track.filename().string(), text.substr(text.find('\n') + 1));
}

CliResult regenerate(const fs::path& track, const fs::path& camera, const fs::path& output,
                     const std::string& options) {
  return run_cli(fmt::format("regenerate --model '{}' --input '{}' --camera '{}' -o '{}' {}",
                             TinyPipeline::instance().model().string(), track.string(),
                             camera.string(), output.string(), options));
}

mcdbn::MatrixD root_of(const fs::path& motion) {
  return mcdbn::joint_positions(mcdbn::read_bvh(motion)).leftCols(3);
}

double farthest(const mcdbn::MatrixD& a, const mcdbn::MatrixD& b) {
  REQUIRE(a.rows() == b.rows());
  return (a - b).cwiseAbs().maxCoeff();
}

/// The clip in units of that many of its own.
fs::path in_other_units(const ScratchFolder& folder, const fs::path& clip, double units) {
  mcdbn::Motion motion = mcdbn::read_bvh(clip);
  Eigen::Index column = 0;
  for (mcdbn::Joint& joint : motion.skeleton.joints) {
    joint.offset /= units;
    for (Eigen::Vector3d& site : joint.end_sites) site /= units;
    for (const mcdbn::Channel channel : joint.channels) {
      if (!mcdbn::is_rotation(channel)) motion.channels.col(column) /= units;
      ++column;
    }
  }
  write_bvh(folder / "other_units.bvh", motion);
  return folder / "other_units.bvh";
}

/// Centimetres; read by a camera of twice the size it is metres.
constexpr double kNear = 20;

constexpr const char* kNotice =
    "its images are 960 x 540 px, those of the camera 1920 x 1080 px: the camera is scaled to them";

}  // namespace

TEST_CASE("regenerate: the track of a scaled film has the motion of the film's own track") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const Seen seen(folder, walk());
  const fs::path half = halved(folder, seen.track), out = folder / "out.bvh";
  const CliResult full = regenerate(seen.track, seen.camera, out, "--fit none");
  CAPTURE(full.standard_error);
  REQUIRE(full.exit_code == 0);
  CHECK(full.standard_error.find("the camera is scaled") == std::string::npos);
  const mcdbn::MatrixD wanted = mcdbn::read_bvh(out).channels;
  const auto check_same = [&](const fs::path& track, const std::string& options, bool scaled) {
    CAPTURE(track.filename().string());
    const CliResult result = regenerate(track, seen.camera, out, "--fit none " + options);
    CAPTURE(result.standard_error);
    REQUIRE(result.exit_code == 0);
    CHECK((result.standard_error.find(kNotice) != std::string::npos) == scaled);
    CHECK(farthest(mcdbn::read_bvh(out).channels, wanted) < 1e-3);
  };
  const fs::path written = folder / "written.yaml";
  check_same(half, fmt::format("--write-camera '{}'", written.string()), true);
  CHECK(mcdbn::read_camera(written).width_px == 960);
  CHECK(mcdbn::read_camera(written).fx_px ==
        doctest::Approx(mcdbn::read_camera(seen.camera).fx_px / 2));
  // A size that only the command line gives; none at all, which is the camera's.
  check_same(without_size(folder, half), "--image-size 960 540", true);
  check_same(without_size(folder, seen.track), "", false);
  // So does the fit. Its noise has a least number of pixels, so it is only nearly the same.
  REQUIRE(regenerate(seen.track, seen.camera, out, "").exit_code == 0);
  const mcdbn::MatrixD root = root_of(out);
  REQUIRE(regenerate(half, seen.camera, out, "").exit_code == 0);
  CHECK(farthest(root_of(out), root) < kNear);
}

TEST_CASE("regenerate --follow: the track of a scaled film has the root of the film's own track") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const Seen seen(folder, walk());
  const fs::path out = folder / "out.bvh";
  REQUIRE(regenerate(seen.track, seen.camera, out, "--follow").exit_code == 0);
  const mcdbn::MatrixD root = root_of(out);
  const CliResult result = regenerate(halved(folder, seen.track), seen.camera, out, "--follow");
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK(result.standard_error.find(kNotice) != std::string::npos);
  CHECK(farthest(root_of(out), root) < kNear);
}

TEST_CASE("regenerate: a track of images of another shape than the camera's is refused") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const Seen seen(folder, walk());
  const std::string message =
      seen.track.string() +
      ": its images are 544 x 960 px, those of the camera 1920 x 1080 px, which is another shape; "
      "set the track's with --image-size";
  for (const char* options : {"", "--follow"}) {
    CAPTURE(options);
    const CliResult result = regenerate(seen.track, seen.camera, folder / "out.bvh",
                                        fmt::format("--image-size 544 960 {}", options));
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 3);
    CHECK(result.standard_error.find(message) != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "out.bvh"));
  }
}

TEST_CASE("project --write-camera: a clip in other units is seen by the same camera") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const fs::path out = folder / "out.bvh";
  const auto root = [&](const fs::path& clip) {
    const Seen seen(folder, clip);
    const CliResult result = regenerate(seen.track, seen.camera, out, "--fit none");
    CAPTURE(result.standard_error);
    REQUIRE(result.exit_code == 0);
    return root_of(out);
  };
  const mcdbn::MatrixD wanted = root(walk());
  // CMU's, in centimetres.
  CHECK(farthest(root(in_other_units(folder, walk(), 5.64)), wanted) < 0.05);
}

}  // namespace cameras_test
