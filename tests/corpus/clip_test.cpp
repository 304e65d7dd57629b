#include "mcdbn/corpus/clip.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;

namespace {

namespace fs = std::filesystem;

/// A clip at 60 frames a second whose first frame is a calibration pose.
Motion calibrated() {
  Motion motion = test::swinging(test::small_body(), 41, 60);
  motion.channels.row(0).setZero();
  return motion;
}

fs::path write(const test::ScratchFolder& folder, const std::string& name, const Motion& motion) {
  fs::create_directories((folder / name).parent_path());
  write_bvh(folder / name, motion);
  return folder / name;
}

std::vector<fs::path> canonical(std::vector<fs::path> paths) {
  for (fs::path& path : paths) path = fs::weakly_canonical(path);
  return paths;
}

}  // namespace

TEST_CASE("clip: the calibration pose goes, then the rate becomes the one asked for") {
  const test::ScratchFolder folder;
  const fs::path path = write(folder, "a.bvh", calibrated());
  const Motion file = read_bvh(path);
  std::vector<std::string> notices;
  const Motion own = load_clip(path, {.fps = 0}, &notices);
  CHECK(own.fps() == doctest::Approx(60));
  CHECK(own.channels == file.channels.bottomRows(40));
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].find("a.bvh: dropped the calibration pose") != std::string::npos);

  notices.clear();
  const Motion kept = load_clip(path, {.fps = 0, .keep_first_frame = true}, &notices);
  CHECK(kept.channels == file.channels);
  CHECK(notices.empty());

  CHECK(load_clip(path).fps() == doctest::Approx(30));
  CHECK(load_clip(path).frames() == 20);
  const Motion faster = load_clip(path, {.fps = 120, .keep_first_frame = true});
  CHECK(faster.fps() == doctest::Approx(120));
  CHECK(faster.frames() == 81);
  // Rates that files print rounded are the same one.
  CHECK(load_clip(path, {.fps = 60.005}).channels == own.channels);
  CHECK(load_clip(path, {.fps = 59}).frames() == 39);
}

TEST_CASE("clip: rates that are none and clips without frames are refused") {
  const test::ScratchFolder folder;
  const fs::path path = write(folder, "a.bvh", calibrated());
  for (const double fps :
       {-1.0, 1e-300, 0.09, 10'001.0, 1e300, std::nan(""), std::numeric_limits<double>::infinity()})
    CHECK_THROWS_AS(load_clip(path, {.fps = fps}), ConfigError);
  Motion empty = calibrated();
  empty.channels.resize(0, empty.channels.cols());
  const fs::path no_frames = write(folder, "empty.bvh", empty);
  CHECK_THROWS_AS(load_clip(no_frames), InputError);
  CHECK_THROWS_AS(load_clip(folder / "none.bvh"), InputError);
}

TEST_CASE("clips to train on: each at its own rate, known by its file") {
  const test::ScratchFolder folder;
  const fs::path a = write(folder, "a.bvh", calibrated()),
                 b = write(folder, "b.bvh", test::swinging(test::small_body(), 20, 25));
  std::vector<std::string> notices;
  const std::vector<LoadedClip> clips = load_clips({a, b}, false, &notices);
  REQUIRE(clips.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CAPTURE(i);
    const fs::path& path = i == 0 ? a : b;
    CHECK(clips[i].clip.path == identify_clip(path).path);
    CHECK(clips[i].clip.fingerprint == identify_clip(path).fingerprint);
    CHECK(clips[i].motion.channels == load_clip(path, {.fps = 0}).channels);
    CHECK(clips[i].motion.fps() == doctest::Approx(i == 0 ? 60 : 25));
  }
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].find("a.bvh: dropped the calibration pose") != std::string::npos);
  CHECK(load_clips({a}, true).front().motion.frames() == 41);
  CHECK_THROWS_AS(load_clips({a, folder / "none.bvh"}), InputError);
  Motion empty = calibrated();
  empty.channels.resize(0, empty.channels.cols());
  CHECK_THROWS_AS(load_clips({write(folder, "empty.bvh", empty)}), InputError);
}

TEST_CASE("an AMC is known by its own bytes and its ASF's, and by its own where a model says so") {
  const test::ScratchFolder folder;
  const auto put = [&](const char* name, const std::string& asf) {
    fs::create_directory(folder / name);
    folder.write(fmt::format("{}/one.asf", name), asf);
    return folder.write(fmt::format("{}/one_1.AMC", name), "angles");
  };
  const TrainingClip clip = identify_clip(put("a", "bones")),
                     copy = identify_clip(put("b", "bones")),
                     longer = identify_clip(put("c", "longer bones"));
  CHECK(clip.fingerprint == copy.fingerprint);
  CHECK(clip.fingerprint != longer.fingerprint);
  CHECK(is_among({copy}, clip));
  CHECK_FALSE(is_among({longer}, clip));
  // As an earlier model recorded it: the AMC alone.
  const TrainingClip earlier{"/elsewhere/one_1.amc",
                             identify_clip(folder.write("angles.bvh", "angles")).fingerprint};
  for (const TrainingClip& known : {clip, longer}) {
    CHECK(is_among({earlier}, known));
    CHECK(is_among({known}, earlier));
  }
  CHECK_FALSE(is_among({earlier}, identify_clip(folder.write("other.bvh", "other"))));
  fs::remove(folder / "a/one.asf");
  CHECK_THROWS_AS(identify_clip(folder / "a/one_1.AMC"), InputError);
}

TEST_CASE("clips of a command line: files in its order, folders by path, each once") {
  const test::ScratchFolder folder;
  const Motion motion = calibrated();
  const fs::path last = write(folder, "z.bvh", motion), b = write(folder, "in/b.bvh", motion),
                 deep = write(folder, "in/a/deep.BVH", motion),
                 a = write(folder, "in/c.bvh", motion);
  folder.write("in/notes.txt", "no clip");
  CHECK(canonical(find_clips({last, folder / "in"})) == canonical({last, deep, b, a}));
  CHECK(canonical(find_clips({a, folder / "in", last, a})) == canonical({a, deep, b, last}));
  // A file is taken as it is, whatever its name.
  CHECK(find_clips({folder / "in/notes.txt"}).size() == 1);
  CHECK_THROWS_AS(find_clips({folder / "none"}), InputError);
  CHECK_THROWS_AS(find_clips({}), InputError);
  fs::create_directories(folder / "bare");
  CHECK_THROWS_AS(find_clips({folder / "bare"}), InputError);
}
