// Every option of corpus, and a model of several skeletons from its list to another's BVH.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/near.hpp"
#include "mcdbn/corpus/clip_list.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/humanoid_motion.hpp"
#include "option_table.hpp"
#include "run_cli.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

TEST_CASE("corpus: every option changes what its help describes") {
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const std::string broken = folder.write("broken.bvh", "HIERARCHY\n").string();
  const std::string data = fmt::format("corpus '{}' {}", pipeline.motion().string(), broken);
  const CliResult plain = run_cli(data);
  CHECK(plain.exit_code == 0);
  CHECK(plain.standard_output.find("walk") != std::string::npos);
  CHECK(plain.standard_output.find("\n1 action ") != std::string::npos);
  CHECK(plain.standard_output.find("broken.bvh:") != std::string::npos);
  const fs::path list = folder / "corpus.toml";
  check_options(
      "corpus",
      {{"data",
        [&] {
          CHECK(run_cli("corpus absent").exit_code == 3);
          CHECK(run_cli("corpus").exit_code == 2);
        }},
       {"--output",
        [&] {
          const CliResult result = run_cli(fmt::format("{} -o '{}'", data, list.string()));
          CHECK(result.standard_output == plain.standard_output);
          CHECK(result.standard_error.find("4 clips, 1 left out") != std::string::npos);
          const auto clips = mcdbn::read_clip_list(list);
          REQUIRE(clips.size() == 4);
          CHECK(clips[0].person == "s01");
          CHECK(clips[0].action == "walk");
        }},
       {"--json",
        [&] {
          const auto json = nlohmann::json::parse(run_cli(data + " --json").standard_output);
          CHECK(json.at("clips").size() == 5);
          CHECK(json.at("usable") == 4);
          CHECK(json.at("people") == nlohmann::json::array({"s01", "s02"}));
          CHECK(json.at("actions") == nlohmann::json::array({"walk"}));
          CHECK(json.at("hours").get<double>() == near(4 * 1.2 / 3600, 0.02));
          const auto& first = json.at("clips").at(0);
          CHECK(first.at("person") == "s01");
          CHECK(first.at("humanoid").at("mean_mm").get<double>() < 1);
          CHECK(json.at("clips").at(4).at("problems").at(0).at("kind") == "unreadable");
        }},
       {"--joint-map",
        [&] {
          // An ankle that is mapped to a knee is no ankle any more.
          const fs::path map = folder.write("map.toml", "left_knee = \"LeftFoot\"\n");
          const auto json = nlohmann::json::parse(
              run_cli(fmt::format("{} --json --joint-map '{}'", data, map.string()))
                  .standard_output);
          CHECK(json.at("usable") == 0);
          const std::string problem = json.at("clips").at(0).at("problems").at(0).at("text");
          CHECK(problem.find("left_ankle") != std::string::npos);
          // Then there is nothing to list.
          const fs::path none = folder / "none.toml";
          const CliResult empty = run_cli(
              fmt::format("{} --joint-map '{}' -o '{}'", data, map.string(), none.string()));
          CHECK(empty.exit_code == 3);
          CHECK(empty.standard_error.find(none.string() + ": not written") != std::string::npos);
          CHECK(empty.standard_error.find("none that `mcdbn-cl train` takes") != std::string::npos);
          CHECK(!fs::exists(none));
          // A name that no clip has is a mistake.
          folder.write("map.toml", "left_knee = \"LeftLeggg\"\n");
          const CliResult odd =
              run_cli(fmt::format("{} --quiet --joint-map '{}'", data, map.string()));
          CHECK(odd.exit_code == 0);
          CHECK(odd.standard_error.find("left_knee is 'LeftLeggg', and no clip has") !=
                std::string::npos);
          CHECK(run_cli(data + " --joint-map absent").exit_code == 3);
        }},
       {"--quiet", [&] {
          const fs::path quiet = folder / "quiet.toml";
          const CliResult result = run_cli(fmt::format("{} -o '{}' --quiet", data, quiet.string()));
          CHECK(result.standard_error.empty());
          CHECK(fs::exists(quiet));
        }}});
}

TEST_CASE("a list of several skeletons trains the humanoid, which is written back to any") {
  if (!have_device()) return;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const ScratchFolder folder;
  const fs::path other = folder / "other_s03_01.bvh", list = folder / "corpus.toml";
  write_bvh(other, moving_humanoid(45));
  const std::string walk = (pipeline.motion() / "walk_s01_01.bvh").string();
  REQUIRE(run_cli(fmt::format("corpus '{}' '{}' -o '{}'", walk, other.string(), list.string()))
              .exit_code == 0);
  const CliResult trained = train(fmt::format("'{}'", list.string()), folder / "run",
                                  kTiny + " --augment-arms-anywhere 0.5");
  CAPTURE(trained.standard_error);
  REQUIRE(trained.exit_code == 0);
  CHECK(trained.standard_error.find("skeletons differ, so the humanoid's is learnt") !=
        std::string::npos);
  const std::string model =
      fmt::format("--model '{}'", (folder / "run/model.safetensors").string());
  const std::string track = (folder / "track.csv").string(), out = (folder / "out.bvh").string();
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}'", walk, track)).exit_code == 0);
  const auto regenerated = [&](const std::string& options) {
    const CliResult result =
        run_cli(fmt::format("regenerate {} --input '{}' -o '{}' {}", model, track, out, options));
    CAPTURE(result.standard_error);
    REQUIRE(result.exit_code == 0);
    return mcdbn::read_bvh(out);
  };
  CHECK(is_humanoid(regenerated("").skeleton));
  const mcdbn::Motion back = regenerated(fmt::format("--skeleton '{}'", walk));
  const mcdbn::Skeleton own = mcdbn::read_bvh(walk).skeleton;
  REQUIRE(back.skeleton.joint_count() == own.joint_count());
  for (std::size_t j = 0; j < own.joints.size(); ++j) {
    CHECK(back.skeleton.joints[j].name == own.joints[j].name);
    CHECK(back.skeleton.joints[j].offset.isApprox(own.joints[j].offset, 1e-6));
  }
  // Test clips and seeds of any skeleton are taken, too.
  CHECK(run_cli(fmt::format("evaluate {} --test '{}' --report '{}' --fit none", model,
                            (pipeline.motion() / "walk_s02_01.bvh").string(),
                            (folder / "report").string()))
            .exit_code == 0);
  // A clip whose knee has no known name needs a map.
  mcdbn::Motion unknown = mcdbn::read_bvh(pipeline.motion() / "walk_s02_02.bvh");
  for (mcdbn::Joint& joint : unknown.skeleton.joints)
    if (joint.name == "LeftLeg") joint.name = "spam";
  const fs::path renamed = folder / "renamed.bvh";
  write_bvh(renamed, unknown);
  const std::string evaluated =
      fmt::format("evaluate {} --test '{}' --fit none --baselines none", model, renamed.string());
  const CliResult refused = run_cli(evaluated);
  CHECK(refused.exit_code == 3);
  CHECK(refused.standard_error.find(renamed.string() + ": no joint is known to be left_knee") !=
        std::string::npos);
  const fs::path map = folder.write("map.toml", "left_knee = \"spam\"\n");
  CHECK(run_cli(fmt::format("{} --joint-map '{}'", evaluated, map.string())).exit_code == 0);
  CHECK(run_cli(fmt::format("regenerate {} --to track --input '{}' -o '{}'", model, walk,
                            (folder / "again.csv").string()))
            .exit_code == 0);
  const std::string more = (folder / "more.bvh").string();
  CHECK(run_cli(fmt::format("generate {} --seed-clip '{}' --frames 5 -o '{}'", model, walk, more))
            .exit_code == 0);
  CHECK(mcdbn::read_bvh(more).skeleton.joint_count() == own.joint_count());
}
