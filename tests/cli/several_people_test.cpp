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

  /// @param apart_m the second stands so far to the left of the first
  /// @param hidden_frames the second is not seen in the first so many
  Film(double apart_m, std::size_t hidden_frames) {
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
      if (t >= hidden_frames) frames[t]["people"].push_back(others[t]["people"][0]);
      mcdbn::write_text_file(track / fmt::format("f_{:012}_keypoints.json", t), frames[t].dump());
    }
  }

 private:
  void project(const fs::path& clip, const std::string& options) const {
    REQUIRE(run_cli(fmt::format("project '{}' --like openpose --format openpose -o '{}' {}",
                                clip.string(), (folder / clip.stem().string()).string(), options))
                .exit_code == 0);
  }
};

Eigen::RowVector3d mean_root(const fs::path& bvh) {
  return joint_positions(mcdbn::read_bvh(bvh)).leftCols(3).colwise().mean();
}

}  // namespace

TEST_CASE(
    "regenerate --person all: without a camera all stand in one world, as far apart as seen") {
  if (!have_device()) return;
  const Film film(2, 6);
  const CliResult result =
      run_cli(fmt::format("regenerate --model '{}' --input '{}' --person all -o '{}'",
                          TinyPipeline::instance().model().string(), film.track.string(),
                          (film.folder / "out.bvh").string()));
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
  CHECK(result.standard_error.find(fmt::format("{}: person 2: nobody is seen in frames 0-5",
                                               film.track.string())) != std::string::npos);
}

}  // namespace several_people_test
