// Files may be of any length: reading one can be interrupted.
#include "base/interruption.hpp"

#include <doctest/doctest.h>

#include <functional>

#include "base/scratch_folder.hpp"
#include "formats/figure_track.hpp"
#include "formats/json_text.hpp"
#include "formats/track_source.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/base/matrix_file.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "motion/resample.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

const std::string kBvh =
    "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
    "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.03\n1 2 3\n4 5 6\n7 8 9\n";

}  // namespace

TEST_CASE("reading, working on and writing many frames stops when it is asked to") {
  const ScratchFolder folder;
  const auto csv = folder.write("t.csv", "a_x_px,a_y_px,b_x_px,b_y_px\n1,2,3,4\n5,6,7,8\n"),
             rows = folder.write("rows.csv", "1,2\n3,4\n"),
             people = folder.write("tracks.csv",
                                   "scorer,m,m,m\nbodyparts,nose,nose,nose\n"
                                   "coords,x,y,likelihood\n0,1,2,0.5\n1,1,2,0.5\n");
  std::filesystem::create_directory(folder / "json");
  for (const char* frame : {"json/a_1.json", "json/a_2.json"})
    folder.write(frame, R"({"people": [{"pose_keypoints_2d": [1, 2, 1]}]})");
  // Long enough that it is asked in the middle.
  std::string long_list = "[0";
  while (long_list.size() < (3U << 20U)) long_list += ",0";
  long_list += "]";
  const Motion motion = parse_bvh(kBvh, "a.bvh");
  const Track2d track = read_track_csv(csv), seen = figure_track(track_format("openpose"));
  const std::vector<std::function<void()>> all{
      [&] { parse_bvh(kBvh, "a.bvh"); },
      [&] { bvh_text(motion); },
      [&] { resample(motion, 60); },
      [&] { joint_positions(motion); },
      [&] { read_track_csv(csv); },
      [&] { write_track_csv(folder / "out.csv", track); },
      [&] { read_tracks(people, {.format = "deeplabcut"}); },
      [&] { read_matrix(rows); },
      [&] { TrackSource(folder / "json").json_of(folder / "json/a_1.json"); },
      [&] { parse_json(long_list, "long.json"); },
      [&] { track_format("openpose").write(folder / "frames", seen); },
  };
  for (const auto& work : all) CHECK_NOTHROW(work());
  std::filesystem::remove(folder / "out.csv");
  std::filesystem::remove_all(folder / "frames");
  for (std::size_t i = 0; i < all.size(); ++i) {
    CAPTURE(i);
    request_interruption();
    bool stopped = false;
    try {
      all[i]();
    } catch (const Interrupted&) {
      stopped = true;
    }
    clear_interruption();
    CHECK(stopped);
  }
  CHECK(!std::filesystem::exists(folder / "out.csv"));
  CHECK(!std::filesystem::exists(folder / "frames"));
}
