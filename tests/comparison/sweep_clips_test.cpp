// What a sweep makes of its test clips, and of the options of its trainings.
#include <doctest/doctest.h>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "comparison/sweep.hpp"
#include "comparison/tiny_training.hpp"
#include "corpus/training_files.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/synthetic_motion.hpp"

namespace sweep_clips_test {

using namespace mcdbn;
using namespace mcdbn::test;
namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

/// A walk whose knees are called what shows no role.
fs::path without_knees(const fs::path& walk, const fs::path& path) {
  Motion motion = read_bvh(walk);
  for (Joint& joint : motion.skeleton.joints)
    if (joint.name == "LeftLeg" || joint.name == "RightLeg")
      joint.name = joint.name == "LeftLeg" ? "spam" : "ham";
  write_bvh(path, motion);
  return path;
}

fs::path with_calibration_pose(const fs::path& walk, const fs::path& path) {
  const Motion motion = read_bvh(walk);
  Motion posed = motion;
  posed.channels = MatrixD::Zero(motion.frames() + 1, motion.channels.cols());
  posed.channels.bottomRows(motion.frames()) = motion.channels;
  write_bvh(path, posed);
  return path;
}

Sweep::Resolve always(const TrainingConfig& config) {
  return [config](const SweepConfiguration&) { return config; };
}

}  // namespace

TEST_CASE(
    "sweep: a test clip that is trained on, or is none, is refused before the first training") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}});
  const ScratchFolder folder;
  const fs::path copy = folder.write("copy.bvh", read_text_file(files.files()[0])),
                 broken = folder.write("broken.bvh", "HIERARCHY\n");
  on_every_device([&](Device& device) {
    const auto sweep = [&](const fs::path& test) {
      Sweep(device, {files.files()[1], test}, {files.files()[0]}, always(tiny_training()),
            folder / "run");
    };
    CHECK_THROWS_WITH_AS(sweep(copy), doctest::Contains((copy.string() + ": is to be").c_str()),
                         ConfigError);
    CHECK_THROWS_WITH_AS(sweep(broken), doctest::Contains((broken.string() + ":").c_str()),
                         InputError);
    CHECK(!fs::exists(folder / "run"));
  });
}

TEST_CASE("sweep: a test clip that is no person's is found before the humanoid is trained") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}});
  const ScratchFolder folder;
  const fs::path stick = folder / "stick.bvh";
  write_bvh(stick, swinging(small_body(), 20));
  TrainingConfig config = tiny_training();
  config.skeleton = SkeletonUse::humanoid;
  on_every_device([&](Device& device) {
    fs::remove_all(folder / "run");
    Sweep sweep(device, {stick}, {files.files()[0]}, always(config), folder / "run");
    int trainings = 0;
    const ordered_json record = sweep.run({}, [&](bool) {
      ++trainings;
      return EpochObserver();
    });
    CHECK(record.at("status") == "failed");
    CHECK(
        record.at("error").get<std::string>().starts_with(stick.string() + ": no joint is known"));
    CHECK(trainings == 0);
  });
}

TEST_CASE("sweep: test clips are read with the joint map and the first frame of the trainings") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}});
  const ScratchFolder folder;
  const fs::path training = without_knees(files.files()[0], folder / "training.bvh"),
                 test = with_calibration_pose(without_knees(files.files()[1], folder / "other.bvh"),
                                              folder / "test.bvh");
  TrainingConfig config = tiny_training();
  config.joint_map = {{JointRole::left_knee, "spam"}, {JointRole::right_knee, "ham"}};
  const int frames = read_bvh(test).frames();
  on_every_device([&](Device& device) {
    for (const bool kept : {true, false}) {
      fs::remove_all(folder / "run");
      config.keep_first_frame = kept;
      Sweep sweep(device, {test}, {training}, always(config), folder / "run");
      const ordered_json record = sweep.run({});
      CAPTURE(record.dump());
      REQUIRE(record.at("status") == "ok");
      CHECK(record.at("frames") == (kept ? frames : frames - 1));
    }
  });
}

TEST_CASE("sweep: checkpoints are written as often as is asked for") {
  const TrainingFiles files({{.subject = 1}, {.subject = 2}});
  const ScratchFolder folder;
  on_every_device([&](Device& device) {
    for (const double minutes : {0.0, 60.0}) {
      fs::remove_all(folder / "run");
      Sweep sweep(device, {files.files()[1]}, {files.files()[0]}, always(tiny_training()),
                  folder / "run", {}, {.minutes = minutes});
      std::string first_stage;
      int reports = 0;
      sweep.run({}, [&](bool counts) -> EpochObserver {
        if (!counts) return {};
        return [&](const EpochReport& report) {
          if (first_stage.empty()) first_stage = report.stage;
          if (report.stage != first_stage || report.epoch != 2) return;
          ++reports;
          CHECK(fs::exists(folder / "run/base/unfinished/checkpoint.safetensors") ==
                (minutes == 0));
        };
      });
      CHECK(reports == 1);
    }
  });
}

}  // namespace sweep_clips_test
