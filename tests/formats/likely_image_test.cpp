// Which image is taken where nothing gives its size: of shares a lying or an upright one, of pixels
// the smallest that holds them.
#include "formats/likely_image.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "formats/layout_samples.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace likely_image_test {

namespace {

/// A figure that stands, seen in an image of that size, as MediaPipe's shares.
std::filesystem::path shares_file(const ScratchFolder& folder, const ImageSize& image) {
  Track2d figure = sample_figure("MEDIAPIPE_33");
  figure.width_px = image.width_px;
  figure.height_px = image.height_px;
  track_format("mediapipe").write(folder / "shares.csv", figure);
  return folder / "shares.csv";
}

/// One frame of that figure, as shares, of the joints from `first` on.
std::vector<std::vector<SeenPerson>> frame_of(const Track2d& figure, const ImageSize& image,
                                              int first, int joints) {
  SeenPerson person;
  for (int joint = 0; joint < figure.joint_count(); ++joint) {
    person.x_px.push_back(figure.x_px(0, joint) / image.width_px);
    person.y_px.push_back(figure.y_px(0, joint) / image.height_px);
    person.confidence.push_back(joint >= first && joint < first + joints ? 1 : 0);
  }
  return {{person}};
}

}  // namespace

TEST_CASE("likely image: shares of an upright film are read as such, and both shapes are named") {
  const ScratchFolder folder;
  const auto read = [&](const ImageSize& image, std::vector<std::string>& notices) {
    const Track2d track = read_track(shares_file(folder, image), {}, &notices);
    return ImageSize{track.width_px, track.height_px};
  };
  std::vector<std::string> upright, lying;
  CHECK(read({720, 1280}, upright) == kUprightImage);
  CHECK(upright.front() ==
        "coordinates are shares of the image, taken as 1080 x 1920 px, for the file does not give "
        "its size and people look likelier so than in 1920 x 1080; set it with `image-size`");
  CHECK(read({1280, 720}, lying) == kLyingImage);
  CHECK(lying.front().find("taken as 1920 x 1080 px") != std::string::npos);
  CHECK(lying.front().find("likelier so than in 1080 x 1920") != std::string::npos);
}

TEST_CASE("likely image: a size that is given holds whatever people look like") {
  const ScratchFolder folder;
  const auto file = shares_file(folder, {720, 1280});
  CHECK(read_track(file, {.image_size = ImageSize{640, 480}}).width_px == 640);
  CHECK(read_track(file, {.camera_image = ImageSize{1280, 720}}).width_px == 1280);
}

TEST_CASE("likely image: a face, feet, and joints that are no human's show no shape") {
  const Track2d figure = sample_figure("MEDIAPIPE_33");
  constexpr int kFaceJoints = 11, kAnkles = 27, kFootJoints = 6, kAll = 33;
  for (const ImageSize& image : {kLyingImage, kUprightImage}) {
    const auto shown = [&](int first, int joints) {
      return likely_image(figure.keypoints, frame_of(figure, image, first, joints));
    };
    CHECK(shown(0, kAll) == image);
    CHECK(!shown(0, kFaceJoints));
    CHECK(!shown(kAnkles, kFootJoints));
    CHECK(!likely_image({}, frame_of(figure, image, 0, kAll)));
    CHECK(!likely_image(figure.keypoints, {}));
  }
}

TEST_CASE(
    "likely image: pixels a little beyond the edge of one are of that one, and it is said so") {
  const ScratchFolder folder;
  const auto read = [&](int x_px, int y_px, std::vector<std::string>& notices) {
    const std::string keypoints = "[[" + std::to_string(x_px) + "," + std::to_string(y_px) + ",1],";
    std::string others;
    for (int joint = 1; joint < 17; ++joint) others += joint < 16 ? "[90,80,1]," : "[90,80,1]]";
    const Track2d track = read_track(
        folder.write("beyond.json", "{\"keypoints\":" + keypoints + others + "}"), {}, &notices);
    return ImageSize{track.width_px, track.height_px};
  };
  std::vector<std::string> within, beyond;
  CHECK(read(733, 1297, within) == ImageSize{720, 1280});
  CHECK(within.front() ==
        "the file does not give the image's size: taken as 720 x 1280 px, which holds all that was "
        "seen but for 2 % (x to 733, y to 1297); set it with `image-size`");
  CHECK(read(735, 1297, beyond) == ImageSize{1080, 1920});
}

}  // namespace likely_image_test
