// Motion frame by frame: what is written is what was given, and a BVH is whole at its end.

#include "mcdbn/formats/frame_stream.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "mcdbn/formats/track_lines.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

Skeleton longer(Skeleton skeleton, double by) {
  for (Joint& joint : skeleton.joints) joint.offset *= by;
  return skeleton;
}

}  // namespace

TEST_CASE("frame stream: a BVH's number of frames and bones are written when they are known") {
  const Motion motion = swinging(small_body(), 12);
  std::stringstream out;
  out << "before";  // whatever stands there stays
  const auto stream = bvh_stream(out, 25, true);
  for (Eigen::Index t = 0; t < 12; ++t) {
    stream->write(longer(motion.skeleton, 1 + 0.01 * static_cast<double>(t)),
                  motion.channels.row(t), true);
    // Whoever reads it while it grows finds all frames so far, behind a number that is 1.
    std::vector<std::string> warnings;
    if (t == 3) CHECK(out.str().find("Frames: 1 ") != std::string::npos);
  }
  stream->finish();
  REQUIRE(out.str().starts_with("before"));
  std::vector<std::string> warnings;
  const Motion read = parse_bvh(out.str().substr(6), "stream", &warnings);
  CHECK(warnings.empty());
  REQUIRE(read.frames() == 12);
  CHECK(read.fps() == doctest::Approx(25));
  CHECK((read.channels - motion.channels).cwiseAbs().maxCoeff() < 1e-5);
  const Skeleton want = longer(motion.skeleton, 1.11);
  for (int joint = 0; joint < want.joint_count(); ++joint)
    CHECK((read.skeleton.joints[static_cast<std::size_t>(joint)].offset -
           want.joints[static_cast<std::size_t>(joint)].offset)
              .norm() < 1e-5);
}

TEST_CASE("frame stream: a BVH that cannot be written again keeps its first bones and no number") {
  const Motion motion = swinging(small_body(), 3);
  std::stringstream out;
  const auto stream = bvh_stream(out, 30, false);
  for (Eigen::Index t = 0; t < 3; ++t)
    stream->write(longer(motion.skeleton, 1 + static_cast<double>(t)), motion.channels.row(t),
                  true);
  const std::string before = out.str();
  stream->finish();
  CHECK(out.str() == before);
  std::vector<std::string> warnings;
  const Motion read = parse_bvh(out.str(), "stream", &warnings);
  CHECK(read.skeleton.joints[3].offset.isApprox(motion.skeleton.joints[3].offset));
  CHECK(out.str().find("Frames: 1 ") != std::string::npos);
}

TEST_CASE("frame stream: places as CSV and JSON lines, on the frame's own bones") {
  const Motion motion = swinging(small_body(), 4);
  std::stringstream csv, json;
  const auto rows = csv_stream(csv, 50), lines = json_stream(json, 50);
  for (Eigen::Index t = 0; t < 4; ++t)
    for (FrameStream* stream : {rows.get(), lines.get()})
      stream->write(longer(motion.skeleton, t == 2 ? 2 : 1), motion.channels.row(t), t != 3);
  Motion other = motion;
  other.skeleton = longer(motion.skeleton, 2);
  const double x = joint_positions(other)(2, 3 * 4 + 1);  // LFoot's y
  std::string line;
  REQUIRE(std::getline(csv, line));
  CHECK(line.starts_with("frame,time_s,Hips_x,Hips_y,Hips_z,LHip_x"));
  for (int t = 0; t < 3; ++t) REQUIRE(std::getline(csv, line));
  CHECK(line.starts_with("2,0.04,"));
  std::stringstream cells(line);
  std::string cell;
  for (int column = 0; column <= 2 + 3 * 4 + 1; ++column) std::getline(cells, cell, ',');
  CHECK(std::stod(cell) == doctest::Approx(x).epsilon(1e-4));
  for (int t = 0; t < 3; ++t) REQUIRE(std::getline(json, line));
  const auto frame = nlohmann::json::parse(line);
  CHECK(frame.at("frame") == 2);
  CHECK(frame.at("time_s") == 0.04);
  CHECK(frame.at("joints").at("LFoot").at(1).get<double>() == doctest::Approx(x));
  CHECK(frame.at("channels").size() == static_cast<std::size_t>(motion.channels.cols()));
  CHECK(frame.at("channels").at(5).get<double>() == doctest::Approx(motion.channels(2, 5)));
  CHECK(frame.at("seen") == true);
  REQUIRE(std::getline(json, line));
  CHECK(nlohmann::json::parse(line).at("seen") == false);
}

TEST_CASE("frame stream: places in space are not read as a 2D track") {
  const ScratchFolder folder;
  const Motion motion = swinging(small_body(), 4);
  std::stringstream csv, json;
  for (const auto& stream : {csv_stream(csv, 50), json_stream(json, 50)})
    for (Eigen::Index t = 0; t < 4; ++t)
      stream->write(motion.skeleton, motion.channels.row(t), true);
  for (const auto& path :
       {folder.write("own.csv", csv.str()), folder.write("own.jsonl", json.str())})
    CHECK_THROWS_WITH_AS(read_track(path),
                         doctest::Contains("points in space, as regenerate --follow writes them"),
                         InputError);
  std::string line;
  std::getline(json, line);
  TrackLines lines("pipe", {.image_size = ImageSize{1280, 720}});
  CHECK_THROWS_WITH_AS((void)lines.read(line), doctest::Contains("points in space"), InputError);
}

TEST_CASE("frame stream: every frame has a time of its own, hours after the first, too") {
  Skeleton skeleton;
  skeleton.joints = {make_joint("Hips", -1, {0, 0, 0}, {z_rotation})};
  std::stringstream out;
  const auto rows = csv_stream(out, 30);
  for (int t = 0; t <= 300'001; ++t) rows->write(skeleton, RowVectorD::Zero(1), true);
  const std::string text = out.str();
  for (const char* start :
       {"\n0,0,", "\n1,0.0333333,", "\n300000,10000,", "\n300001,10000.0333333,"})
    CHECK(text.find(start) != std::string::npos);
}

TEST_CASE("frame stream: what cannot be written is reported") {
  std::stringstream out;
  out.setstate(std::ios::badbit);
  const Motion motion = swinging(small_body(), 1);
  CHECK_THROWS_AS(csv_stream(out, 30)->write(motion.skeleton, motion.channels.row(0), true),
                  InputError);
}
