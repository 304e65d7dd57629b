#include "mcdbn/formats/track_csv.hpp"
#include "mcdbn/camera/track.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool same_numbers(const MatrixD& a, const MatrixD& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.array() == b.array() || (a.array().isNaN() && b.array().isNaN())).all();
}

const std::string kHeader = "Hips_x_px,Hips_y_px,Hips_confidence\n";

/// What reading the file complains about.
std::string message_of(const std::filesystem::path& path) {
  try {
    read_track_csv(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("track CSV: what is written is read back bit by bit") {
  const test::ScratchFolder folder;
  Track2d track;
  track.joint_names = {"mixamorig:Hips", "Left Hand"};
  track.x_px.resize(3, 2);
  track.y_px.resize(3, 2);
  track.confidence.resize(3, 2);
  track.x_px << 1.0 / 3, 2, 1e-7, kNan, -5, 1920;
  track.y_px << 0.1, 3, 4, kNan, 7, 2.0 / 3;
  track.confidence << 1, 0.25, 0.5, 0, 1, 1;
  track.fps = 30000.0 / 1001;
  track.width_px = 1280;
  track.height_px = 720;
  write_track_csv(folder / "track.csv", track);
  const std::string text = read_text_file(folder / "track.csv");
  CHECK(text.find("\nmixamorig:Hips_x_px,mixamorig:Hips_y_px,mixamorig:Hips_confidence,"
                  "Left Hand_x_px,Left Hand_y_px,Left Hand_confidence\n") != std::string::npos);
  CHECK(text.find("1e-07,4,0.5,,,0\n") != std::string::npos);
  const Track2d back = read_track_csv(folder / "track.csv");
  CHECK(back.joint_names == track.joint_names);
  CHECK(same_numbers(back.x_px, track.x_px));
  CHECK(same_numbers(back.y_px, track.y_px));
  CHECK(same_numbers(back.confidence, track.confidence));
  CHECK(back.fps == track.fps);
  CHECK(back.width_px == 1280);
  CHECK(back.height_px == 720);
  track.joint_names[0] = "Hips,left";
  CHECK_THROWS_AS(write_track_csv(folder / "track.csv", track), InputError);
  CHECK(read_text_file(folder / "track.csv") == text);
}

TEST_CASE("track CSV: what other programs write is read") {
  const test::ScratchFolder folder;
  const Track2d track = read_track_csv(folder.write(
      "a.csv",
      "\xEF\xBB\xBF# made elsewhere, x=3\r\ntime_s, Hips_y_px ,Hips_x_px,Hand_x_px,Hand_y_px\r\n"
      "0.00, 2,+1,3,4\r\n0.04,NaN,5,6,7\r\n\r\n0.08,8,9,,10"));
  CHECK(track.joint_names == std::vector<std::string>{"Hips", "Hand"});
  CHECK(track.fps == doctest::Approx(25));
  CHECK(track.width_px == 1920);
  REQUIRE(track.frames() == 3);
  CHECK(track.x_px(0, 0) == 1);
  CHECK(track.y_px(0, 0) == 2);
  CHECK(track.confidence(0, 1) == 1);   // no such column
  CHECK(std::isnan(track.x_px(1, 0)));  // one half alone is no joint
  CHECK(track.confidence(1, 0) == 0);
  CHECK(std::isnan(track.y_px(2, 1)));
  CHECK(track.confidence(2, 1) == 0);
  CHECK(track.y_px(2, 0) == 8);
}

TEST_CASE("track CSV: a comment that a spreadsheet filled up, and R's quotes") {
  const test::ScratchFolder folder;
  const Track2d filled = read_track_csv(
      folder.write("a.csv", "# fps=25 width_px=640 height_px=480,,,\r\n" + kHeader + "1,2,1\r\n"));
  CHECK(filled.fps == 25);
  CHECK(filled.width_px == 640);
  CHECK(filled.height_px == 480);
  const Track2d quoted = read_track_csv(
      folder.write("b.csv", "\"Hips_x_px\",\"Hips_y_px\",\"Hips_confidence\"\n1,\"2\",0.5\n"));
  CHECK(quoted.joint_names == std::vector<std::string>{"Hips"});
  CHECK(quoted.y_px(0, 0) == 2);
  CHECK(read_track(folder / "b.csv").confidence(0, 0) == 0.5);
}

TEST_CASE("track CSV: times that are not even are read with a notice, even ones without") {
  const test::ScratchFolder folder;
  const auto notices = [&](const std::string& times) {
    std::vector<std::string> lines;
    read_track(folder.write("a.csv", "# width_px=640 height_px=480\n" + times), {}, &lines);
    std::string all;
    for (const std::string& one : lines) all += one + '\n';
    return all;
  };
  const std::string header = "time_s,Hips_x_px,Hips_y_px\n";
  CHECK(notices(header + "0,1,2\n0.033,1,2\n0.067,1,2\n0.1,1,2\n").find("time_s") ==
        std::string::npos);
  CHECK(notices(header + "0,1,2\n0.04,1,2\n0.12,1,2\n0.16,1,2\n")
            .find("time_s goes on by 0.04 to 0.08 s: frames are taken as even, 18.75 a second") !=
        std::string::npos);
  // Thirty times off, one way and the other.
  CHECK(notices(header + "0,1,2\n1,1,2\n2,1,2\n").find("gives 1 frames a second") !=
        std::string::npos);
  CHECK(notices("# fps=900\nHips_x_px,Hips_y_px\n1,2\n").find("gives 900 frames a second") !=
        std::string::npos);
}

TEST_CASE("track CSV: confidence 0 means missing, an empty confidence means 1") {
  const test::ScratchFolder folder;
  const Track2d track =
      read_track_csv(folder.write("a.csv", "# fps=50\n" + kHeader + "0,0,0\n3,4,\n"));
  CHECK(track.fps == 50);
  CHECK(std::isnan(track.x_px(0, 0)));
  CHECK(std::isnan(track.y_px(0, 0)));
  CHECK(track.x_px(1, 0) == 3);
  CHECK(track.confidence(1, 0) == 1);
}

TEST_CASE("track CSV: x = y = 0 means missing, one of them alone does not") {
  const test::ScratchFolder folder;
  const std::filesystem::path file =
      folder.write("a.csv", kHeader + "0,0,1\n0.0,-0,\n0,4,1\n3,0,0.5\n");
  for (const Track2d& track : {read_track_csv(file), read_track(file)}) {
    REQUIRE(track.frames() == 4);
    for (const int frame : {0, 1}) {
      CHECK(std::isnan(track.x_px(frame, 0)));
      CHECK(std::isnan(track.y_px(frame, 0)));
      CHECK(track.confidence(frame, 0) == 0);
    }
    CHECK(track.x_px(2, 0) == 0);
    CHECK(track.y_px(2, 0) == 4);
    CHECK(track.confidence(2, 0) == 1);
    CHECK(track.y_px(3, 0) == 0);
    CHECK(track.confidence(3, 0) == 0.5);
  }
}

TEST_CASE("track CSV: what is wrong is named with its file and line") {
  const test::ScratchFolder folder;
  struct Case {
    std::string text, message;
  };
  for (const Case& c :
       {Case{"", "no header line"},
        Case{"# fps=30\n", "no header line"},
        Case{kHeader, "no frames"},
        Case{"1,2,3\n", ":1: numbers where the header"},
        Case{kHeader + "1,2,1\n1,2\n", ":3: 2 cells where the header has 3"},
        Case{kHeader + "1,2,1,4\n", ":2: 4 cells"},
        Case{kHeader + "1,two,1\n", ":2: 'two' in column 2"},
        Case{kHeader + "1,2px,1\n", ":2: '2px'"},
        Case{kHeader + "inf,2,1\n", ":2: 'inf'"},
        Case{kHeader + "1,2,-1\n", ":2: confidence -1"},
        Case{"Hips_x_px,Hips_y_px,Hips_x_px\n1,2,3\n", ":1: column 'Hips_x_px' comes twice"},
        Case{"Hips_x_px,Hand_x_px,Hand_y_px\n1,2,3\n",
             ":1: joint 'Hips' has no column 'Hips_y_px'"},
        Case{"Hips_confidence\n1\n", ":1: joint 'Hips' has no column 'Hips_x_px'"},
        Case{"\nframe,Hips_x_px,Hips_y_px\n", ":2: unknown column 'frame'"},
        Case{"_x_px,_y_px\n1,2\n", ":1: unknown column '_x_px'"},
        Case{"Hips_x_px,time_s,Hips_y_px\n", ":1: time_s is not the first"},
        Case{"time_s\n1\n", ":1: no joint columns"},
        Case{"time_s,a_x_px,a_y_px\n0,1,1\n0,1,1\n", ":3: time_s does not rise"},
        Case{"time_s,a_x_px,a_y_px\n,1,1\n", ":2: time_s does not rise"},
        Case{"# fps=0\n" + kHeader, ":1: 'fps=0' has no usable value"},
        Case{"# fps=1e-9\n" + kHeader, ":1: 'fps=1e-9' has no usable value"},
        Case{"# fps=10001\n" + kHeader, "a number of at least 0.1 and at most 10000"},
        Case{"# width_px=100001\n" + kHeader, ":1: 'width_px=100001'"},
        Case{"time_s,a_x_px,a_y_px\n0,1,1\n33333333,1,1\n66666666,1,1\n",
             ": time_s makes 3e-08 frames a second"},
        Case{"time_s,a_x_px,a_y_px\n0,1,1\n1e-9,1,1\n", ": time_s makes 1e+09 frames"},
        Case{"# fps=fast\n" + kHeader, ":1: 'fps=fast'"},
        Case{"# width_px=1.5\n" + kHeader, ":1: 'width_px=1.5'"}}) {
    CAPTURE(c.text);
    const std::string message = message_of(folder.write("bad.csv", c.text));
    CHECK_MESSAGE(message.find("bad.csv:") != std::string::npos, message);
    CHECK_MESSAGE(message.find(c.message) != std::string::npos, message);
  }
  CHECK_THROWS_AS(read_track_csv(folder / "none.csv"), InputError);
}
