#include "corpus/corpus_survey.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "base/scratch_folder.hpp"
#include "corpus/training_files.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/humanoid_motion.hpp"
#include "motion/synthetic_motion.hpp"
#include "motion/turned_motion.hpp"
#include "shared_data.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

using Kind = ClipProblem::Kind;

std::set<Kind> kinds(const std::vector<ClipProblem>& problems) {
  std::set<Kind> found;
  for (const ClipProblem& problem : problems) found.insert(problem.kind);
  return found;
}

std::string text_of(const std::vector<ClipProblem>& problems, Kind kind) {
  const auto found = std::ranges::find(problems, kind, &ClipProblem::kind);
  return found == problems.end() ? "" : found->text;
}

std::vector<ClipProblem> problems_of(const Motion& motion) {
  return motion_problems(motion, humanoid_roles());
}

}  // namespace

TEST_CASE("a survey: people, actions, skeletons and what is lost") {
  const ScratchFolder folder;
  const TrainingFiles walks({{1, 1}, {1, 2}, {2, 1}});
  const fs::path other = folder / "dataset-1_bow_active_001.bvh", broken = folder / "08_01.bvh";
  write_bvh(other, moving_humanoid(60));
  folder.write("08_01.bvh", "HIERARCHY\nROOT Hips\n");
  const auto& files = walks.files();
  const auto clips = survey({files[0], files[1], {files[2], "ann", "stroll"}, other, broken});
  REQUIRE(clips.size() == 5);
  CHECK(clips[0].clip.person == "body 1");
  CHECK(clips[1].clip.person == "body 1");
  CHECK(clips[2].clip.person == "ann");
  CHECK(clips[3].clip.person == "body 2");
  CHECK(clips[4].clip.person == "08");
  CHECK(clips[2].clip.action == "stroll");
  CHECK(clips[3].clip.action == "bow");
  CHECK(clips[0].skeleton == 1);
  CHECK(clips[3].skeleton == 2);
  CHECK(clips[0].frames == 45);
  CHECK(clips[0].seconds() == doctest::Approx(1.5));
  for (int i = 0; i < 4; ++i) {
    CAPTURE(clips[i].clip.file);
    CHECK(clips[i].usable());
    CHECK(clips[i].problems.empty());
    CHECK(clips[i].error->mean_deg() < 0.1);
  }
  CHECK_FALSE(clips[4].usable());
  CHECK(text_of(clips[4].problems, Kind::unreadable).find("08_01.bvh:") != std::string::npos);
}

TEST_CASE("a survey: names of a joint map that no clip has are reported") {
  const TrainingFiles walks({{1, 1}, {2, 1}});
  const std::vector<ListedClip> clips{walks.files()[0], walks.files()[1]};
  std::vector<std::string> notices;
  survey(clips, {{JointRole::left_knee, "LeftLeggg"}, {JointRole::head, "Neck"}}, &notices);
  CHECK(notices ==
        std::vector<std::string>{"the joint map's left_knee is 'LeftLeggg', and no clip has a "
                                 "joint of that name"});
}

TEST_CASE("a survey: short, slow, no person, a calibration pose") {
  const ScratchFolder folder;
  Motion motion = moving_humanoid(12);
  write_bvh(folder / "short.bvh", motion);
  motion = moving_humanoid(40);
  motion.frame_time_s = 0.1;
  write_bvh(folder / "slow.bvh", motion);
  write_bvh(folder / "stick.bvh", swinging(small_body(), 60));
  motion = moving_humanoid(60);
  motion.channels.row(0).setZero();
  write_bvh(folder / "posed.bvh", motion);
  const auto kinds_of = [&](const char* name) {
    return kinds(survey({folder / name}).front().problems);
  };
  CHECK(kinds_of("short.bvh") == std::set<Kind>{Kind::length});
  CHECK(kinds_of("slow.bvh").count(Kind::rate) == 1);
  CHECK(kinds_of("stick.bvh") == std::set<Kind>{Kind::no_person});
  CHECK(kinds_of("posed.bvh") == std::set<Kind>{Kind::first_frame});
}

TEST_CASE("a survey: spikes, jumps, feet under the ground and bodies that lie") {
  const Motion good = moving_humanoid(90);
  CHECK(problems_of(good).empty());
  Motion spiked = good;
  spiked.channels(40, 0) += 150;
  CHECK(text_of(problems_of(spiked), Kind::spikes).find("1 frame: 41") != std::string::npos);
  CHECK(kinds(problems_of(spiked)) == std::set<Kind>{Kind::spikes});
  Motion jumped = good;
  jumped.channels.col(0).tail(30).array() += 300;
  CHECK(text_of(problems_of(jumped), Kind::jumps).find("1 frame: 61") != std::string::npos);
  CHECK(kinds(problems_of(jumped)) == std::set<Kind>{Kind::jumps});
  Motion sunk = good;
  for (int t = 40; t < 50; ++t) sunk.channels(t, 1) -= 30 * std::sin(0.1 * 3.1416 * (t - 40));
  CHECK(kinds(problems_of(sunk)) == std::set<Kind>{Kind::ground});
  const Eigen::Matrix3d lying =
      Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  CHECK(kinds(problems_of(turned_motion(good, lying))).count(Kind::up) == 1);
}

TEST_CASE("a survey of recorded motion: CMU and Bandai are as they should be") {
  if (!have_shared_data("cmu/walk", "a survey of recorded motion")) return;
  const auto clips = survey({shared_data() / "cmu/walk/08_01.bvh",
                             shared_data() / "cmu/actions/jumping/jumping_test_1.bvh",
                             shared_data() / "bandai/set1/dataset-1_punch_normal_001.bvh",
                             shared_data() / "formats/cmu_asf_amc/16_15.amc"});
  CHECK(kinds(clips[0].problems) == std::set<Kind>{Kind::first_frame});
  for (int i = 1; i < 4; ++i) {
    CAPTURE(clips[i].clip.file);
    CHECK(clips[i].usable());
    // 16_15 itself begins with a jump.
    CHECK(kinds(clips[i].problems) == (i < 3 ? std::set<Kind>{} : std::set{Kind::jumps}));
  }
  CHECK(clips[0].clip.person == "08");
  CHECK(clips[1].clip.action == "jumping");
  CHECK(clips[2].clip.action == "punch");
  CHECK(clips[0].skeleton == clips[1].skeleton);
  CHECK(clips[0].skeleton != clips[2].skeleton);
}
