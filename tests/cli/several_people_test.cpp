// Several people of one track, filmed by one camera: where they stand to one another.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/text_file.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/body_size.hpp"
#include "tiny_pipeline.hpp"

namespace several_people_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// The frames of a folder of OpenPose's, in order.
std::vector<nlohmann::json> frames_in(const fs::path& folder) {
  std::vector<nlohmann::json> frames;
  for (const fs::path& file : std::set<fs::path>(fs::directory_iterator(folder), {}))
    frames.push_back(nlohmann::json::parse(mcdbn::read_text_file(file)));
  return frames;
}

/// Two people whom one camera filmed side by side, in OpenPose's files.
struct Film {
  ScratchFolder folder;
  double metre = 0;
  fs::path track = folder / "both";
  /// Of the frames: as those of a camera that counts milliseconds, more than 32 bits.
  static constexpr std::size_t kFirstNumber = 3'487'918'223;

  /// @param apart_m the second stands so far to the left of the first
  /// @param hidden_frames the second is not seen in the first so many
  /// @param feet of how many, the last ones, a foot is all that is seen
  Film(double apart_m, std::size_t hidden_frames, std::size_t feet = 0) {
    const fs::path first = TinyPipeline::instance().motion() / "walk_s02_01.bvh",
                   second = folder / "second.bvh", camera = folder / "camera.yaml";
    mcdbn::Motion moved = mcdbn::read_bvh(first);
    metre = mcdbn::file_units_per_metre(moved.skeleton);
    moved.channels.col(0).array() += apart_m * metre;
    write_bvh(second, moved);
    project(first, fmt::format("--camera-azimuth 0 --camera-distance {} --write-camera '{}'",
                               8 * metre, camera.string()));
    project(second, fmt::format("--seed 2 --camera '{}'", camera.string()));
    std::vector<nlohmann::json> frames = frames_in(folder / "walk_s02_01");
    const std::vector<nlohmann::json> others = frames_in(folder / "second");
    REQUIRE(frames.size() == others.size());
    fs::create_directory(track);
    for (std::size_t t = 0; t < frames.size(); ++t) {
      auto& people = frames[t]["people"];
      if (t >= hidden_frames) people.push_back(others[t]["people"][0]);
      for (std::size_t person = 2 - feet; person < people.size(); ++person)
        leave_foot(people[person]["pose_keypoints_2d"], person == 0 ? 1500 : 100);
      mcdbn::write_text_file(track / fmt::format("f_{:012}_keypoints.json", kFirstNumber + t),
                             frames[t].dump());
    }
  }

 private:
  /// The right one's toes and heel, the last three of OpenPose's places, which stay where they are.
  static void leave_foot(nlohmann::json& keypoints, double left_px) {
    constexpr std::size_t kPlaces = 25, kFoot = 22;
    REQUIRE(keypoints.size() == 3 * kPlaces);
    for (std::size_t i = 0; i < keypoints.size(); ++i) keypoints[i] = 0;
    for (std::size_t i = kFoot; i < kPlaces; ++i) {
      keypoints[3 * i] = left_px + 5.0 * static_cast<double>(i);
      keypoints[3 * i + 1] = 100.0 + 3.0 * static_cast<double>(i);
      keypoints[3 * i + 2] = 0.6;
    }
  }
  void project(const fs::path& clip, const std::string& options) const {
    REQUIRE(run_cli(fmt::format("project '{}' --like openpose --format openpose -o '{}' {}",
                                clip.string(), (folder / clip.stem().string()).string(), options))
                .exit_code == 0);
  }
};

CliResult regenerate_all(const Film& film) {
  return run_cli(fmt::format("regenerate --model '{}' --input '{}' --person all -o '{}'",
                             TinyPipeline::instance().model().string(), film.track.string(),
                             (film.folder / "out.bvh").string()));
}

Eigen::RowVector3d mean_root(const fs::path& bvh) {
  return joint_positions(mcdbn::read_bvh(bvh)).leftCols(3).colwise().mean();
}

}  // namespace

TEST_CASE(
    "regenerate --person all: without a camera all stand in one world, as far apart as seen") {
  if (!have_device()) return;
  const Film film(2, 7);
  const CliResult result = regenerate_all(film);
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const Eigen::RowVector3d between =
      (mean_root(film.folder / "out_person1.bvh") - mean_root(film.folder / "out_person2.bvh")) /
      film.metre;
  CAPTURE(between.transpose());
  CHECK(std::abs(between.x()) > 1.3);
  CHECK(between.norm() < 2.7);
  CHECK(std::abs(between.y()) < 0.5);
  // What is assumed of the camera is reported once, what is odd about a person with the number.
  const std::string assumed = "warning: no --camera";
  const auto at = result.standard_error.find(assumed);
  REQUIRE(at != std::string::npos);
  CHECK(result.standard_error.find(assumed, at + 1) == std::string::npos);
  CHECK(result.standard_error.find(
            fmt::format("{}: person 2: nobody is seen in frames {}-{}:", film.track.string(),
                        Film::kFirstNumber, Film::kFirstNumber + 6)) != std::string::npos);
}

TEST_CASE("regenerate --person all: who shows too little is left out, the others come") {
  if (!have_device()) return;
  const Film film(2, 0, 1);
  const CliResult result = regenerate_all(film);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK(result.standard_error.find(fmt::format("warning: {}: person 2: the 2D track never shows",
                                               film.track.string())) != std::string::npos);
  CHECK(result.standard_error.find("this person is left out") != std::string::npos);
  CHECK(mcdbn::read_bvh(film.folder / "out_person1.bvh").frames() > 0);
  CHECK(!fs::exists(film.folder / "out_person2.bvh"));
}

TEST_CASE("regenerate --person all: where all show too little it is bad input, and nothing comes") {
  if (!have_device()) return;
  const Film film(2, 0, 2);
  const CliResult result = regenerate_all(film);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 3);
  CHECK(result.standard_error.find(fmt::format("error: {}: nobody shows enough to be regenerated",
                                               film.track.string())) != std::string::npos);
  CHECK(!fs::exists(film.folder / "out_person1.bvh"));
}

}  // namespace several_people_test
