// Who is who in whole files: places in an array, and numbers that a tracker gives anew.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/capture_bound.hpp"
#include "base/npy.hpp"
#include "base/scratch_folder.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace track_people_test {
namespace {

constexpr int kFrames = 60;
constexpr std::size_t kJoints = 17;

/// x, y, confidence of 17 joints of a body at x; a place without a body: zeros.
std::vector<double> body_at(std::optional<double> x) {
  std::vector<double> numbers;
  for (std::size_t joint = 0; joint < kJoints; ++joint)
    for (const double value :
         {x ? *x + 10.0 * (joint % 4) : 0.0, x ? 100.0 + 12.0 * joint : 0.0, x ? 0.9 : 0.0})
      numbers.push_back(value);
  return numbers;
}

/// One walks from x = 200, the other from 900.
double walker_at(int frame) {
  return 200 + 2 * frame;
}
double other_at(int frame) {
  return 900 + 2 * frame;
}

using Places = std::vector<std::optional<double>>;

/// @param frames the places of each frame, the same number in each
std::string array_of(const std::vector<Places>& frames, bool people_first) {
  const std::size_t people = frames.front().size();
  NpyArray array{{frames.size(), people, kJoints, 3}, {}};
  if (people_first) std::swap(array.shape[0], array.shape[1]);
  for (std::size_t outer = 0; outer < array.shape[0]; ++outer)
    for (std::size_t inner = 0; inner < array.shape[1]; ++inner) {
      const std::vector<double> body =
          body_at(people_first ? frames[inner][outer] : frames[outer][inner]);
      array.values.insert(array.values.end(), body.begin(), body.end());
    }
  return npy_bytes(array);
}

/// A list of COCO's of one body a frame, with these track numbers.
std::string numbered_film(const std::vector<int>& numbers) {
  json list = json::array();
  for (std::size_t i = 0; i < numbers.size(); ++i)
    list.push_back({{"image_id", 100 + i},
                    {"keypoints", body_at(walker_at(static_cast<int>(i)))},
                    {"track_id", numbers[i]}});
  return list.dump();
}

/// The notice of numbers that are one person's; empty: none.
std::string number_notice(const TrackReading& reading) {
  for (const std::string& notice : reading.notices)
    if (notice.starts_with("track numbers")) return notice;
  return {};
}

}  // namespace

TEST_CASE("track people: a place in an array is no person's number") {
  const ScratchFolder folder;
  std::vector<Places> exchanged, padded;
  for (int frame = 0; frame < kFrames; ++frame) {
    exchanged.push_back({walker_at(frame), other_at(frame)});
    if (frame >= 25) std::swap(exchanged.back()[0], exchanged.back()[1]);
    // The other one is found for a while, and first.
    padded.push_back({walker_at(frame), std::nullopt});
    if (frame >= 20 && frame < 45) padded.back() = {other_at(frame), walker_at(frame)};
  }
  for (const auto& [name, frames] : {std::pair{"exchanged", exchanged}, {"padded", padded}})
    for (const bool people_first : {false, true}) {
      CAPTURE_BOUND(name);
      CAPTURE(people_first);
      const TrackReading reading = read_tracks(
          folder.write("people.npy", array_of(frames, people_first)), {.person = "all", .fps = 30});
      REQUIRE(reading.people.size() == 2);
      const auto walker = std::ranges::find(reading.people, walker_at(0),
                                            [](const Track2d& track) { return track.x_px(0, 0); });
      REQUIRE(walker != reading.people.end());
      for (int frame = 0; frame < kFrames; ++frame)
        CHECK(walker->x_px(frame, 0) == walker_at(frame));
    }
}

TEST_CASE("track people: an array with room for one shows one person, however long away") {
  const ScratchFolder folder;
  std::vector<Places> frames;
  for (int frame = 0; frame < 150; ++frame) {
    const bool away = frame >= 45 && frame < 105;
    frames.push_back({away ? std::nullopt : std::optional(walker_at(frame))});
  }
  for (const bool people_first : {false, true}) {
    CAPTURE(people_first);
    const auto file = folder.write("one.npy", array_of(frames, people_first));
    CHECK(read_tracks(file, {.fps = 30}).people_seen == 1);
  }
}

TEST_CASE("track people: numbers that a tracker gave one after the other are joined and told") {
  const ScratchFolder folder;
  std::vector<int> numbers(86, 1);
  std::fill(numbers.begin() + 40, numbers.end(), 7);
  const TrackReading reading =
      read_tracks(folder.write("film.json", numbered_film(numbers)), {.fps = 30});
  CHECK(reading.people_seen == 1);
  CHECK((reading.people.front().confidence.rowwise().maxCoeff().array() > 0).count() == 86);
  CHECK(number_notice(reading).ends_with(": 7 after 1 from frame 140"));

  // Another number every tenth frame.
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<int>(i / 10);
  const TrackReading restless =
      read_tracks(folder.write("film.json", numbered_film(numbers)), {.fps = 30});
  CHECK(restless.people_seen == 1);
  CHECK(number_notice(restless).ends_with("5 after 4 from frame 150, and 3 more"));

  const std::vector<int> one(86, 1);
  CHECK(number_notice(read_tracks(folder.write("film.json", numbered_film(one)), {.fps = 30}))
            .empty());
}

TEST_CASE("track people: tracks that have names are told by them") {
  const ScratchFolder folder;
  std::string sleap = "track,frame_idx,instance.score,a.x,a.y,b.x,b.y,c.x,c.y\n";
  std::string columns = "frame,track_id,a_x,a_y,b_x,b_y,c_x,c_y,d_x,d_y,e_x,e_y\n";
  for (int frame = 0; frame < kFrames; ++frame) {
    const int track = frame < 30 ? 4 : 9;
    sleap += fmt::format("fly_{},{},1,100,100,140,160,100,220\n", track, frame);
    columns += fmt::format("{},{},100,100,140,160,100,220,140,280,100,340\n", frame, track);
  }
  CHECK(number_notice(read_tracks(folder.write("sleap.csv", sleap)))
            .ends_with(": fly_9 after fly_4 from frame 30"));
  CHECK(number_notice(read_tracks(folder.write("columns.csv", columns)))
            .ends_with(": 9 after 4 from frame 30"));
}

}  // namespace track_people_test
