#include "mcdbn/formats/bvh.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "shared_data.hpp"

namespace bvh_test {

using namespace mcdbn;
namespace fs = std::filesystem;

namespace {

const std::string kHierarchy =
    "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 1 2\n"
    "\tCHANNELS 6 Zrotation Xposition Yposition Zposition Xrotation Yrotation\n"
    "\tJOINT Left Leg\n\t{\n\t\tOFFSET 1 -.5 +2e1\n\t\tCHANNELS 1 Yrotation\n"
    "\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 -4 0\n\t\t}\n\t}\n}\n";
const std::string kRows = "1 2 3 4 5 6 7\n-1 -2e0 -.3 4. 5 6 7.5\n";
const std::string kSmall = kHierarchy + "MOTION\nFrames: 2\nFrame Time: 0.04\n" + kRows;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// The message with which the text is refused.
std::string refusal(const std::string& text) {
  try {
    parse_bvh(text, "clip.bvh");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

void check_same_hierarchy(const Skeleton& a, const Skeleton& b) {
  REQUIRE(a.joint_count() == b.joint_count());
  for (int i = 0; i < a.joint_count(); ++i) {
    const Joint &x = a.joints[i], &y = b.joints[i];
    CHECK(x.name == y.name);
    CHECK(x.parent == y.parent);
    CHECK(x.offset == y.offset);
    CHECK(x.channels == y.channels);
    CHECK(x.end_sites == y.end_sites);
  }
}

void check_round_trip(const Motion& motion) {
  const Motion again = parse_bvh(bvh_text(motion), "again.bvh");
  check_same_hierarchy(motion.skeleton, again.skeleton);
  CHECK(motion.frame_time_s == again.frame_time_s);
  REQUIRE(motion.channels.rows() == again.channels.rows());
  REQUIRE(motion.channels.cols() == again.channels.cols());
  CHECK((motion.channels - again.channels).cwiseAbs().maxCoeff() <= 1e-6);
}

}  // namespace

TEST_CASE("a small file is read as written") {
  std::vector<std::string> warnings;
  const Motion motion = parse_bvh(kSmall, "small.bvh", &warnings);
  CHECK(warnings.empty());
  REQUIRE(motion.skeleton.joint_count() == 2);
  const Joint &hips = motion.skeleton.joints[0], &leg = motion.skeleton.joints[1];
  CHECK(hips.name == "Hips");
  CHECK(hips.parent == -1);
  CHECK(hips.offset == Eigen::Vector3d(0, 1, 2));
  CHECK(hips.channels == std::vector<Channel>{Channel::z_rotation, Channel::x_position,
                                              Channel::y_position, Channel::z_position,
                                              Channel::x_rotation, Channel::y_rotation});
  CHECK(leg.name == "Left Leg");
  CHECK(leg.parent == 0);
  CHECK(leg.offset == Eigen::Vector3d(1, -0.5, 20));
  REQUIRE(leg.end_sites.size() == 1);
  CHECK(leg.end_sites[0] == Eigen::Vector3d(0, -4, 0));
  CHECK(motion.frame_time_s == 0.04);
  MatrixD expected(2, 7);
  expected << 1, 2, 3, 4, 5, 6, 7, -1, -2, -0.3, 4, 5, 6, 7.5;
  CHECK(motion.channels == expected);
  check_round_trip(motion);
}

TEST_CASE("the wild's ways of writing the same") {
  const MatrixD expected = parse_bvh(kSmall, "").channels;
  std::string crlf;
  for (const char c : kSmall) {
    if (c == '\n') crlf += '\r';
    crlf += c;
  }
  std::string no_end = kSmall;
  no_end.pop_back();
  std::string one_line = kSmall;
  std::replace(one_line.begin(), one_line.begin() + one_line.find("MOTION"), '\t', '\v');
  for (const std::string& text :
       {crlf, no_end, one_line, "\xEF\xBB\xBF" + kSmall, kSmall + "\n \t\n\n",
        replaced(kSmall, "Frames: 2", "\n\nFRAMES: \t 2 "),
        replaced(kSmall, "Frame Time: ", "Frame Time:\t\t"), replaced(kSmall, "Hips\n{", "Hips {"),
        replaced(kSmall, "End Site\n", "End Site toe\n"),
        replaced(kSmall, "4 5 6 7\n", "4\n5 6\n\n7\n")}) {
    std::vector<std::string> warnings;
    const Motion motion = parse_bvh(text, "wild.bvh", &warnings);
    CHECK(motion.channels == expected);
    CHECK(motion.skeleton.joints[0].name == "Hips");
    CHECK(motion.skeleton.joints[1].name == "Left Leg");
    CHECK(warnings.empty());
  }
}

TEST_CASE("odd but usable files are read with a warning") {
  std::vector<std::string> warnings;
  CHECK(parse_bvh(kSmall + kRows, "more.bvh", &warnings).frames() == 2);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].starts_with("more.bvh:21: more lines than the 2 frames"));
  CHECK_NOTHROW(parse_bvh(kSmall + kRows, "more.bvh"));

  warnings.clear();
  parse_bvh(replaced(kSmall, "Left Leg", "Hips"), "twice.bvh", &warnings);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].starts_with("twice.bvh:6: a second joint named 'Hips'"));

  warnings.clear();
  const Motion motion = parse_bvh(replaced(kSmall, "OFFSET 0 1 2", ""), "bare.bvh", &warnings);
  CHECK(motion.skeleton.joints[0].offset == Eigen::Vector3d(0, 0, 0));
  CHECK(warnings.size() == 1);
}

TEST_CASE("bad files are refused with file, line and advice") {
  const auto starts = [](const std::string& text, const std::string& expected) {
    const std::string message = refusal(text);
    CAPTURE(message);
    CHECK(message.starts_with(expected));
    CHECK(message.find('\n') == std::string::npos);
  };
  starts("", "clip.bvh:1: the file ends where 'HIERARCHY' should stand");
  starts(std::string("ELF\0\1\2", 6), "clip.bvh:1: is not plain text");
  starts("\x89PNG\r\n\x1a\n", "clip.bvh:1: '\xEF\xBF\xBDPNG' where 'HIERARCHY' should stand");
  starts(kHierarchy, "clip.bvh:16: the file ends without MOTION");
  starts(replaced(kSmall, "MOTION\n", ""), "clip.bvh:16: 'Frames:' is unknown here");
  starts(replaced(kSmall, "\t\t}\n\t}\n}", "\t\t}\n\t}\n"),
         "clip.bvh:16: joint 'Hips' is still open");
  starts(replaced(kSmall, "\t\t}\n\t}\n}", "\t\t}\n\t}\n}}"),
         "clip.bvh:15: a closing brace too many");
  starts(replaced(kSmall, "Yrotation\n\tJOINT", "Wrotation\n\tJOINT"),
         "clip.bvh:5: unknown channel 'Wrotation'");
  starts(replaced(kSmall, "CHANNELS 6", "CHANNELS 5"), "clip.bvh:5: 'Yrotation' is unknown here");
  starts(replaced(kSmall, "CHANNELS 6", "CHANNELS -1"), "clip.bvh:5: the count of channels");
  starts(replaced(kSmall, "Xposition", "Zrotation"), "clip.bvh:5: channel 'Zrotation' twice");
  starts(replaced(kSmall, "OFFSET 0 1 2", "OFFSET 0 1"), "clip.bvh:5: 'CHANNELS' is not a number");
  starts(replaced(kSmall, "JOINT", "ROOT"), "clip.bvh:6: ROOT stands inside");
  starts(replaced(kSmall, "Hips", ""), "clip.bvh:2: 'ROOT' without a name");
  starts(replaced(kSmall, "Frames: 2", "Frames: -2"), "clip.bvh:17: the number of frames must");
  starts(replaced(kSmall, "Frames: 2", "Frames: 1.5"), "clip.bvh:17: the number of frames must");
  starts(replaced(kSmall, "Frames: 2", "Frames: 0"), "clip.bvh:17: the number of frames must");
  starts(replaced(kSmall, "Frames: 2", "Frames: 99999999999"), "clip.bvh:17: the number of");
  starts(replaced(kSmall, "Frames: 2", "Frames: 2147483647"), "clip.bvh:21: only 2 of the 2147");
  starts(replaced(kSmall, "Frames: 2", "Frames: 3"), "clip.bvh:21: only 2 of the 3 frames");
  for (const char* time : {"0", "-0.04", "1e-300", "1e-9", "0.00009", "10.1", "1e9", "1e300"})
    starts(replaced(kSmall, "0.04", time),
           "clip.bvh:18: the frame time must be at least 0.0001 and at most 10 seconds");
  starts(replaced(kSmall, "0.04", "fast"), "clip.bvh:18: 'fast' is not a number");
  starts(replaced(kSmall, "Frame Time: 0.04\n", ""), "clip.bvh:18: '1' where 'Frame' should stand");
  starts(replaced(kSmall, "2 3 4 5 6 7\n", "2 3 4 5 6\n"), "clip.bvh:19: 6 values on this line");
  starts(replaced(kSmall, "6 7.5", "6"), "clip.bvh:20: 6 values on this line");
  starts(replaced(kSmall, "2 3 4 5 6 7\n", "2 3 4 5 6 7 8\n"), "clip.bvh:19: 8 values on this");
  starts(replaced(kSmall, "2 3 4 5 6 7\n", "2 3 4 5 6\n") + kRows, "clip.bvh:19: 6 values on this");
  for (const char* bad : {"x", "1,5", "0x10", "--1", "+-1", "+", "1e", "1.2.3"}) {
    starts(replaced(kSmall, "6 7.5", fmt::format("6 {}", bad)),
           fmt::format("clip.bvh:20: '{}' is not a number", bad));
  }
  for (const char* bad : {"nan", "inf", "-INF", "1e999", "-1e+999"}) {
    starts(replaced(kSmall, "6 7.5", fmt::format("6 {}", bad)),
           fmt::format("clip.bvh:20: '{}' is not a finite number", bad));
  }
  CHECK(parse_bvh(replaced(kSmall, "7.5", "1e-999"), "").channels(1, 6) == 0);
  starts("HIERARCHY\nROOT a\n{\n}\nMOTION\nFrames: 9\nFrame Time: 1\n", "clip.bvh:5: no joint has");
  starts("HIERARCHY\nMOTION\nFrames: 1\nFrame Time: 1\n1\n", "clip.bvh:2: a hierarchy without");
  starts(replaced(kSmall, "Hips", fmt::format("{:a>100000}\nx", "")), "clip.bvh:3: 'x' where '{'");
}

TEST_CASE("10 MB of nesting is refused, not recursed into") {
  std::string joints = "HIERARCHY\nROOT a{\n";
  while (joints.size() < 10'000'000) joints += "JOINT a{\n";
  CHECK(refusal(joints).find("joints are nested deeper than 1000") != std::string::npos);
  CHECK(refusal("HIERARCHY\nROOT a\n" + std::string(10'000'000, '{')).starts_with("clip.bvh:3: "));
  CHECK(refusal(std::string(10'000'000, '{')).starts_with("clip.bvh:1: "));
}

TEST_CASE("hierarchies nested to the limit survive the round trip") {
  Skeleton chain;
  for (int i = 0; i < 1000; ++i) {
    chain.joints.push_back({fmt::format("j{}", i), i - 1, {0, 0.1 * i, 0}, {}, {}});
  }
  chain.joints.back().end_sites = {{1, 2, 3}, {4, 5, 6}};
  check_same_hierarchy(chain, parse_bvh_header(bvh_header_text(chain), "chain"));
}

TEST_CASE("a header reads with and without the word MOTION") {
  const Skeleton skeleton = parse_bvh(kSmall, "").skeleton;
  check_same_hierarchy(skeleton, parse_bvh_header(kHierarchy, "header"));
  check_same_hierarchy(skeleton, parse_bvh_header(kSmall, "header"));
  check_same_hierarchy(skeleton, parse_bvh_header(bvh_header_text(skeleton), "header"));
  CHECK_THROWS_AS(parse_bvh_header("HIERARCHY\nROOT a\n{\n", "header"), InputError);
}

TEST_CASE("what cannot be a BVH file is a mistake of the caller") {
  Motion motion = parse_bvh(kSmall, "");
  motion.channels.conservativeResize(2, 6);
  CHECK_THROWS_AS(bvh_text(motion), ShapeError);
  Skeleton tangled;
  tangled.joints = {Joint{"a", -1, {}, {}, {}}, Joint{"b", 0, {}, {}, {}},
                    Joint{"c", 0, {}, {}, {}}, Joint{"d", 1, {}, {}, {}}};
  CHECK_THROWS_AS(bvh_header_text(tangled), ShapeError);
}

TEST_CASE("a written file reads as it was") {
  const test::ScratchFolder folder;
  const Motion motion = parse_bvh(kSmall, "");
  write_bvh(folder / "a.bvh", motion);
  CHECK(read_bvh(folder / "a.bvh").channels == motion.channels);
  CHECK_THROWS_AS(write_bvh(folder / "absent/a.bvh", motion), InputError);
  CHECK_THROWS_AS(read_bvh(folder / "absent.bvh"), InputError);
}

TEST_CASE("every shared file reads and survives the round trip") {
  for (const char* group : {"cmu", "bandai", "bvh_zoo"}) {
    if (!test::have_shared_data(group, "BVH round trip")) continue;
    for (const auto& entry : fs::recursive_directory_iterator(test::shared_data() / group)) {
      if (entry.path().extension() != ".bvh") continue;
      CAPTURE(entry.path().filename().string());
      std::vector<std::string> warnings;
      const Motion motion = read_bvh(entry.path(), &warnings);
      CHECK(warnings.empty());
      CHECK(motion.channels.allFinite());
      check_round_trip(motion);
    }
  }
}

TEST_CASE("randomly damaged files are read or refused, nothing else") {
  std::mt19937 random(7);
  const auto below = [&](std::size_t limit) { return random() % limit; };
  int accepted = 0, refused = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    std::string text = kSmall;
    for (std::size_t change = 0; change <= below(4); ++change) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text[at] = static_cast<char>(below(256));
          break;
        case 1:
          text.erase(at, 1 + below(8));
          break;
        case 2:
          text.insert(at, text.substr(below(text.size()), 1 + below(20)));
          break;
        default:
          text.insert(at, 1, "{}\n -+.e9\"\t"[below(11)]);
      }
      if (text.empty()) text.push_back(' ');
    }
    try {
      const Motion motion = parse_bvh(text, "damaged.bvh");
      REQUIRE(motion.channels.allFinite());
      REQUIRE(motion.channels.cols() == motion.skeleton.channel_count());
      ++accepted;
    } catch (const InputError& error) {
      REQUIRE(std::string(error.what()).starts_with("damaged.bvh:"));
      ++refused;
    }
  }
  CHECK(accepted > 100);
  CHECK(refused > 1000);
}

}  // namespace bvh_test
