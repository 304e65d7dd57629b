// regenerate --skeleton: a skeleton whose joints have other names than the model's.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>

#include "mcdbn/formats/bvh.hpp"
#include "tiny_pipeline.hpp"

namespace skeletons_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// A clip of the pipeline whose joints are called otherwise.
class Renamed {
 public:
  Renamed() {
    clip_ = mcdbn::read_bvh(TinyPipeline::instance().motion() / "walk_s02_01.bvh");
    REQUIRE(run_cli(fmt::format("project '{}' -o '{}'",
                                (TinyPipeline::instance().motion() / "walk_s02_01.bvh").string(),
                                (folder_ / "track.csv").string()))
                .exit_code == 0);
  }

  CliResult regenerate(const std::map<std::string, std::string>& names,
                       const std::string& joint_map = "") const {
    mcdbn::Motion clip = clip_;
    for (mcdbn::Joint& joint : clip.skeleton.joints)
      if (const auto found = names.find(joint.name); found != names.end())
        joint.name = found->second;
    write_bvh(skeleton(), clip);
    std::string options;
    if (!joint_map.empty())
      options = fmt::format("--joint-map '{}'", folder_.write("map.toml", joint_map).string());
    return run_cli(fmt::format("regenerate --model '{}' --input '{}' --skeleton '{}' -o '{}' {}",
                               TinyPipeline::instance().model().string(),
                               (folder_ / "track.csv").string(), skeleton().string(),
                               (folder_ / "out.bvh").string(), options));
  }
  fs::path skeleton() const { return folder_ / "skeleton.bvh"; }

 private:
  ScratchFolder folder_;
  mcdbn::Motion clip_;
};

const std::map<std::string, std::string> kKnees{{"LeftLeg", "spam"}, {"RightLeg", "ham"}};

}  // namespace

TEST_CASE("regenerate --skeleton: joints of unknown names are warned of, once") {
  if (!have_device()) return;
  const Renamed scene;
  const std::string lost = "; their motion is lost";
  const CliResult warned = scene.regenerate(kKnees);
  CAPTURE(warned.standard_error);
  CHECK(warned.exit_code == 0);
  const std::string words = scene.skeleton().string() +
                            ": no joint has the roles left_knee, right_knee" + lost +
                            ". Name them with --joint-map";
  const auto at = warned.standard_error.find("mcdbn-cl: warning: " + words);
  REQUIRE(at != std::string::npos);
  CHECK(warned.standard_error.find(words, at + words.size()) == std::string::npos);
  const CliResult mapped = scene.regenerate(kKnees, "left_knee = \"spam\"\nright_knee = \"ham\"\n");
  CAPTURE(mapped.standard_error);
  CHECK(mapped.exit_code == 0);
  CHECK(mapped.standard_error.find(lost) == std::string::npos);
}

TEST_CASE("regenerate --skeleton: the names of VRM and of Bandai lose nothing") {
  if (!have_device()) return;
  const Renamed scene;
  const std::map<std::string, std::pair<std::string, std::string>> sided{
      {"UpLeg", {"UpperLeg", "UpperLeg"}},
      {"Leg", {"LowerLeg", "LowerLeg"}},
      {"Foot", {"Foot", "Foot"}},
      {"ToeBase", {"ToeBase", "Toes"}},
      {"Shoulder", {"Shoulder", "Shoulder"}},
      {"Arm", {"UpperArm", "UpperArm"}},
      {"ForeArm", {"LowerArm", "LowerArm"}},
      {"Hand", {"Hand", "Hand"}}};
  std::map<std::string, std::string> vrm, bandai;
  for (const char* name : {"Hips", "Spine", "Chest", "Spine1", "Neck", "Head"})
    vrm[name] = std::string("J_Bip_C_") + name;
  for (const auto& [side, letter] : {std::pair{"Left", "L"}, std::pair{"Right", "R"}})
    for (const auto& [name, others] : sided) {
      vrm[side + name] = fmt::format("J_Bip_{}_{}", letter, others.first);
      bandai[side + name] = fmt::format("{}_{}", others.second, letter);
    }
  for (const auto& names : {vrm, bandai}) {
    const CliResult result = scene.regenerate(names);
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    CHECK(result.standard_error.find("no joint has the roles") == std::string::npos);
  }
}

TEST_CASE("regenerate --skeleton: a skeleton of which a whole limb is unknown is refused") {
  if (!have_device()) return;
  const Renamed scene;
  const CliResult result = scene.regenerate(
      {{"LeftUpLeg", "eggs"}, {"LeftLeg", "spam"}, {"LeftFoot", "ham"}, {"LeftToeBase", "beans"}});
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 3);
  CHECK(result.standard_error.find(scene.skeleton().string() +
                                   ": no joint is known to be left_hip, left_knee, left_ankle: ") !=
        std::string::npos);
}

}  // namespace skeletons_test
