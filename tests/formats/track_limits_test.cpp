// What is read of a file takes room in proportion to it: joints and people are limited.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "base/scratch_folder.hpp"
#include "formats/seen_people.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace track_limits_test {

namespace {

/// OpenPose's JSON of one frame.
std::string people_of(std::size_t people, std::size_t joints) {
  json list = json::array();
  for (std::size_t person = 0; person < people; ++person) {
    json numbers = json::array();
    for (std::size_t joint = 0; joint < joints; ++joint)
      for (const std::size_t value : {10 + person + joint, 100 + joint, std::size_t{1}})
        numbers.push_back(value);
    list.push_back(json{{"pose_keypoints_2d", numbers}});
  }
  return json{{"people", list}}.dump();
}

std::string rows_of(std::size_t landmarks) {
  std::string text = "frame,landmark,x,y\n";
  for (std::size_t i = 0; i < landmarks; ++i)
    text += fmt::format("0,mark {0},{1},{1}\n", i, 10 + i);
  return text;
}

/// DeepLabCut's CSV of one frame, with a part of its own for each individual.
std::string parts_of(std::size_t individuals, std::size_t parts) {
  std::string names = "individuals", bodyparts = "bodyparts", coords = "coords", row = "0";
  for (std::size_t i = 0; i < std::max(individuals, parts); ++i) {
    names += fmt::format(",i{0},i{0}", i % individuals);
    bodyparts += fmt::format(",p{0},p{0}", i % parts);
    coords += ",x,y";
    row += fmt::format(",{},{}", 10 + i, 20 + i);
  }
  return names + "\n" + bodyparts + "\n" + coords + "\n" + row + "\n";
}

std::string sleap_of(std::size_t nodes) {
  std::string header = "track,frame_idx", row = "a,0";
  for (std::size_t i = 0; i < nodes; ++i) {
    header += fmt::format(",n{0}.x,n{0}.y", i);
    row += fmt::format(",{},{}", 10 + i, 20 + i);
  }
  return header + "\n" + row + "\n";
}

}  // namespace

TEST_CASE("track limits: joints of a person") {
  const ScratchFolder folder;
  for (const std::size_t joints : {kMostJoints, kMostJoints + 1})
    for (const std::string& text :
         {people_of(1, joints), rows_of(joints), parts_of(1, joints), sleap_of(joints)}) {
      CAPTURE(text.substr(0, 40));
      const auto path = folder.write("joints", text);
      if (joints <= kMostJoints)
        CHECK(read_track(path).joint_count() == static_cast<int>(joints));
      else
        CHECK_THROWS_WITH_AS(read_track(path),
                             doctest::Contains("601 joints of a person; at most 600 are read"),
                             InputError);
    }
}

TEST_CASE("track limits: people in a frame") {
  const ScratchFolder folder;
  for (const std::string& text : {people_of(kMostPeople, 5), parts_of(kMostPeople, 5)}) {
    CAPTURE(text.substr(0, 40));
    CHECK(read_tracks(folder.write("people", text)).people_seen == static_cast<int>(kMostPeople));
  }
  CHECK_THROWS_WITH_AS(read_track(folder.write("people", people_of(kMostPeople + 1, 5))),
                       doctest::Contains("501 people in frame 0; at most 500 are followed"),
                       InputError);
  CHECK_THROWS_WITH_AS(read_track(folder.write("people", parts_of(kMostPeople + 1, 5))),
                       doctest::Contains("501 individuals; at most 500 are followed"), InputError);
}

}  // namespace track_limits_test
